// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/box.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/support/convex_solid_checks.h"

namespace volcontact::box_test {
namespace {

const Vec3 kHalf(0.5, 0.3, 0.8);
const Box kSolid({.half_sizes = kHalf});
constexpr double kSpacing = 0.03;

std::vector<Vec3> surface() {
  std::vector<Vec3> points;
  constexpr int kSteps = 60;
  for (int axis = 0; axis < 3; ++axis) {
    for (double side : {-1.0, 1.0}) {
      for (int i = 0; i <= kSteps; ++i) {
        for (int j = 0; j <= kSteps; ++j) {
          Vec3 p;
          p[axis] = side;
          p[(axis + 1) % 3] = 2.0 * i / kSteps - 1.0;
          p[(axis + 2) % 3] = 2.0 * j / kSteps - 1.0;
          points.push_back(p.cwiseProduct(kHalf));
        }
      }
    }
  }
  return points;
}

TEST(Box, SupportIsTheHighestPoint) { test::check_support(kSolid, surface(), kSpacing); }
TEST(Box, BoundsAreTight) { test::check_bounds(kSolid, surface(), kSpacing); }
TEST(Box, DistanceIsToTheSurface) { test::check_distance(kSolid, surface(), kSpacing, 1.0); }
TEST(Box, GradientIsTheDirectionOfGrowth) { test::check_gradient(kSolid, 1.0); }
TEST(Box, RayEndsOnTheSurface) { test::check_ray(kSolid, 1.0); }
TEST(Box, OwnMetricsAreTheIntegrals) { test::check_own_metrics(kSolid, 1e-5); }
TEST(Box, PiecesAreTheSolid) { test::check_pieces(kSolid, 1.0); }

TEST(Box, RayAlongAFaceIsInsideOrOutside) {
  EXPECT_FALSE(kSolid.ray(Vec3(0, 0.29, 0), Vec3(1, 0, 0)).empty());
  EXPECT_TRUE(kSolid.ray(Vec3(0, 0.31, 0), Vec3(1, 0, 0)).empty());
}

TEST(Box, FlatBoxIsEmpty) {
  const Box flat({.half_sizes = {1.0, 1.0, 0.0}});
  EXPECT_EQ(flat.own_metrics().volume, 0.0);
  EXPECT_TRUE(flat.ray(Vec3(0, 0, -1), Vec3(0, 0, 1)).empty());
}

TEST(Box, RejectsNegativeHalfSize) {
  EXPECT_THROW(Box({.half_sizes = {1.0, -1.0, 1.0}}), std::invalid_argument);
}

}  // namespace
}  // namespace volcontact::box_test
