// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/torus/torus_in_composed.h"

#include <gtest/gtest.h>

#include "core/support/csg_solids.h"
#include "core/support/evaluated.h"
#include "core/support/matchers.h"
#include "core/support/random.h"

namespace volcontact::torus_in_composed_test {
namespace {

using test::evaluated;
using namespace testing;

constexpr double kMajor = 0.3, kMinor = 0.1;
const Shape kRing = Torus({.major_radius = kMajor, .minor_radius = kMinor});

// Two boxes that share a face are one box.
TEST(TorusInComposed, ASeamIsNoSurface) {
  const Shape two = box(0.2, 0.2, 0.1, at(-0.2, 0.0, 0.0)) + box(0.2, 0.2, 0.1, at(0.2, 0.0, 0.0));
  const Shape one = Box({.half_sizes = {0.4, 0.2, 0.1}});
  ASSERT_EQ(engine_for(kRing, two), Engine::kLines);
  test::Random random(1);
  for (int i = 0; i < 40; ++i) {
    const Pose X{random.rotation(), random.in_box(0.4)};
    const Interference out = evaluated(kRing, two, X), expected = evaluated(kRing, one, X);
    EXPECT_EQ(out.engine, Engine::kLines);
    const VolumeMetrics &m = out.total, &e = expected.total;
    ASSERT_NEAR(m.volume, e.volume, 1e-4 * e.volume + 1e-15);
    if (!e.touching()) continue;
    EXPECT_LE((m.centroid - e.centroid).norm(), 1e-4 * kMajor);
    EXPECT_LE((m.inertia - e.inertia).norm(), 1e-3 * e.inertia.norm());
    EXPECT_LE((m.area_vector - e.area_vector).norm(), 1e-2 * std::max(e.area, e.counter_area));
    EXPECT_LE((m.area_moment - e.area_moment).norm(),
              1e-2 * std::max(e.area, e.counter_area) * kMajor);
    EXPECT_NEAR(m.area, e.area, 1e-3 * e.area);
    EXPECT_EQ(out.sites.size(), expected.sites.size()) << i;
  }
}

TEST(TorusInComposed, BothOrdersAgree) {
  const Shape corner = box(0.2, 0.05, 0.2) + box(0.05, 0.2, 0.2, at(0.15, 0.15, 0.0));
  test::Random random(2);
  for (int i = 0; i < 20; ++i) {
    const Pose X{random.rotation(), random.in_box(0.3)};
    const Interference out = evaluated(kRing, corner, X),
                       swapped = evaluated(corner, kRing, X.inverse());
    ASSERT_EQ(out.sites.size(), swapped.sites.size());
    if (!out.total.touching()) continue;
    EXPECT_TRUE(test::same(reversed(transformed(swapped.total, X)), out.total, {1e-9, kMajor}));
  }
}

TEST(TorusInComposed, ARingOnABoredBlockFarFromTheBoreIsOnABlock) {
  const Shape bored = box(0.5, 0.5, 0.1) - tube(0.05, 0.5),
              block = Box({.half_sizes = {.5, .5, .1}});
  // Around the bore, lying flat; and its edge beside the bore, upright.
  const Pose flat{Mat3::Identity(), {0.0, 0.0, -0.19}};
  const Pose upright{test::turn(Vec3::UnitX(), 0.5 * kPi), {0.1, -0.35, 0.2}};
  for (const Pose& X : {flat, upright}) {
    const Interference out = evaluated(kRing, bored, X), expected = evaluated(kRing, block, X);
    EXPECT_EQ(out.engine, Engine::kLines);
    EXPECT_GT(out.total.volume, 0.0);
    EXPECT_NEAR(out.total.volume, expected.total.volume, 1e-5 * expected.total.volume);
    EXPECT_EQ(out.sites.size(), expected.sites.size());
  }
}

// Over the rim of the bore the surface of the overlap serves; the answer is that of neither block
// nor bore.
TEST(TorusInComposed, ABoreInReachIsServed) {
  const Shape bored = box(0.5, 0.5, 0.1) - tube(0.2, 0.5),
              block = Box({.half_sizes = {.5, .5, .1}});
  const Shape plug = Cylinder({.radius = 0.2, .half_length = 0.1});
  const Pose X{Mat3::Identity(), {0.2, 0.0, -0.19}};
  const Interference out = evaluated(kRing, bored, X);
  EXPECT_EQ(out.engine, Engine::kSurfaceSweep);
  const double expected =
      evaluated(kRing, block, X).total.volume - evaluated(kRing, plug, X).total.volume;
  EXPECT_NEAR(out.total.volume, expected, 1e-4 * expected);
}

TEST(TorusInComposed, OctreeBoundsHoldTheVolume) {
  const Shape corner = box(0.2, 0.05, 0.2) + box(0.05, 0.2, 0.2, at(0.15, 0.15, 0.0));
  test::Random random(3);
  for (int i = 0; i < 3; ++i) {
    const Pose X{random.rotation(), random.in_box(0.3)};
    const Interference out = evaluated(kRing, corner, X),
                       octree = evaluated(kRing, corner, X, Engine::kOctree, 2e-2);
    EXPECT_EQ(out.engine, Engine::kLines);
    EXPECT_NEAR(out.total.volume, octree.total.volume,
                octree.total.volume_error + 1e-4 * out.total.volume);
    EXPECT_EQ(out.sites.size(), octree.sites.size());
  }
}

}  // namespace
}  // namespace volcontact::torus_in_composed_test
