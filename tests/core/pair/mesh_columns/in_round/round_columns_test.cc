// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/in_round/round_columns.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/support/evaluated.h"
#include "core/support/gradient.h"
#include "core/support/matchers.h"
#include "core/support/meshes.h"
#include "core/support/overlapping.h"
#include "core/support/sanitized.h"

namespace volcontact::round_columns_test {
namespace {

using test::box_soup;
using test::evaluated;
using test::mesh_of;
using test::overlapping;
using test::Random;
using test::shifted;
using test::Soup;

std::vector<Shape> round_solids() {
  return {Sphere({.radius = 0.3}),
          Ellipsoid({.semi_axes = Vec3(0.2, 0.3, 0.4)}),
          Cylinder({.radius = 0.2, .half_length = 0.3}),
          Capsule({.radius = 0.15, .half_length = 0.25}),
          Frustum({.bottom_radius = 0.3, .top_radius = 0.1, .half_length = 0.25}),
          Frustum({.bottom_radius = 0.3, .top_radius = 0.0, .half_length = 0.25})};
}

// Against what is claimed: where a face turns away from the columns within a triangle, the rule on
// it is no better than a rough one. An estimate, not a bound: it may
// be short by half in one of 100.
TEST(RoundColumns, TheErrorIsAboutWhatIsClaimed) {
  const int kPoses = test::cases(120, 40, 5);
  const Shape solids[] = {Sphere({.radius = 0.3}), Ellipsoid({.semi_axes = Vec3(0.2, 0.3, 0.4)}),
                          Capsule({.radius = 0.15, .half_length = 0.25}),
                          Cylinder({.radius = 0.2, .half_length = 0.3}),
                          Frustum({.bottom_radius = 0.3, .top_radius = 0.1, .half_length = 0.25})};
  Random random(23);
  int beyond = 0;
  for (const Shape& b : solids) {
    for (int i = 0; i < kPoses; ++i) {
      const Vec3 half = Vec3(0.3, 0.3, 0.3) + random.in_box(0.2);
      const Pose X = random.pose(0.4);
      const VolumeMetrics m = evaluated(mesh_of(box_soup(half)), b, X, Engine::kColumns).total;
      const VolumeMetrics expected =
          evaluated(Box({.half_sizes = half}), b, X, Engine::kLines, 1e-7).total;
      const double error = std::abs(m.volume - expected.volume);
      const double claimed = m.volume_error + expected.volume_error + 1e-16;
      beyond += error > claimed;
      EXPECT_LE(error, 2.0 * claimed) << name_of(b) << " " << i;
    }
  }
  EXPECT_LE(beyond, 3 * kPoses / 100 + 1);
}

// Edges and rims that dip into a face: where the lines down pass the image of a rim, what lies
// between it and its chords counts, and an arc of it that a triangle sees from beyond one side.
TEST(RoundColumns, TheErrorOfShallowOverlapsIsAboutWhatIsClaimed) {
  const int kPoses = test::cases(120, 40, 5);
  Random random(99);
  int beyond = 0, compared = 0;
  for (const Shape& b : round_solids()) {
    for (int i = 0; i < kPoses; ++i) {
      const Vec3 half = Vec3(0.3, 0.3, 0.3) + random.in_box(0.2);
      const Box box({.half_sizes = half});
      const Pose X = overlapping(box, b, random, std::pow(10.0, random.uniform(-4.0, -1.0)));
      const Interference out = evaluated(mesh_of(box_soup(half, 1 + 5 * (i % 3))), b, X);
      if (out.engine != Engine::kColumns) continue;
      ++compared;
      const VolumeMetrics expected = evaluated(box, b, X, Engine::kLines, 1e-7).total;
      const double error = std::abs(out.total.volume - expected.volume);
      const double claimed = out.total.volume_error + expected.volume_error + 1e-16;
      beyond += error > claimed;
      EXPECT_LE(error, 2.0 * claimed) << name_of(b) << " " << i;
    }
  }
  EXPECT_GT(compared, 5 * kPoses);
  EXPECT_LE(beyond, compared / 100);
}

// An upright cylinder sunk into a corner or an edge of a plate: the mean normal leans a little from
// its wall, along which the columns end within a hair of the outline, between an arc and its chord.
TEST(RoundColumns, ColumnsAlongAWallAreShortAtItAlone) {
  const Vec3 half(0.4, 0.4, 0.05);
  const Mesh plate = mesh_of(box_soup(half));
  for (const double radius : {0.1, 0.25, 0.4 * std::sqrt(2.0), 0.7}) {
    const Shape solids[] = {
        Cylinder({.radius = radius, .half_length = 0.05}),
        Frustum(
            {.bottom_radius = radius, .top_radius = radius * (1.0 - 1e-9), .half_length = 0.05})};
    for (const Shape& b : solids) {
      for (const double depth : {1e-3, 0.01, 0.03}) {
        for (const bool corner : {false, true}) {
          if (!corner && radius > half.x()) continue;
          const double share = corner ? 0.25 : 0.5;
          const Pose X = shifted(half.x(), corner ? half.y() : 0.0, depth - 0.1);
          const VolumeMetrics m = evaluated(plate, b, X, Engine::kColumns).total;
          const double expected = share * kPi * radius * radius * depth;
          EXPECT_NEAR(m.volume, expected, m.volume_error) << radius << " " << depth << " " << share;
          EXPECT_NEAR(m.volume, expected, 2e-4 * expected) << radius << " " << depth;
        }
      }
    }
  }
}

// Lines through the box itself are the oracle.
TEST(RoundColumns, AMeshOfABoxMeetsRoundSolidsAsTheBox) {
  const int kPoses = test::cases(60, 20, 6);
  const Vec3 half(0.5, 0.4, 0.3);
  const Box box({.half_sizes = half});
  Random random(1);
  for (const Shape& b : round_solids()) {
    int compared = 0;
    double worst = 0.0;
    std::vector<double> errors;
    for (int i = 0; i < kPoses; ++i) {
      const Mesh mesh = mesh_of(box_soup(half, 1 + 5 * (i % 3)));
      const Pose X_AB = overlapping(box, b, random, std::pow(10.0, random.uniform(-4.0, -1.0)));
      const VolumeMetrics expected = evaluated(box, b, X_AB, Engine::kLines, 1e-6).total;
      const Interference out = evaluated(mesh, b, X_AB);
      if (out.engine != Engine::kColumns) continue;
      ++compared;
      const VolumeMetrics& m = out.total;
      const double error = std::abs(m.volume - expected.volume) / expected.volume;
      errors.push_back(error);
      worst = std::max(worst, error);
      EXPECT_LE(error, 5e-3);
      EXPECT_LE((m.centroid - expected.centroid).norm(), 0.05 * std::cbrt(expected.volume));
      EXPECT_LE((m.area_vector - expected.area_vector).norm(), 2e-3 * expected.area);
      EXPECT_LE((m.area_moment - expected.area_moment).norm(), 2e-3 * expected.area);
      EXPECT_NEAR(m.area, expected.area, 1e-3 * expected.area);
      EXPECT_LE((m.inertia - expected.inertia).norm(), 0.03 * expected.inertia.norm());
    }
    std::sort(errors.begin(), errors.end());
    EXPECT_GE(compared, kPoses / 10 * 9);
    EXPECT_LE(errors[errors.size() / 2], 5e-5);
    EXPECT_LE(errors[errors.size() * 9 / 10], 1e-3);
  }
}

// Anywhere in each other, also where no direction sees the surface of one in the other whole.
TEST(RoundColumns, DeepOverlapsAreThoseOfTheBox) {
  const int kPoses = test::cases(40, 15, 3);
  const Vec3 half(0.24, 0.08, 0.6);
  const Box box({.half_sizes = half});
  Random random(7);
  for (const Shape& b : round_solids()) {
    std::vector<double> errors;
    int approximate = 0;
    for (int i = 0; i < kPoses; ++i) {
      const Mesh mesh = mesh_of(box_soup(half, 1 + 5 * (i % 3)));
      const Pose X_AB = random.pose(0.2);
      const VolumeMetrics expected = evaluated(box, b, X_AB, Engine::kLines, 1e-6).total;
      if (expected.status == Status::kContained || !expected.touching()) continue;
      const Interference out = evaluated(mesh, b, X_AB);
      EXPECT_EQ(out.engine, Engine::kColumns);
      const VolumeMetrics& m = out.total;
      const double error = std::abs(m.volume - expected.volume);
      errors.push_back(error / expected.volume);
      if (m.status == Status::kApproximate) {  // little is left of much
        ++approximate;
        EXPECT_LE(error, m.volume_error);
        continue;
      }
      EXPECT_LE(error, 1e-3 * expected.volume);
      EXPECT_LE((m.centroid - expected.centroid).norm(), 2e-3 * std::cbrt(expected.volume));
      EXPECT_LE((m.area_vector - expected.area_vector).norm(), 1e-3 * expected.area);
      EXPECT_LE((m.area_moment - expected.area_moment).norm(), 1e-3 * expected.area);
      EXPECT_LE((m.inertia - expected.inertia).norm(), 0.01 * expected.inertia.norm());
      // A depth is no more than the overlap is wide.
      EXPECT_GT(m.depth, 0.0);
      EXPECT_LE(m.depth, 2.0 * half.norm());
      EXPECT_LE(m.depth_moment, m.volume * m.depth);
    }
    std::sort(errors.begin(), errors.end());
    ASSERT_GE(errors.size(), kPoses / 4u * 3u);
    EXPECT_LE(approximate, kPoses / 10);
    EXPECT_LE(errors[errors.size() / 2], 5e-5);
  }
}

TEST(RoundColumns, ABallOnAFaceIsACap) {
  const double r = 0.3;
  for (int n : {1, 3, 20}) {
    const Mesh mesh = mesh_of(box_soup(Vec3(0.5, 0.4, 0.3), n));
    for (double depth : {1e-5, 1e-3, 1e-2}) {
      const VolumeMetrics m =
          evaluated(mesh, Sphere({.radius = r}), shifted(0.07, 0.03, 0.3 + r - depth)).total;
      const double volume = kPi * depth * depth * (r - depth / 3.0);
      EXPECT_NEAR(m.volume, volume, 1e-5 * volume);
      EXPECT_LE(std::abs(m.volume - volume), m.volume_error);
      EXPECT_NEAR(m.area_vector.z(), kPi * depth * (2.0 * r - depth), 2e-5 * m.area);
      EXPECT_NEAR(m.counter_area, 2.0 * kPi * r * depth, 1e-4 * m.counter_area);
      // int L^2/2 dA over the cap, by its heights h: L = sqrt(r^2 - s^2) - (r - depth).
      const double a = r - depth;
      const double moment =
          kPi * (std::pow(r, 4) / 4.0 - std::pow(a, 4) / 4.0 -
                 2.0 * a * (r * r * r - a * a * a) / 3.0 + a * a * (r * r - a * a) / 2.0);
      EXPECT_NEAR(m.depth_moment, moment, 1e-3 * moment + 1e-12 * std::pow(r, 4));
      EXPECT_NEAR(m.depth, depth, 0.05 * depth);
      EXPECT_NEAR(m.normal().z(), -1.0, 1e-6);
    }
  }
}

TEST(RoundColumns, APegStandsOnItsCap) {
  const Mesh mesh = mesh_of(box_soup(Vec3(0.5, 0.5, 0.2), 7));
  const double r = 0.2, depth = 1e-3;
  const Interference out = evaluated(mesh, Cylinder({.radius = r, .half_length = 0.3}),
                                     shifted(0.01, 0.02, 0.5 - depth));
  EXPECT_EQ(out.engine, Engine::kColumns);
  EXPECT_NEAR(out.total.volume, kPi * r * r * depth, 1e-5 * out.total.volume);
  EXPECT_NEAR(out.total.depth_moment, 0.5 * kPi * r * r * depth * depth,
              1e-4 * out.total.depth_moment);
}

TEST(RoundColumns, APlateThatIsPiercedTakesASlice) {
  const double r = 0.5, half = 0.05, z = 0.1;
  const Mesh plate = mesh_of(box_soup(Vec3(1.0, 1.0, half), 6));
  const Interference out = evaluated(plate, Sphere({.radius = r}), shifted(0.1, 0.05, z));
  const auto below = [&](double h) { return kPi * (r * r * h - h * h * h / 3.0); };
  const double volume = below(half - z) - below(-half - z);
  EXPECT_EQ(out.engine, Engine::kColumns);
  ASSERT_EQ(out.sites.size(), 1u);
  EXPECT_NEAR(out.total.volume, volume, 1e-3 * volume);
  EXPECT_NEAR(out.total.centroid.x(), 0.1, 1e-3);
  EXPECT_LE(std::abs(out.total.centroid.z()), 2e-2 * half);
}

TEST(RoundColumns, ABodyInsideOfAnotherIsContained) {
  const Mesh mesh = mesh_of(test::bumpy_soup(3, 1));
  const Sphere small({.radius = 0.2}), large({.radius = 2.0});
  const Interference inner = evaluated(mesh, small, shifted(0.1, 0.2, 0.3));
  EXPECT_EQ(inner.total.status, Status::kContained);
  EXPECT_NEAR(inner.total.volume, small.own_metrics().volume, 1e-15);
  EXPECT_LE((inner.total.centroid - Vec3(0.1, 0.2, 0.3)).norm(), 1e-15);
  const Interference outer = evaluated(mesh, large, shifted(0.1, 0.2, 0.3));
  EXPECT_EQ(outer.total.status, Status::kContained);
  EXPECT_NEAR(outer.total.volume, mesh.own_metrics().volume, 1e-14);
  EXPECT_EQ(evaluated(mesh, small, shifted(2.0, 0.0, 0.0)).total.volume, 0.0);
}

TEST(RoundColumns, CavitiesHoldNothing) {
  const double inside = 0.6;
  const Soup core = test::ball_soup(3).moved({inside * Mat3::Identity(), Vec3::Zero()});
  const Mesh hollow = mesh_of(test::ball_soup(3).with(core.inside_out()));
  EXPECT_EQ(evaluated(hollow, Sphere({.radius = 0.3}), shifted(0.1, 0.0, 0.0)).total.volume, 0.0);
  // In the cavity, and a little into its wall.
  const Interference wall =
      evaluated(hollow, Sphere({.radius = 0.3}), shifted(0.0, 0.0, inside - 0.3 + 0.01));
  EXPECT_GT(wall.total.volume, 0.0);
  EXPECT_LT(wall.total.volume, kPi * 0.01 * 0.02 * 0.3 * 2.0);
  EXPECT_LT(wall.total.area_vector.z(), 0.0);
  // Over all of the cavity: what the full ball has there, less the cavity.
  const Pose X_AB = shifted(0.0, 0.0, 0.2);
  const Sphere large({.radius = 0.9});
  const double full = evaluated(mesh_of(test::ball_soup(3)), large, X_AB).total.volume;
  EXPECT_NEAR(evaluated(hollow, large, X_AB).total.volume,
              full - mesh_of(core).own_metrics().volume, 1e-3 * full);
}

TEST(RoundColumns, ANeedleInTheMiddleIsNotAllOfTheBall) {
  const double half = 0.002, r = 0.3, depth = 0.4;
  const Soup shaft = box_soup(Vec3(half, half, 0.4)).moved(shifted(0.0, 0.0, r - depth + 0.4));
  const Sphere ball({.radius = r});
  const double volume = 4.0 * half * half * depth;
  const Interference out = evaluated(mesh_of(shaft), ball, Pose{});
  EXPECT_EQ(out.engine, Engine::kColumns);
  EXPECT_NEAR(out.total.volume, volume, 1e-3 * volume);
  // Nor is a hole as thin.
  const Mesh bored = mesh_of(box_soup(Vec3::Constant(1.0)).with(shaft.inside_out()));
  EXPECT_NEAR(evaluated(bored, ball, Pose{}).total.volume, ball.own_metrics().volume - volume,
              1e-3 * volume);
}

// Lines through the box itself are the oracle. The area vector vanishes: nothing says where to
// look.
TEST(RoundColumns, ABarThroughTheMiddleTakesItsPart) {
  const std::vector<Shape> solids = {
      Sphere({.radius = 0.3}), Ellipsoid({.semi_axes = Vec3(0.3, 0.25, 0.35)}),
      Cylinder({.radius = 0.3, .half_length = 0.2}), Capsule({.radius = 0.25, .half_length = 0.1}),
      Frustum({.bottom_radius = 0.3, .top_radius = 0.2, .half_length = 0.2})};
  Random random(21);
  for (const Shape& b : solids) {
    for (int axis = 0; axis < test::cases(3, 1, 1); ++axis) {
      Vec3 half(0.1, 0.1, 0.1);
      half[axis] = 0.4;
      const Box box({.half_sizes = half});
      const Mesh bar = mesh_of(box_soup(half, 1 + axis));
      for (double off : {0.0, 1e-15, 1e-9, 1e-6}) {
        if (test::kSanitized && off > 1e-15) continue;
        for (int k = 0; k < test::cases(3, 2, 1); ++k) {
          // Turned about the bar, and along it: the middle stays on its axis.
          const Mat3 about = test::turn(Vec3::Unit(axis), k == 0 ? 0.0 : random.uniform(0.0, 6.0));
          Pose X_AB{about * test::turn(random.direction(), off), off * random.in_box(1.0)};
          if (k == 2) X_AB.translation[axis] += random.uniform(-0.05, 0.05);
          const VolumeMetrics expected = evaluated(box, b, X_AB, Engine::kLines, 1e-4).total;
          for (const VolumeMetrics& m :
               {evaluated(bar, b, X_AB).total, evaluated(b, bar, X_AB.inverse()).total}) {
            EXPECT_NEAR(m.volume, expected.volume, 1e-3 * expected.volume) << axis << off;
            EXPECT_LE(std::abs(m.volume - expected.volume),
                      2.0 * (m.volume_error + expected.volume_error));
          }
        }
      }
    }
  }
}

TEST(RoundColumns, EachTouchedWallIsASite) {
  // A ball wedged in a channel between two walls.
  const Mesh walls =
      mesh_of(box_soup(Vec3(0.1, 1.0, 1.0), 5)
                  .moved(shifted(0.4, 0.0, 0.0))
                  .with(box_soup(Vec3(0.1, 1.0, 1.0), 5).moved(shifted(-0.4, 0.0, 0.0))));
  const double r = 0.302;
  const Interference out = evaluated(walls, Sphere({.radius = r}), Pose{});
  ASSERT_EQ(out.sites.size(), 2u);
  for (const VolumeMetrics& site : out.sites) {
    EXPECT_NEAR(site.volume, kPi * 4e-6 * (r - 0.002 / 3.0), 1e-5 * site.volume);
    EXPECT_NEAR(std::abs(site.normal().x()), 1.0, 1e-6);
  }
  EXPECT_LE(out.total.area_vector.norm(), 1e-4 * out.total.area);
}

// An inscribed ball of triangles has less volume by a share that falls fourfold with each level.
TEST(RoundColumns, ABumpyMeshMeetsABallAsItsLimitOfTriangles) {
  const Mesh mesh = mesh_of(test::bumpy_soup(4, 1));
  const Pose X_AB{test::turn(Vec3(1.0, 2.0, 3.0), 0.7), Vec3(0.3, -0.5, 0.8).normalized() * 1.3};
  const double r = 0.4;
  double volume[2], s[2];
  for (int i = 0; i < 2; ++i) {
    const Mesh ball = mesh_of(test::ball_soup(4 + i).moved({r * Mat3::Identity(), Vec3::Zero()}));
    const VolumeMetrics m = evaluated(mesh, ball, X_AB).total;
    volume[i] = m.volume;
    s[i] = m.area_vector.norm();
  }
  const VolumeMetrics m = evaluated(mesh, Sphere({.radius = r}), X_AB).total;
  ASSERT_GT(m.volume, 1e-3);
  EXPECT_NEAR(m.volume, volume[1] + (volume[1] - volume[0]) / 3.0, 2e-4 * m.volume);
  EXPECT_NEAR(m.area_vector.norm(), s[1] + (s[1] - s[0]) / 3.0, 2e-4 * m.area);
}

TEST(RoundColumns, AreaVectorAndMomentAreTheGradientOfTheVolume) {
  const Mesh mesh = mesh_of(test::bumpy_soup(3, 2));
  for (const Shape& b : round_solids()) {
    const Pose X_AB{test::turn(Vec3(1.0, -2.0, 0.5), 0.9), Vec3(0.25, 0.3, 1.1)};
    const VolumeMetrics m = evaluated(mesh, b, X_AB).total;
    ASSERT_GT(m.volume, 1e-5);
    const test::Gradient g = test::gradient_of_A(
        [&](const Pose& X) { return evaluated(mesh, b, X).total.volume; }, X_AB, 1e-3);
    EXPECT_LE((g.shift - m.area_vector).norm(), 3e-3 * m.area);
    EXPECT_LE((g.turn - m.area_moment).norm(), 3e-3 * m.area);
  }
}

TEST(RoundColumns, BothOrdersAgree) {
  const Mesh mesh = mesh_of(test::bumpy_soup(3, 2));
  for (const Shape& b : round_solids()) {
    const Pose X_AB{test::turn(Vec3(1.0, -2.0, 0.5), 0.9), Vec3(0.25, 0.3, 1.1)};
    const Interference one = evaluated(mesh, b, X_AB), other = evaluated(b, mesh, X_AB.inverse());
    EXPECT_TRUE(test::same(transformed(reversed(other.total), X_AB), one.total, {1e-6, 1.0}));
  }
}

// Faces along the axis cut the wall in straight lines, which leave no slivers; beside the columns
// straight below the faces the rod bulges.
TEST(RoundColumns, FacesAlongTheAxisSeeTheBulgeBelowThem) {
  const Mesh plate = mesh_of(box_soup(Vec3(.25, .35, .3), 8));
  const Cylinder rod({.radius = .3, .half_length = .25});
  const double segment = .09 * std::acos(.25 / .3) - .25 * std::sqrt(.09 - .0625);
  const double volume = .5 * (kPi * .09 - 2.0 * segment);
  for (const double y : {0.0, .05, .04}) {
    const Interference out = evaluated(plate, rod, shifted(0.0, y, 0.0));
    EXPECT_EQ(out.engine, Engine::kColumns);
    EXPECT_NEAR(out.total.volume, volume, 1e-5 * volume) << y;
  }
}

TEST(RoundColumns, EveryInstructionSetMakesTheSameBits) {
  const Mesh mesh = mesh_of(test::bumpy_soup(3, 2));
  SurfaceStore unused;
  for (const Shape& b : round_solids()) {
    std::vector<VolumeMetrics> results;
    for (SimdPath path : {SimdPath::kPortable, SimdPath::kAvx2, SimdPath::kAvx512}) {
      if (!can_run(path)) continue;
      RoundColumnsScratch scratch;
      scratch.search.path = path;
      scratch.cells.path = path;
      Interference out;
      std::visit(
          [&](const auto& solid) {
            if constexpr (HasRoundFaces<std::decay_t<decltype(solid)>>) {
              round_columns(surface_of(mesh, unused), ConvexView(solid),
                            {test::turn(Vec3(1.0, -2.0, 0.5), 0.9), Vec3(0.25, 0.3, 1.1)}, {},
                            scratch, out);
            }
          },
          b);
      results.push_back(out.total);
    }
    ASSERT_GT(results[0].volume, 0.0);
    for (const VolumeMetrics& m : results) EXPECT_TRUE(test::same(m, results[0], {0.0, 0.0}));
  }
}

}  // namespace
}  // namespace volcontact::round_columns_test
