// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/bore/composed_sections.h"

#include <gtest/gtest.h>

#include "core/support/csg_solids.h"
#include "core/support/evaluated.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"
#include "volcontact/pair/interference.h"

namespace volcontact::composed_sections_test {
namespace {

using test::evaluated;

Csg box(double x, double y, double z, const Vec3& at) {
  return Csg(Box({.half_sizes = {x, y, z}}), {Mat3::Identity(), at});
}

TEST(ComposedLines, ATableHasFourSites) {
  Csg table = box(0.5, 0.4, 0.02, {0.0, 0.0, 0.5});
  for (double x : {-0.4, 0.4}) {
    for (double y : {-0.3, 0.3}) table = table + box(0.03, 0.03, 0.25, {x, y, 0.24});
  }
  const double depth = 0.001;
  const Interference out =
      evaluated(HalfSpace(), table, {Mat3::Identity(), {0.0, 0.0, 0.01 - depth}}, Engine::kLines);
  ASSERT_EQ(out.sites.size(), 4u);
  for (const VolumeMetrics& site : out.sites) {
    EXPECT_NEAR(site.volume, 0.06 * 0.06 * depth, 1e-6 * site.volume);
    EXPECT_NEAR(site.area, 0.06 * 0.06, 1e-6 * site.area);
    EXPECT_NEAR(std::abs(site.centroid.x()), 0.4, 1e-9);
    EXPECT_NEAR(std::abs(site.centroid.y()), 0.3, 1e-9);
  }
  EXPECT_NEAR(out.total.area_vector.z(), 4.0 * 0.06 * 0.06, 1e-6);
}

// An L of two bars: the seam between them is no surface, and no border of a site.
TEST(ComposedLines, ASeamJoinsItsSides) {
  const Csg bars = box(0.3, 0.1, 0.1, {0.2, 0.0, 0.0}) + box(0.1, 0.3, 0.1, {0.0, 0.2, 0.0});
  const double depth = 0.01, area = 0.6 * 0.2 + 0.2 * 0.4;
  const Interference out =
      evaluated(HalfSpace(), bars, {Mat3::Identity(), {0.0, 0.0, 0.1 - depth}}, Engine::kLines);
  ASSERT_EQ(out.sites.size(), 1u);
  EXPECT_NEAR(out.total.volume, area * depth, 1e-6 * area * depth);
  EXPECT_NEAR(out.total.area, area, 1e-6 * area);
  // The foot and the walls around it: 2 x (0.6 + 0.6).
  EXPECT_NEAR(out.total.counter_area, area + 2.4 * depth, 1e-5 * area);
  EXPECT_LE((out.total.area_vector - area * Vec3::UnitZ()).norm(), 1e-6 * area);
}

// The part below the blind hole lies in the half-space as a whole: its surface counts as well.
TEST(ComposedLines, APartInsideAsAWholeHasItsArea) {
  const double r = 0.25, half = 0.1, bore = 0.12, floor = 0.02, level = 0.05;
  const Shape pot =
      Csg(Csg::Operation::kDifference, Csg(Cylinder({.radius = r, .half_length = half})),
          Csg(Cylinder({.radius = bore, .half_length = half}))
              .posed({Mat3::Identity(), {0.0, 0.0, floor + half}}));
  const Pose X{Mat3::Identity(), {0.1, 0.0, -level}};
  const Interference out = evaluated(HalfSpace(), pot, X);
  EXPECT_EQ(out.engine, Engine::kLines);
  ASSERT_EQ(out.sites.size(), 1u);
  const double ring = kPi * (r * r - bore * bore);
  const double walls = 2.0 * kPi * (r * (half + level) + bore * (level - floor));
  EXPECT_NEAR(out.total.area, ring, 1e-5 * ring);
  EXPECT_NEAR(out.total.counter_area, kPi * (r * r + bore * bore) + walls, 1e-5);
  EXPECT_NEAR(out.total.area_vector.z(), ring, 1e-5 * ring);
}

// A ball where a pipe's bore widens to a chamfer, all of it in the pipe: the seam between the two
// pieces is no surface, and what is left of the area vectors is rounding, which has a direction.
TEST(ComposedLines, WhatSeamsLeaveOfTheAreaVectorHasNoDirection) {
  const Csg pipe = testing::tube(.25, .095) - testing::tube(.05, .2) -
                   testing::cone(.05, .088, .019, testing::at(0, 0, .076));
  const double volume = 4.0 / 3.0 * kPi * .05 * .05 * .05;
  test::Random random(7);
  for (int i = 0; i < 50; ++i) {
    const double angle = random.uniform(0.0, 2.0 * kPi);
    const Pose X(random.pose(0.0).rotation,
                 Vec3(.17 * std::cos(angle), .17 * std::sin(angle), random.uniform(.03, .04)));
    const VolumeMetrics m = evaluated(Sphere({.radius = .05}), pipe, X.inverse()).total;
    EXPECT_NEAR(m.volume, volume, 1e-5 * volume);
    EXPECT_LE(m.area_vector.norm(), std::min(m.area, m.counter_area) * (1.0 + 1e-12));
    EXPECT_TRUE(m.normal().isZero(0.0));
  }
}

TEST(ComposedLines, StaysWithinTheCertifiedBoundsOfTheOctree) {
  const Csg block(Box({.half_sizes = {0.3, 0.25, 0.2}}));
  const Csg bore(Cylinder({.radius = 0.1, .half_length = 0.5}));
  const Csg wide(Cylinder({.radius = 0.16, .half_length = 0.1}),
                 {Mat3::Identity(), {0.0, 0.0, 0.2}});
  const Csg blind(Cylinder({.radius = 0.1, .half_length = 0.2}),
                  {Mat3::Identity(), {0.0, 0.0, 0.2}});
  const std::vector<Csg> solids = {block - bore, (block - bore) - wide, block - blind,
                                   Csg(Cylinder({.radius = 0.25, .half_length = 0.2})) - bore,
                                   block + box(0.1, 0.1, 0.3, {0.2, 0.0, 0.3})};
  const std::vector<Shape> others = {
      HalfSpace(), Sphere({.radius = 0.15}), Cylinder({.radius = 0.09, .half_length = 0.3}),
      Box({.half_sizes = {0.2, 0.05, 0.1}}), Capsule({.radius = 0.08, .half_length = 0.2})};
  test::Random random(51);
  int by_lines = 0, touching = 0;
  const int kPoses = test::cases(6, 1);
  for (const Csg& solid : solids) {
    ASSERT_TRUE(solid.is_carved());
    for (const Shape& other : others) {
      for (int k = 0; k < kPoses; ++k) {
        const Pose X = random.pose(0.4);
        const Interference out = evaluated(other, solid, X, Engine::kLines);
        if (out.engine == Engine::kOctree) continue;
        ++by_lines;
        const Interference octree = evaluated(other, solid, X, Engine::kOctree, 3e-2);
        const VolumeMetrics &m = out.total, &o = octree.total;
        touching += m.touching();
        EXPECT_LE(std::abs(m.volume - o.volume), o.volume_error + m.volume_error + 1e-12)
            << name_of(other) << " pose " << k;
        EXPECT_TRUE(is_finite(m));
      }
    }
  }
  EXPECT_GT(by_lines, 10 * kPoses);
  EXPECT_GT(touching, 5 * kPoses);
}

}  // namespace
}  // namespace volcontact::composed_sections_test
