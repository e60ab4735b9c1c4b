// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/sphere.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/support/convex_solid_checks.h"

namespace volcontact::sphere_test {
namespace {

constexpr double kRadius = 0.7;
const Sphere kSolid({.radius = kRadius});
constexpr double kSpacing = 0.02;  // of the surface points below, with room

std::vector<Vec3> surface() {
  std::vector<Vec3> points;
  for (int i = 0; i <= 120; ++i) {
    for (int j = 0; j < 240; ++j) {
      const double a = kPi * i / 120, b = 2.0 * kPi * j / 240;
      points.emplace_back(kRadius * std::sin(a) * std::cos(b), kRadius * std::sin(a) * std::sin(b),
                          kRadius * std::cos(a));
    }
  }
  return points;
}

TEST(Sphere, SupportIsTheHighestPoint) { test::check_support(kSolid, surface(), kSpacing); }
TEST(Sphere, BoundsAreTight) { test::check_bounds(kSolid, surface(), kSpacing); }
TEST(Sphere, DistanceIsToTheSurface) { test::check_distance(kSolid, surface(), kSpacing, 1.0); }
TEST(Sphere, GradientIsTheDirectionOfGrowth) { test::check_gradient(kSolid, 1.0); }
TEST(Sphere, RayEndsOnTheSurface) { test::check_ray(kSolid, 1.0); }
TEST(Sphere, OwnMetricsAreTheIntegrals) { test::check_own_metrics(kSolid, 1e-5); }
TEST(Sphere, PiecesAreTheSolid) { test::check_pieces(kSolid, 1.0); }

TEST(Sphere, CentreHasAGradient) { EXPECT_EQ(kSolid.gradient(Vec3::Zero()).norm(), 1.0); }

TEST(Sphere, FarRayKeepsItsDigits) {
  const RayInterval span = kSolid.ray(Vec3(1e6, 0, 0), Vec3(-1, 0, 0));
  EXPECT_NEAR(span.leave - span.enter, 2.0 * kRadius, 1e-9);
}

TEST(Sphere, ZeroRadiusIsEmpty) {
  const Sphere point({.radius = 0.0});
  EXPECT_EQ(point.own_metrics().volume, 0.0);
  EXPECT_TRUE(point.ray(Vec3(-1, 0, 0), Vec3(1, 0, 0)).empty());
}

TEST(Sphere, RejectsNegativeRadius) {
  EXPECT_THROW(Sphere({.radius = -1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace volcontact::sphere_test
