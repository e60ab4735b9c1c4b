// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/signed_distance.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "volcontact/shape/shapes.h"

namespace volcontact::signed_distance_test {
namespace {

// As a user would write it.
struct Ball {
  double radius;
  Aabb bounds() const { return {Vec3::Constant(-radius), Vec3::Constant(radius)}; }
  double signed_distance(const Vec3& p) const { return p.norm() - radius; }
};

TEST(SignedDistance, AnswersWhatTheUsersSolidAnswers) {
  const SignedDistance solid(Ball{0.2});
  EXPECT_EQ(solid.bounds().max, Vec3::Constant(0.2));
  EXPECT_EQ(solid.signed_distance(Vec3(0.3, 0.4, 0.0)), 0.3);
  EXPECT_NEAR((solid.gradient(Vec3(0.0, 0.3, 0.4)) - Vec3(0.0, 0.6, 0.8)).norm(), 0.0, 1e-8);
  EXPECT_EQ(name_of(Shape(solid)), std::string("signed_distance"));
}

TEST(SignedDistance, SupportIsThatOfTheBounds) {
  const SignedDistance solid(Ball{0.2});
  EXPECT_DOUBLE_EQ(solid.support_height(Vec3(0.0, -1.0, 0.0)), 0.2);
  EXPECT_DOUBLE_EQ(solid.support_height(Vec3(1.0, 1.0, 0.0)), 0.4);
}

// A function twice as steep as a distance promises half as much.
TEST(SignedDistance, NeverSaysMoreThanTheDistanceFromTheSurface) {
  struct Steep : Ball {
    double signed_distance(const Vec3& p) const { return 2.0 * Ball::signed_distance(p); }
  };
  const SignedDistance solid(Steep{{0.2}}, {.lipschitz = 2.0, .curvature = 15.0});
  const Vec3 points[] = {{0.5, 0.0, 0.0}, {0.0, 0.0, 0.1}};
  double f[2];
  solid.signed_distances(points, 2, f);
  EXPECT_DOUBLE_EQ(f[0], 0.3);
  EXPECT_DOUBLE_EQ(f[1], -0.1);
  EXPECT_DOUBLE_EQ(solid.bend_bound(), 7.5);
}

TEST(SignedDistance, RefusesWhatCannotBe) {
  EXPECT_THROW(SignedDistance(Ball{0.2}, {.lipschitz = 0.0}), std::invalid_argument);
  EXPECT_THROW(SignedDistance(Ball{0.2}, {.lipschitz = kInfinity}), std::invalid_argument);
  EXPECT_THROW(SignedDistance(Ball{0.2}, {.curvature = -1.0}), std::invalid_argument);
  EXPECT_THROW(SignedDistance(Ball{-0.2}), std::invalid_argument);
  EXPECT_THROW(SignedDistance(Ball{kInfinity}), std::invalid_argument);
}

TEST(SignedDistance, CannotBeComposed) {
  EXPECT_THROW(composed(SignedDistance(Ball{0.2})), std::invalid_argument);
}

}  // namespace
}  // namespace volcontact::signed_distance_test
