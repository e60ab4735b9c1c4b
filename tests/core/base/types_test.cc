// SPDX-License-Identifier: Apache-2.0
#include "volcontact/base/types.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/support/random.h"

namespace volcontact::types_test {
namespace {

constexpr double kRounding = 1e-14;  // of a few products of numbers of size 1

TEST(Pose, InnerLettersMeet) {
  test::Random random(1);
  const Pose X_AB = random.pose(1.0), X_BC = random.pose(1.0);
  const Vec3 p_C = random.in_box(1.0);
  // (X_AB X_BC) p = X_AB (X_BC p): the definition of the product.
  EXPECT_LT(((X_AB * X_BC) * p_C - X_AB * (X_BC * p_C)).norm(), kRounding);
}

TEST(Pose, InverseUndoes) {
  test::Random random(2);
  const Pose X = random.pose(1.0);
  const Vec3 p = random.in_box(1.0);
  EXPECT_LT((X.inverse() * (X * p) - p).norm(), kRounding);
}

TEST(Pose, FindsWhatIsNotFinite) {
  Pose X;
  EXPECT_TRUE(X.is_finite());
  X.translation.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(X.is_finite());
  X = Pose{};
  X.rotation(2, 1) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(X.is_finite());
}

TEST(Twist, TurnsPointsAboutTheOrigin) {
  const Twist twist{.angular = Vec3(0, 0, 2), .linear = Vec3(1, 0, 0)};
  // Turning at 2 rad/s about z moves the point (1, 0, 0) at 2 m/s along y.
  EXPECT_EQ(twist.at(Vec3(1, 0, 0)), Vec3(1, 2, 0));
}

TEST(Wrench, KeepsItsPowerWhenItsPointMoves) {
  test::Random random(3);
  const Wrench load{.torque = random.in_box(1.0), .force = random.in_box(1.0)};
  const Twist twist{.angular = random.in_box(1.0), .linear = random.in_box(1.0)};
  const Vec3 p = random.in_box(1.0);
  const Wrench about_p = load.about(p);
  const double power = load.torque.dot(twist.angular) + load.force.dot(twist.linear);
  EXPECT_NEAR(about_p.torque.dot(twist.angular) + about_p.force.dot(twist.at(p)), power, kRounding);
}

TEST(Skew, IsTheCrossProduct) {
  const Vec3 a(1, -2, 3), b(0.5, 4, -1);
  EXPECT_EQ(skew(a) * b, a.cross(b));
}

TEST(Outer, IsTheColumnTimesTheRow) {
  const Vec3 a(1, -2, 3), b(0.5, 4, -1);
  EXPECT_EQ(outer(a, b), Mat3(0.5, 4, -1, -1, -8, 2, 1.5, 12, -3));
}

TEST(RotationAbout, TurnsAboutItsAxis) {
  test::Random random(5);
  for (int i = 0; i < 200; ++i) {
    const Vec3 axis = random.direction();
    const double angle = random.uniform(-4.0, 4.0), half = 0.5 * angle;
    const Mat3 r = rotation_about(axis, angle);
    EXPECT_LT((r * axis - axis).norm(), kRounding);
    EXPECT_LT((r.transpose() * r - Mat3::Identity()).norm(), kRounding);
    const Vec3 across = basis_with_z(axis).col(0);
    EXPECT_NEAR(across.dot(r * across), std::cos(angle), kRounding);
    EXPECT_NEAR(axis.dot(across.cross(r * across)), std::sin(angle), kRounding);
    // The same as a quaternion.
    const Vec3 v = std::sin(half) * axis;
    EXPECT_LT((rotation_of(std::cos(half), v.x(), v.y(), v.z()) - r).norm(), kRounding);
  }
}

TEST(BasisWithZ, IsOrthonormalAndRightHandedForEveryDirection) {
  test::Random random(4);
  for (int i = 0; i < 200; ++i) {
    Vec3 n = random.direction();
    if (i == 0) n = Vec3::UnitZ();
    if (i == 1) n = -Vec3::UnitZ();
    if (i == 2) n = Vec3(1.0, 0.0, -0.0);
    const Mat3 r = basis_with_z(n);
    EXPECT_LT((r.transpose() * r - Mat3::Identity()).norm(), kRounding);
    EXPECT_NEAR(r.determinant(), 1.0, kRounding);
    EXPECT_EQ(r.col(2), n);
  }
}

}  // namespace
}  // namespace volcontact::types_test
