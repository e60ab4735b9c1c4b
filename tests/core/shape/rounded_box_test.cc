// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/rounded_box.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/support/convex_solid_checks.h"
#include "volcontact/shape/box.h"

namespace volcontact::rounded_box_test {
namespace {

const Vec3 kHalf(0.5, 0.3, 0.4);
constexpr double kRadius = 0.12;
const RoundedBox kSolid({.half_sizes = kHalf, .radius = kRadius});
constexpr double kSpacing = 0.02;

// Each place of the box of the centres, moved out along the normals that it has there.
std::vector<Vec3> surface() {
  std::vector<Vec3> points;
  const Vec3 inner = kHalf - Vec3::Constant(kRadius);
  constexpr int kSteps = 40, kTurns = 24;
  for (int axis = 0; axis < 3; ++axis) {
    const int j = (axis + 1) % 3, k = (axis + 2) % 3;
    for (int s = 0; s <= kSteps; ++s) {
      for (int t = 0; t <= kSteps; ++t) {
        for (const double side : {1.0, -1.0}) {
          Vec3 face;
          face[axis] = side * kHalf[axis];
          face[j] = inner[j] * (2.0 * s / kSteps - 1.0);
          face[k] = inner[k] * (2.0 * t / kSteps - 1.0);
          points.push_back(face);
        }
      }
      for (int t = 0; t < 4 * kTurns; ++t) {
        const double a = 0.5 * kPi * t / kTurns, c = std::cos(a), b = std::sin(a);
        Vec3 edge;
        edge[axis] = inner[axis] * (2.0 * s / kSteps - 1.0);
        edge[j] = std::copysign(inner[j], c) + kRadius * c;
        edge[k] = std::copysign(inner[k], b) + kRadius * b;
        points.push_back(edge);
      }
    }
  }
  test::Random random(5);
  for (int i = 0; i < 40000; ++i) {
    const Vec3 e = random.direction();
    points.push_back(kSolid.support(e));
  }
  return points;
}

TEST(RoundedBox, SupportIsTheHighestPoint) { test::check_support(kSolid, surface(), kSpacing); }
TEST(RoundedBox, BoundsAreTight) { test::check_bounds(kSolid, surface(), kSpacing); }
TEST(RoundedBox, DistanceIsToTheSurface) { test::check_distance(kSolid, surface(), kSpacing, 1.0); }
TEST(RoundedBox, GradientIsTheDirectionOfGrowth) { test::check_gradient(kSolid, 1.0); }
TEST(RoundedBox, RayEndsOnTheSurface) { test::check_ray(kSolid, 1.0); }
TEST(RoundedBox, OwnMetricsAreTheIntegrals) { test::check_own_metrics(kSolid, 2e-4); }
TEST(RoundedBox, PiecesAreTheSolid) { test::check_pieces(kSolid, 1.0); }

// Steiner's formula: V of the box of the centres, its area, its mean width and the ball.
TEST(RoundedBox, VolumeIsSteiners) {
  const Vec3 a = kHalf - Vec3::Constant(kRadius);
  const double area = 8.0 * (a.x() * a.y() + a.y() * a.z() + a.z() * a.x());
  const double expected = 8.0 * a.prod() + area * kRadius +
                          2.0 * kPi * a.sum() * kRadius * kRadius +
                          4.0 / 3.0 * kPi * kRadius * kRadius * kRadius;
  EXPECT_NEAR(kSolid.own_metrics().volume, expected, 1e-15);
}

// A cube that is all radius is a ball, and a radius of nothing a box.
TEST(RoundedBox, EndsInABallAndInABox) {
  const RoundedBox ball({.half_sizes = Vec3::Constant(0.2), .radius = 0.2});
  const VolumeMetrics m = ball.own_metrics();
  EXPECT_NEAR(m.volume, 4.0 / 3.0 * kPi * 0.008, 1e-15);
  EXPECT_NEAR(m.inertia(0, 0), 0.4 * m.volume * 0.04, 1e-15);
  const VolumeMetrics sharp = RoundedBox({.half_sizes = kHalf, .radius = 1e-9}).own_metrics();
  const VolumeMetrics box = Box({.half_sizes = kHalf}).own_metrics();
  EXPECT_NEAR(sharp.volume, box.volume, 1e-15);
  EXPECT_TRUE(sharp.inertia.isApprox(box.inertia, 1e-12));
}

TEST(RoundedBox, ARadiusAboveHalfOfItIsRefused) {
  try {
    RoundedBox({.half_sizes = kHalf, .radius = 0.31});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(
        error.what(),
        "rounded_box: radius = 0.31 [m] is out of range: must be no more than the smallest "
        "of half_sizes");
  }
  EXPECT_THROW(RoundedBox({.half_sizes = kHalf, .radius = 0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace volcontact::rounded_box_test
