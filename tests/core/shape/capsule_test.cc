// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/capsule.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/support/convex_solid_checks.h"

namespace volcontact::capsule_test {
namespace {

constexpr double kRadius = 0.3, kHalfLength = 0.5;
const Capsule kSolid({.radius = kRadius, .half_length = kHalfLength});
constexpr double kSpacing = 0.02;

std::vector<Vec3> surface() {
  std::vector<Vec3> points;
  constexpr int kTurns = 160, kSteps = 80, kRings = 40;
  for (int i = 0; i < kTurns; ++i) {
    const double a = 2.0 * kPi * i / kTurns;
    const Vec3 out(std::cos(a), std::sin(a), 0.0);
    for (int j = 0; j <= kSteps; ++j) {
      points.push_back(kRadius * out + kHalfLength * (2.0 * j / kSteps - 1.0) * Vec3::UnitZ());
    }
    for (int j = 0; j <= kRings; ++j) {
      for (double side : {-1.0, 1.0}) {
        const double b = 0.5 * kPi * j / kRings;
        points.push_back(kRadius * std::cos(b) * out +
                         side * (kHalfLength + kRadius * std::sin(b)) * Vec3::UnitZ());
      }
    }
  }
  return points;
}

TEST(Capsule, SupportIsTheHighestPoint) { test::check_support(kSolid, surface(), kSpacing); }
TEST(Capsule, BoundsAreTight) { test::check_bounds(kSolid, surface(), kSpacing); }
TEST(Capsule, DistanceIsToTheSurface) { test::check_distance(kSolid, surface(), kSpacing, 1.0); }
TEST(Capsule, GradientIsTheDirectionOfGrowth) { test::check_gradient(kSolid, 1.0); }
TEST(Capsule, RayEndsOnTheSurface) { test::check_ray(kSolid, 1.0); }
TEST(Capsule, OwnMetricsAreTheIntegrals) { test::check_own_metrics(kSolid, 2e-4); }
TEST(Capsule, PiecesAreTheSolid) { test::check_pieces(kSolid, 1.0); }

// Cylinder plus ball; the second moments of a half ball of radius r about its flat side are
// 2/15 pi r^5 in every direction, and its centroid lies 3r/8 off that side.
TEST(Capsule, OwnMetricsAreTheClosedForm) {
  const double r = kRadius, h = kHalfLength;
  const double rod = 2.0 * kPi * r * r * h, half_ball = 2.0 / 3.0 * kPi * r * r * r;
  const double own = 2.0 / 15.0 * kPi * r * r * r * r * r;
  const double xx = rod * r * r / 4.0 + 2.0 * own;
  const double zz =
      rod * h * h / 3.0 + 2.0 * (own + 2.0 * h * half_ball * 3.0 * r / 8.0 + half_ball * h * h);
  const VolumeMetrics m = kSolid.own_metrics();
  EXPECT_NEAR(m.volume, rod + 2.0 * half_ball, 1e-15);
  EXPECT_NEAR(m.inertia(0, 0), xx + zz, 1e-15);
  EXPECT_NEAR(m.inertia(2, 2), 2.0 * xx, 1e-15);
}

TEST(Capsule, RayThroughBothEndsIsOneInterval) {
  const RayInterval span = kSolid.ray(Vec3(0.05, 0.0, -3.0), Vec3(0, 0, 1));
  const double reach = kHalfLength + std::sqrt(kRadius * kRadius - 0.05 * 0.05);
  EXPECT_NEAR(span.enter, 3.0 - reach, 1e-14);
  EXPECT_NEAR(span.leave, 3.0 + reach, 1e-14);
}

TEST(Capsule, WithoutLengthItIsABall) {
  const Capsule ball({.radius = kRadius, .half_length = 0.0});
  EXPECT_NEAR(ball.own_metrics().volume, 4.0 / 3.0 * kPi * kRadius * kRadius * kRadius, 1e-15);
  const RayInterval span = ball.ray(Vec3(1, 0, 0), Vec3(1, 0, 0));
  EXPECT_NEAR(span.leave - span.enter, 2.0 * kRadius, 1e-14);
}

TEST(Capsule, ZeroRadiusIsEmpty) {
  const Capsule needle({.radius = 0.0, .half_length = 1.0});
  EXPECT_EQ(needle.own_metrics().volume, 0.0);
  EXPECT_TRUE(needle.ray(Vec3(0, 0, -2), Vec3(0, 0, 1)).empty());
}

TEST(Capsule, RejectsNegativeSizes) {
  EXPECT_THROW(Capsule({.radius = -1.0}), std::invalid_argument);
  EXPECT_THROW(Capsule({.half_length = -1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace volcontact::capsule_test
