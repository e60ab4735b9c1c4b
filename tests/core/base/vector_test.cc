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

// In the same order as those of Eigen, below.
template <int N>
test::Findings found(const Vector<N>& a, const Vector<N>& b, double s) {
  test::Findings found;
  found.add(a + b);
  found.add(a - b);
  found.add(-a);
  found.add(s * a);
  found.add(a * s);
  found.add(a / s);
  auto c = a;
  c += b;
  c *= s;
  c -= a;
  c /= s;
  found.add(c);
  found.add(a.cwiseProduct(b));
  found.add(a.cwiseQuotient(b));
  found.add(a.cwiseMax(b));
  found.add(a.cwiseMin(b));
  found.add(a.cwiseMax(0.1));
  found.add(a.cwiseMin(0.1));
  found.add(a.cwiseAbs());
  found.add(a.cwiseAbs2());
  found.add(a.cwiseInverse());
  found.add(a.cwiseAbs().cwiseSqrt());
  found.add(a.rounded());
  found.add(a.dot(b));
  found.add(a.squaredNorm());
  found.add(a.norm());
  found.add(a.normalized());
  found.add(a.stableNormalized());
  found.add(a.stableNorm());
  found.add(a.sum());
  found.add(a.prod());
  found.add(a.maxCoeff());
  found.add(a.minCoeff());
  found.add(a[a.largest()]);
  found.add(a[a.least()]);
  found.add(a.at_most(b));
  found.add(a.less_than(b));
  found.add(a.exceeds(b));
  found.add(a == b);
  found.add(outer(a, b));
  EXPECT_TRUE(a == a && a.at_most(a) && !a.less_than(a) && !a.exceeds(a));
  return found;
}

test::Findings found_by_eigen(const Eigen::VectorXd& x, const Eigen::VectorXd& y, double s) {
  const double rounding = static_cast<double>(x.size()) * test::kRounding;
  test::Findings found;
  found.add(x + y);
  found.add(x - y);
  found.add(-x);
  found.add(s * x);
  found.add(x * s);
  found.add(x / s);
  found.add(((x + y) * s - x) / s);
  found.add(x.cwiseProduct(y));
  found.add(x.cwiseQuotient(y));
  found.add(x.cwiseMax(y));
  found.add(x.cwiseMin(y));
  found.add(x.cwiseMax(0.1));
  found.add(x.cwiseMin(0.1));
  found.add(x.cwiseAbs());
  found.add(x.cwiseAbs2());
  found.add(x.cwiseInverse());
  found.add(x.cwiseAbs().cwiseSqrt());
  found.add(x.array().round().matrix());
  found.add(x.dot(y), rounding * x.cwiseAbs().dot(y.cwiseAbs()));
  found.add(x.squaredNorm(), rounding * x.squaredNorm());
  found.add(x.norm(), rounding * x.norm());
  found.add(x.normalized(), rounding);
  found.add(x.normalized(), rounding);
  found.add(x.norm(), rounding * x.norm());
  found.add(x.sum(), rounding * x.cwiseAbs().sum());
  found.add(x.prod(), rounding * std::abs(x.prod()));
  found.add(x.maxCoeff());
  found.add(x.minCoeff());
  found.add(x.maxCoeff());
  found.add(x.minCoeff());
  found.add((x.array() <= y.array()).all());
  found.add((x.array() < y.array()).all());
  found.add((x.array() > y.array()).any());
  found.add(x == y);
  found.add(test::product(x, y.transpose()), test::kRounding * x.norm() * y.norm());
  return found;
}

template <int N>
void expect_arithmetic_of_vectors() {
  test::Random random(N);
  for (int i = 0; i < test::kJudged; ++i) {
    const auto a = test::vector_of_many_sizes<N>(random), b = test::vector_of_many_sizes<N>(random);
    const double s = random.uniform(-2.0, 2.0);
    found_by_eigen(test::eigen(a), test::eigen(b), s).expect(found(a, b, s));
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
    EXPECT_EQ(test::eigen(a.cross(b)), test::eigen(a).cross(test::eigen(b)));
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
