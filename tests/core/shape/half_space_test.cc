// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/half_space.h"

#include <gtest/gtest.h>

#include "core/support/random.h"

namespace volcontact::half_space_test {
namespace {

using test::Random;

TEST(HalfSpace, DistanceIsTheHeight) {
  Random random(1);
  const HalfSpace solid;
  for (int i = 0; i < 100; ++i) {
    const Vec3 p = random.in_box(2.0);
    EXPECT_EQ(solid.signed_distance(p), p.z());
    EXPECT_EQ(solid.gradient(p), Vec3(0, 0, 1));
  }
}

TEST(HalfSpace, IsUnboundedInAllDirectionsButUp) {
  const HalfSpace solid;
  EXPECT_EQ(solid.support_height(Vec3(0, 0, 3)), 0.0);
  EXPECT_EQ(solid.support_height(Vec3(0, 0, -1)), kInfinity);
  EXPECT_EQ(solid.support_height(Vec3(1e-9, 0, 1)), kInfinity);
  EXPECT_EQ(solid.support(Vec3(0, 0, 1)).z(), 0.0);
  EXPECT_FALSE(solid.support(Vec3(1, 0, 1)).allFinite());
  EXPECT_FALSE(solid.bounds().bounded());
  EXPECT_EQ(solid.bounds().max.z(), 0.0);
  EXPECT_EQ(solid.own_metrics().volume, kInfinity);
  EXPECT_EQ(solid.own_metrics().status, Status::kUnbounded);
}

// Brute force: the sign of the height along the line.
TEST(HalfSpace, RayIsThePartBelow) {
  Random random(2);
  const HalfSpace solid;
  for (int i = 0; i < 200; ++i) {
    const Vec3 o = random.in_box(1.0), d = random.direction();
    const RayInterval span = solid.ray(o, d);
    for (double t = -3.0; t < 3.0; t += 0.17) {
      EXPECT_EQ(t > span.enter && t < span.leave, (o + t * d).z() < 0.0);
    }
  }
}

TEST(HalfSpace, LevelRayIsAllOrNothing) {
  const HalfSpace solid;
  EXPECT_EQ(solid.ray(Vec3(0, 0, -1), Vec3(1, 0, 0)).enter, -kInfinity);
  EXPECT_EQ(solid.ray(Vec3(0, 0, -1), Vec3(1, 0, 0)).leave, kInfinity);
  EXPECT_TRUE(solid.ray(Vec3(0, 0, 1), Vec3(1, 0, 0)).empty());
}

}  // namespace
}  // namespace volcontact::half_space_test
