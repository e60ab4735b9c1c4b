// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/cylinder.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/support/convex_solid_checks.h"

namespace volcontact::cylinder_test {
namespace {

constexpr double kRadius = 0.4, kHalfLength = 0.7;
const Cylinder kSolid({.radius = kRadius, .half_length = kHalfLength});
constexpr double kSpacing = 0.02;

std::vector<Vec3> surface() {
  std::vector<Vec3> points;
  constexpr int kTurns = 240, kSteps = 100, kRings = 40;
  for (int i = 0; i < kTurns; ++i) {
    const double a = 2.0 * kPi * i / kTurns;
    for (int j = 0; j <= kSteps; ++j) {
      points.emplace_back(kRadius * std::cos(a), kRadius * std::sin(a),
                          kHalfLength * (2.0 * j / kSteps - 1.0));
    }
    for (int j = 0; j < kRings; ++j) {
      for (double side : {-1.0, 1.0}) {
        const double r = kRadius * j / kRings;
        points.emplace_back(r * std::cos(a), r * std::sin(a), side * kHalfLength);
      }
    }
  }
  return points;
}

TEST(Cylinder, SupportIsTheHighestPoint) { test::check_support(kSolid, surface(), kSpacing); }
TEST(Cylinder, BoundsAreTight) { test::check_bounds(kSolid, surface(), kSpacing); }
TEST(Cylinder, DistanceIsToTheSurface) { test::check_distance(kSolid, surface(), kSpacing, 1.0); }
TEST(Cylinder, GradientIsTheDirectionOfGrowth) { test::check_gradient(kSolid, 1.0); }
TEST(Cylinder, RayEndsOnTheSurface) { test::check_ray(kSolid, 1.0); }
// The columns are parallel to the wall, which is where the grid's error comes from.
TEST(Cylinder, OwnMetricsAreTheIntegrals) { test::check_own_metrics(kSolid, 2e-4); }
TEST(Cylinder, PiecesAreTheSolid) { test::check_pieces(kSolid, 1.0); }

// V = 2 pi r^2 h; I_z = V r^2/2, I_x = V (r^2/4 + h^2/3).
TEST(Cylinder, OwnMetricsAreTheClosedForm) {
  const VolumeMetrics m = kSolid.own_metrics();
  const double volume = 2.0 * kPi * 0.16 * 0.7;
  EXPECT_NEAR(m.volume, volume, 1e-15);
  EXPECT_NEAR(m.inertia(2, 2), volume * 0.08, 1e-15);
  EXPECT_NEAR(m.inertia(0, 0), volume * (0.04 + 0.49 / 3.0), 1e-15);
}

TEST(Cylinder, SupportAlongTheAxisIsFinite) {
  EXPECT_EQ(kSolid.support(Vec3(0, 0, -2)).z(), -kHalfLength);
  EXPECT_EQ(kSolid.support_height(Vec3(0, 0, 2)), 2.0 * kHalfLength);
}

TEST(Cylinder, RayAlongTheAxisEndsAtTheCaps) {
  const RayInterval span = kSolid.ray(Vec3(0.1, 0.2, 5.0), Vec3(0, 0, -1));
  EXPECT_NEAR(span.enter, 5.0 - kHalfLength, 1e-15);
  EXPECT_NEAR(span.leave, 5.0 + kHalfLength, 1e-15);
  EXPECT_TRUE(kSolid.ray(Vec3(0.3, 0.3, 0.0), Vec3(0, 0, 1)).empty());
}

TEST(Cylinder, AxisHasAGradient) { EXPECT_EQ(kSolid.gradient(Vec3::Zero()).norm(), 1.0); }

TEST(Cylinder, ZeroSizesAreEmpty) {
  const Cylinder needle({.radius = 0.0, .half_length = 1.0});
  const Cylinder disc({.radius = 1.0, .half_length = 0.0});
  EXPECT_EQ(needle.own_metrics().volume, 0.0);
  EXPECT_EQ(disc.own_metrics().volume, 0.0);
  EXPECT_TRUE(needle.ray(Vec3(0, 0, -2), Vec3(0, 0, 1)).empty());
  EXPECT_TRUE(disc.ray(Vec3(0, 0, -2), Vec3(0, 0, 1)).empty());
}

TEST(Cylinder, RejectsNegativeSizes) {
  EXPECT_THROW(Cylinder({.radius = -1.0}), std::invalid_argument);
  EXPECT_THROW(Cylinder({.half_length = -1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace volcontact::cylinder_test
