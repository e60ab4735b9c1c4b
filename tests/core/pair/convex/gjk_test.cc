// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/convex/gjk.h"

#include <gtest/gtest.h>

#include "core/support/random_shapes.h"
#include "volcontact/shape/shapes.h"

namespace volcontact::gjk_test {
namespace {

// Signed distance of a point to a posed shape, negative inside.
double distance(const Shape& shape, const Pose& X, const Vec3& p) {
  return std::visit([&](const auto& solid) { return solid.signed_distance(X.inverse() * p); },
                    shape);
}

bool common_point(const Shape& a, const Shape& b, const Pose& X_AB, Vec3& p) {
  return std::visit(
      [&](const auto& solid_a, const auto& solid_b) {
        if constexpr (HasFaces<std::decay_t<decltype(solid_a)>> &&
                      HasFaces<std::decay_t<decltype(solid_b)>>) {
          return find_common_point(ConvexView(solid_a), ConvexView(solid_b), X_AB, p);
        }
        return false;
      },
      a, b);
}

TEST(FindCommonPoint, BallsMeetExactlyWhenTheirCentersAreNearEnough) {
  test::Random random(31);
  const Shape a = Sphere({.radius = 0.3}), b = Sphere({.radius = 0.2});
  for (int i = 0; i < 300; ++i) {
    const Pose X{random.rotation(), random.uniform(0.0, 1.0) * random.direction()};
    const double gap = X.translation.norm() - 0.5;
    Vec3 p;
    ASSERT_EQ(common_point(a, b, X, p), gap < 0.0) << "gap " << gap;
    if (gap >= 0.0) continue;
    EXPECT_LE(distance(a, Pose{}, p), 1e-12);
    EXPECT_LE(distance(b, X, p), 1e-12);
  }
}

TEST(FindCommonPoint, AnAnswerIsAlwaysAPointOfBoth) {
  test::Random random(32);
  const std::vector<Shape> solids = {
      Box({.half_sizes = {0.3, 0.2, 0.1}}),
      Cylinder({.radius = 0.2, .half_length = 0.15}),
      Capsule({.radius = 0.1, .half_length = 0.2}),
      Ellipsoid({.semi_axes = {0.3, 0.2, 0.1}}),
      Frustum({.bottom_radius = 0.3, .top_radius = 0.1, .half_length = 0.2}),
      test::random_polytope(12, random)};
  int met = 0;
  for (const Shape& a : solids) {
    for (const Shape& b : solids) {
      for (int i = 0; i < 40; ++i) {
        const Pose X = random.pose(0.5);
        Vec3 p;
        if (!common_point(a, b, X, p)) continue;
        ++met;
        EXPECT_LE(distance(a, Pose{}, p), 1e-12) << name_of(a);
        EXPECT_LE(distance(b, X, p), 1e-12) << name_of(b);
      }
    }
  }
  EXPECT_GT(met, 300);
}

TEST(NearestInHull, KnowsCornersEdgesAndFaces) {
  const Vec3 a(1, 0, 0), b(0, 1, 0), c(0, 0, 1);
  EXPECT_TRUE(nearest_in_hull({a}).isApprox(a));
  EXPECT_TRUE(nearest_in_hull({a, b}).isApprox(Vec3(0.5, 0.5, 0)));
  EXPECT_TRUE(nearest_in_hull({a, b, c}).isApprox(Vec3::Constant(1.0 / 3.0)));
  EXPECT_TRUE(nearest_in_hull({Vec3(1, -1, 0), Vec3(1, 1, 0), Vec3(3, 0, 0)}).isApprox(a));
  EXPECT_LE(nearest_in_hull({a, b, c, Vec3(-1, -1, -1)}).norm(), 1e-12);
}

TEST(BallGap, ABallIsPartedExactlyWhereItIsFartherThanItsRadius) {
  test::Random random(34);
  const Sphere ball({.radius = 0.3});
  const Box box({.half_sizes = {0.3, 0.2, 0.1}});
  for (int i = 0; i < 500; ++i) {
    const bool round = i % 2 == 0;
    const Pose X = random.pose(0.1);
    const Vec3 center = random.in_box(0.8);
    const Vec3 in_solid = X.inverse() * center;
    const Vec3 nearest = in_solid.cwiseMax(-box.half_sizes()).cwiseMin(box.half_sizes());
    const double distance = round ? in_solid.norm() - 0.3 : (in_solid - nearest).norm();
    const double radius = random.uniform(0.0, 0.6);
    if (std::abs(distance - radius) < 1e-9) continue;
    const ConvexView solid = round ? ConvexView(ball) : ConvexView(box);
    const BallGap gap = ball_gap(solid, X, center, radius);
    ASSERT_EQ(gap.apart, distance > radius) << "distance " << distance << " radius " << radius;
    if (gap.apart) {
      EXPECT_NEAR(gap.offset, solid.support_height(X, gap.normal), 1e-12);
      EXPECT_GT(gap.normal.dot(center), gap.offset + radius);
    } else {
      EXPECT_LE((gap.place - center).norm(), radius);
      EXPECT_LE(round ? ball.signed_distance(X.inverse() * gap.place)
                      : box.signed_distance(X.inverse() * gap.place),
                1e-12);
    }
  }
}

}  // namespace
}  // namespace volcontact::gjk_test
