// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/radial/torus_columns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/support/evaluated.h"
#include "core/support/gradient.h"
#include "core/support/matchers.h"
#include "core/support/meshes.h"
#include "core/support/overlapping.h"
#include "core/support/sanitized.h"
#include "volcontact/pair/mesh_columns/radial/radial_cut.h"

namespace volcontact::torus_columns_test {
namespace {

using test::box_soup;
using test::evaluated;
using test::mesh_of;
using test::overlapping;
using test::Random;
using test::shifted;

constexpr double kMajor = 0.3, kMinor = 0.1;
const Torus kRing({.major_radius = kMajor, .minor_radius = kMinor});

// Circles of the ring through the box itself are the oracle.
TEST(TorusColumns, AMeshOfABoxMeetsARingAsTheBox) {
  const Vec3 half(0.5, 0.4, 0.3);
  const Box box({.half_sizes = half});
  const int kPoses = test::cases(40, 3);
  Random random(1);
  for (const double minor : {0.05, 0.2, 0.29}) {
    const Torus ring({.major_radius = kMajor, .minor_radius = minor});
    std::vector<double> errors;
    for (int i = 0; i < kPoses; ++i) {
      const Mesh mesh = mesh_of(box_soup(half, 1 + 5 * (i % 3)));
      const Pose X_AB = overlapping(box, ring, random, std::pow(10.0, random.uniform(-4.0, -1.0)));
      const Interference out = evaluated(mesh, ring, X_AB);
      const VolumeMetrics expected = evaluated(box, ring, X_AB, Engine::kLines, 1e-6).total;
      if (!expected.touching()) continue;
      const VolumeMetrics& m = out.total;
      EXPECT_EQ(out.engine, Engine::kColumns);
      errors.push_back(std::abs(m.volume - expected.volume) / expected.volume);
      EXPECT_LE(errors.back(), 1e-3);
      EXPECT_LE((m.centroid - expected.centroid).norm(), 1e-3 * std::cbrt(expected.volume));
      EXPECT_LE((m.area_vector - expected.area_vector).norm(), 1e-3 * expected.area);
      EXPECT_LE((m.area_moment - expected.area_moment).norm(), 1e-3 * expected.area);
      EXPECT_NEAR(m.area, expected.area, 1e-3 * expected.area);
      EXPECT_NEAR(m.counter_area, expected.counter_area, 5e-3 * expected.counter_area);
      EXPECT_LE((m.inertia - expected.inertia).norm(), 1e-3 * expected.inertia.norm());
    }
    std::sort(errors.begin(), errors.end());
    EXPECT_GE(errors.size() + 2, static_cast<std::size_t>(kPoses));
    EXPECT_LE(errors[errors.size() / 2], 1e-5);
    if (!test::kSanitized) {
      EXPECT_LE(errors[errors.size() * 9 / 10], 5e-5);
    }
  }
}

// Of a ring that lies on a plate, by Pappus: the segment of the tube's disc, turned.
TEST(TorusColumns, ARingOnAPlateIsATurnedSegment) {
  const double top = 0.2;
  for (const int n : {1, 9}) {
    const Mesh plate = mesh_of(box_soup(Vec3(0.6, 0.6, top), n));
    for (const double depth : {1e-3, 1e-2, 0.08, 0.15}) {
      const Interference out = evaluated(plate, kRing, shifted(0.03, 0.02, top + kMinor - depth));
      const double a = kMinor, h = a - depth;
      const double half_chord = std::sqrt(a * a - h * h);
      const double segment = a * a * std::acos(h / a) - h * half_chord;
      const double volume = 2.0 * kPi * kMajor * segment;
      EXPECT_EQ(out.engine, Engine::kColumns);
      ASSERT_EQ(out.sites.size(), 1u) << depth;
      EXPECT_NEAR(out.total.volume, volume, 1e-4 * volume) << depth;
      EXPECT_LE(std::abs(out.total.volume - volume), out.total.volume_error);
      // The lowest point of the segment is its first moment over its area away.
      const double below = 2.0 / 3.0 * half_chord * half_chord * half_chord / segment;
      EXPECT_NEAR(out.total.centroid.z(), top + kMinor - depth - below, 2e-4 * depth);
      EXPECT_NEAR(out.total.area_vector.z(), 4.0 * kPi * kMajor * half_chord,
                  2e-4 * out.total.area);
      EXPECT_NEAR(out.total.counter_area, 4.0 * kPi * kMajor * a * std::acos(h / a),
                  5e-3 * out.total.counter_area);
    }
  }
}

TEST(TorusColumns, EachPlaceThatIsTouchedIsASite) {
  // The ring stands in a slot between two plates.
  const double gap = kMajor + kMinor - 1e-3;
  const Mesh walls =
      mesh_of(box_soup(Vec3(0.1, 0.6, 0.6), 3)
                  .moved(shifted(gap + 0.1, 0.0, 0.0))
                  .with(box_soup(Vec3(0.1, 0.6, 0.6), 3).moved(shifted(-gap - 0.1, 0.0, 0.0))));
  const Interference out = evaluated(walls, kRing, Pose{});
  ASSERT_EQ(out.sites.size(), 2u);
  EXPECT_NEAR(out.sites[0].volume, out.sites[1].volume, 1e-4 * out.sites[0].volume);
  for (const VolumeMetrics& site : out.sites) EXPECT_NEAR(std::abs(site.normal().x()), 1.0, 1e-6);
  EXPECT_LE(out.total.area_vector.norm(), 1e-4 * out.total.area);
}

TEST(TorusColumns, WhatLiesInTheHoleOrOverItTouchesNothing) {
  const Mesh block = mesh_of(box_soup(Vec3::Constant(0.1), 4));
  EXPECT_EQ(evaluated(block, kRing, Pose{}).total.volume, 0.0);
  EXPECT_EQ(evaluated(block, kRing, shifted(0.0, 0.0, 0.25)).total.volume, 0.0);
}

TEST(TorusColumns, ABodyInsideOfAnotherIsContained) {
  const Mesh small = mesh_of(box_soup(Vec3::Constant(0.03), 2));
  const Mesh large = mesh_of(box_soup(Vec3::Constant(0.6), 2));
  const Interference inner = evaluated(small, kRing, shifted(0.0, -kMajor, 0.01));
  EXPECT_EQ(inner.total.status, Status::kContained);
  EXPECT_NEAR(inner.total.volume, std::pow(0.06, 3), 1e-3 * std::pow(0.06, 3));
  const Interference outer = evaluated(large, kRing, shifted(0.01, 0.0, 0.02));
  EXPECT_EQ(outer.total.status, Status::kContained);
  EXPECT_NEAR(outer.total.volume, kRing.own_metrics().volume, 1e-12);
  EXPECT_LE((outer.total.inertia - kRing.own_metrics().inertia).norm(), 1e-12);
}

// A block whose face holds the axis cuts the circle in the middle of the tube, where lines end.
TEST(TorusColumns, HalfARingIsHalfOfIt) {
  const VolumeMetrics own = kRing.own_metrics();
  const Mesh block = mesh_of(box_soup(Vec3::Constant(0.6), 3));
  for (const Vec3& way : {Vec3(0.6, 0.0, 0.013), Vec3(0.0, 0.6, 0.007)}) {
    const Interference out = evaluated(block, kRing, Pose{Mat3::Identity(), way});
    EXPECT_EQ(out.engine, Engine::kColumns);
    EXPECT_NEAR(out.total.volume, 0.5 * own.volume, 5e-4 * own.volume);
  }
}

// The circle in the middle of the tube runs in a plane of symmetry of a cone of many sides, which
// holds edges of it: it passes through the surface where two faces meet, and rounding may let it
// miss both. Where it did so on its way in and on its way out, a part of the ring was lost.
TEST(TorusColumns, TheCircleThroughEdges) {
  const Torus ring({.major_radius = 0.35, .minor_radius = 0.02});
  constexpr int kSides = 12;
  test::Soup soup;
  for (const double z : {-0.24, 0.2}) {
    const double radius = z < 0.0 ? 0.125 : 0.2;
    for (int i = 0; i < kSides; ++i) {
      const double angle = 2.0 * kPi * i / kSides;
      soup.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
    }
  }
  for (int i = 0; i < kSides; ++i) {
    const int j = (i + 1) % kSides;
    soup.triangles.push_back({i, j, j + kSides});
    soup.triangles.push_back({i, j + kSides, i + kSides});
  }
  for (int i = 1; i + 1 < kSides; ++i) {
    soup.triangles.push_back({0, i + 1, i});
    soup.triangles.push_back({kSides, kSides + i, kSides + 1 + i});
  }
  const Mesh mesh = mesh_of(soup);
  const ConvexPolytope polytope(soup.vertices);
  Random random(345);
  for (int i = 0; i < test::cases(100, 25); ++i) {
    const double turn = random.uniform(0.0, 6.0), c = std::cos(turn), s = std::sin(turn);
    Pose X;  // the axis of the ring is normal to the plane, to the last bit
    X.rotation = Mat3(s, c, 0, 0, 0, 1, c, -s, 0);
    X.translation = Vec3(random.uniform(-0.3, 0.3), 0.0, random.uniform(-0.3, 0.3));
    if (i % 3 == 0) X.translation.z() = -0.24 + 3e-12;
    const Interference out = evaluated(mesh, ring, X);
    const VolumeMetrics expected = evaluated(polytope, ring, X, Engine::kLines, 1e-5).total;
    EXPECT_NEAR(out.total.volume, expected.volume,
                out.total.volume_error + expected.volume_error + 1e-5 * expected.volume)
        << i;
    EXPECT_EQ(out.engine, Engine::kColumns) << i;
  }
}

TEST(TorusColumns, TheAreaVectorIsTheGradientOfTheVolume) {
  const Mesh mesh = mesh_of(test::bumpy_soup(4, 1));
  const Pose X_AB{test::turn(Vec3(1.0, 2.0, 3.0), 0.7), Vec3(0.3, -0.5, 0.8).normalized() * 1.1};
  const VolumeMetrics m = evaluated(mesh, kRing, X_AB, Engine::kColumns, 1e-6).total;
  ASSERT_TRUE(m.touching());
  const auto volume = [&](const Pose& X) {
    return evaluated(mesh, kRing, X, Engine::kColumns, 1e-6).total.volume;
  };
  const test::Gradient g = test::gradient_of_A(volume, X_AB, 1e-3);
  EXPECT_LE((g.shift - m.area_vector).norm(), 2e-3 * m.area);
  EXPECT_LE((g.turn - m.area_moment).norm(), 2e-3 * m.area);
}

TEST(TorusColumns, TheOtherOrderIsTheMirrorImage) {
  const Mesh plate = mesh_of(box_soup(Vec3(0.6, 0.6, 0.2), 4));
  const Pose X_AB{test::turn(Vec3(1.0, 0.2, 0.0), 0.3), Vec3(0.0, 0.0, 0.35)};
  const VolumeMetrics one = evaluated(plate, kRing, X_AB).total;
  const VolumeMetrics two = evaluated(kRing, plate, X_AB.inverse()).total;
  ASSERT_TRUE(one.touching());
  EXPECT_NEAR(one.volume, two.volume, 1e-9 * one.volume);
  EXPECT_LE((X_AB.rotation * two.area_vector + one.area_vector).norm(), 1e-6 * one.area);
}

// A face along a ring's highest circle, or but for rounding: divided into needles along it. Squares
// took a million.
TEST(TorusColumns, AFaceAlongARingIsDividedIntoFew) {
  for (const double minor : {0.005, 0.02, 0.1, 0.29}) {
    if (test::kSanitized && minor < 0.1) continue;
    const RadialWall wall(Torus({.major_radius = kMajor, .minor_radius = minor}));
    for (const double off : {0.0, 1e-15, -1e-15, 1e-12, -1e-12, 1e-9, -1e-9, -1e-7}) {
      const double z = minor + off;
      const Vec3 face[3] = {{-1.0, -1.0, z}, {1.0, -0.9, z}, {0.1, 1.2, z}};
      std::vector<RadialPart> parts;
      EXPECT_TRUE(divide_at_wall(wall, face, 0, 0, 100000, parts)) << minor << ' ' << off;
    }
  }
}

// The segment of the tube that stands out of a box goes all round (Pappus).
TEST(TorusColumns, ABoxUpToTheHighestCircleOfARing) {
  for (const double minor : {0.02, 0.05, 0.1}) {
    if (test::kSanitized && minor != 0.05) continue;
    const Torus ring({.major_radius = kMajor, .minor_radius = minor});
    const double whole = ring.own_metrics().volume;
    for (const double out : {0.0, 1e-15, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3}) {
      const Mesh box = mesh_of(box_soup(Vec3(0.5, 0.5, 0.2), 2));
      const double height = minor - out, half = std::sqrt(std::max(0.0, out * (2.0 * minor - out)));
      const double segment = minor * minor * std::atan2(half, height) - height * half;
      const Interference found = evaluated(box, ring, shifted(0.0, 0.0, 0.2 - height));
      const VolumeMetrics& inside = found.total;
      EXPECT_EQ(found.engine, Engine::kColumns) << minor << ' ' << out;
      const double left = whole - 2.0 * kPi * kMajor * segment;
      EXPECT_NEAR(inside.volume, left, inside.volume_error + 1e-9 * left) << minor << ' ' << out;
      const VolumeMetrics cap = evaluated(box, ring, shifted(0.0, 0.0, height + 0.2)).total;
      const double expected = whole - left;
      EXPECT_NEAR(cap.volume, expected, cap.volume_error + 1e-12 * whole) << minor << ' ' << out;
    }
  }
}

}  // namespace
}  // namespace volcontact::torus_columns_test
