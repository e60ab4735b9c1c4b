// SPDX-License-Identifier: Apache-2.0
#include "volcontact/base/vector.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <sstream>
#include <type_traits>

#include "core/support/judged_by_eigen.h"

namespace volcontact::vector_test {
namespace {

template <int N>
void expect_arithmetic_of_vectors() {
  test::Random random(N);
  for (int i = 0; i < test::kJudged; ++i) {
    const auto a = test::vector_of_many_sizes<N>(random), b = test::vector_of_many_sizes<N>(random);
    const auto x = test::eigen(a), y = test::eigen(b);
    const double s = random.uniform(-2.0, 2.0);
    test::expect_same(a + b, x + y);
    test::expect_same(a - b, x - y);
    test::expect_same(-a, -x);
    test::expect_same(s * a, s * x);
    test::expect_same(a * s, x * s);
    test::expect_same(a / s, x / s);
    auto c = a;
    c += b;
    c *= s;
    c -= a;
    c /= s;
    test::expect_same(c, ((x + y) * s - x) / s);
    test::expect_same(a.cwiseProduct(b), x.cwiseProduct(y));
    test::expect_same(a.cwiseQuotient(b), x.cwiseQuotient(y));
    test::expect_same(a.cwiseMax(b), x.cwiseMax(y));
    test::expect_same(a.cwiseMin(b), x.cwiseMin(y));
    test::expect_same(a.cwiseMax(0.1), x.cwiseMax(0.1));
    test::expect_same(a.cwiseMin(0.1), x.cwiseMin(0.1));
    test::expect_same(a.cwiseAbs(), x.cwiseAbs());
    test::expect_same(a.cwiseAbs2(), x.cwiseAbs2());
    test::expect_same(a.cwiseInverse(), x.cwiseInverse());
    test::expect_same(a.cwiseAbs().cwiseSqrt(), x.cwiseAbs().cwiseSqrt());
    test::expect_same(a.rounded(), x.array().round().matrix());
    const double terms = x.cwiseAbs().dot(y.cwiseAbs());
    EXPECT_NEAR(a.dot(b), x.dot(y), N * test::kRounding * terms);
    EXPECT_NEAR(a.squaredNorm(), x.squaredNorm(), N * test::kRounding * x.squaredNorm());
    EXPECT_NEAR(a.norm(), x.norm(), N * test::kRounding * x.norm());
    test::expect_near(a.normalized(), x.normalized(), N);
    test::expect_near(a.stableNormalized(), x.normalized(), N);
    EXPECT_NEAR(a.stableNorm(), x.norm(), N * test::kRounding * x.norm());
    EXPECT_NEAR(a.sum(), x.sum(), N * test::kRounding * x.cwiseAbs().sum());
    EXPECT_NEAR(a.prod(), x.prod(), N * test::kRounding * std::abs(x.prod()));
    EXPECT_EQ(a.maxCoeff(), x.maxCoeff());
    EXPECT_EQ(a.minCoeff(), x.minCoeff());
    EXPECT_EQ(a[a.largest()], x.maxCoeff());
    EXPECT_EQ(a[a.least()], x.minCoeff());
    EXPECT_EQ(a.at_most(b), (x.array() <= y.array()).all());
    EXPECT_EQ(a.less_than(b), (x.array() < y.array()).all());
    EXPECT_EQ(a.exceeds(b), (x.array() > y.array()).any());
    EXPECT_TRUE(a == a && a.at_most(a) && !a.less_than(a) && !a.exceeds(a));
    EXPECT_EQ(a == b, x == y);
    test::expect_near(outer(a, b), x * y.transpose(), x.norm() * y.norm());
  }
}

TEST(Vector, HasTheArithmeticOfEigen) {
  expect_arithmetic_of_vectors<2>();
  expect_arithmetic_of_vectors<3>();
  expect_arithmetic_of_vectors<6>();
}

TEST(Vector, CrossProductsAreThoseOfEigen) {
  test::Random random(6);
  for (int i = 0; i < test::kJudged; ++i) {
    const Vec3 a = test::vector_of_many_sizes<3>(random), b = test::vector_of_many_sizes<3>(random);
    const Eigen::Vector3d x = test::eigen(a), y = test::eigen(b);
    test::expect_same(a.cross(b), x.cross(y));
  }
}

TEST(Vector, OfLengthZeroStaysAsItIs) {
  EXPECT_EQ(Vec3::Zero().normalized(), Vec3::Zero());
  EXPECT_EQ(Vec3::Zero().stableNorm(), 0.0);
  // Squares of these are 0, and infinite.
  EXPECT_EQ((1e-200 * Vec3::UnitX()).stableNormalized(), Vec3::UnitX());
  EXPECT_EQ((1e200 * Vec3::UnitY()).stableNorm(), 1e200);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(Vec3(1.0, -kInfinity, 0.0).stableNorm(), kInfinity);
}

TEST(Vector, KnowsWhatIsNotFinite) {
  EXPECT_TRUE(Vec3(1, 2, 3).allFinite());
  EXPECT_FALSE(Vec3(1, std::numeric_limits<double>::quiet_NaN(), 3).allFinite());
  EXPECT_FALSE(Vec3(1, 2, std::numeric_limits<double>::infinity()).allFinite());
  EXPECT_FALSE(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()).isZero());
  EXPECT_TRUE(Vec3::Constant(1e-13).isZero());
  EXPECT_FALSE(Vec3::Constant(1e-13).isZero(0.0));
}

TEST(Vector, FirstOfEqualComponentsCounts) {
  EXPECT_EQ(Vec3(1, 3, 3).largest(), 1);
  EXPECT_EQ(Vec3(2, 1, 1).least(), 1);
}

TEST(Vector, PartsAndNumbers) {
  const Vector<6> v({1, 2, 3, 4, 5, 6});
  EXPECT_EQ(v.head<3>(), Vec3(1, 2, 3));
  EXPECT_EQ(v.tail<3>(), Vec3(4, 5, 6));
  double numbers[6] = {};
  v.to(numbers);
  EXPECT_EQ(Vector<6>::from(numbers), v);
  EXPECT_EQ(Vec3(Eigen::Vector3d(1, 2, 3)), Vec3(1, 2, 3));
  std::ostringstream text;
  text << Vec3(1, 2.5, -3);
  EXPECT_EQ(text.str(), "1 2.5 -3");
}

TEST(Vector, MayBeAssignedToItself) {
  const Mat3 quarter = rotation_about(Vec3::UnitZ(), 0.5 * kPi).rounded();
  Vec3 v(1, 2, 3);
  v = quarter * v - v;
  EXPECT_EQ(v, Vec3(-3, -1, 0));
}

template <typename T>
concept AddsToACopy = requires(T x) { T(x) += x; };
template <typename T>
concept WritesToARow = requires(T m) { m.row(0)[0] = 1.0; };

// A part is a copy: to change it alone would change nothing.
TEST(Vector, WhatAFunctionGivesBackCannotBeAssignedTo) {
  static_assert(std::is_assignable_v<Vec3&, Vec3>);
  static_assert(!std::is_assignable_v<Vec3, Vec3>);
  static_assert(!std::is_assignable_v<Mat3, Mat3>);
  static_assert(!AddsToACopy<Vec3> && !AddsToACopy<Mat3> && !WritesToARow<Mat3>);
  static_assert(std::is_trivially_copyable_v<Vec3> && std::is_trivially_copyable_v<Mat3>);
  static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Mat3) == 9 * sizeof(double));
}

}  // namespace
}  // namespace volcontact::vector_test
