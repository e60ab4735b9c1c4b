// SPDX-License-Identifier: Apache-2.0
#include "volcontact/base/vector_operators.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <type_traits>

#include "core/support/random.h"

namespace volcontact::vector_operators_test {
namespace {

constexpr int kCases = 1000;

// Components of many sizes, so that the order of a sum shows in its last bits.
Vec3 vector(test::Random& random) {
  Vec3 v;
  for (int i = 0; i < 3; ++i) {
    v[i] = random.uniform(-1.0, 1.0) * std::pow(10.0, random.uniform(-3.0, 3.0));
  }
  return v;
}
Mat3 matrix(test::Random& random) {
  Mat3 m;
  for (int i = 0; i < 3; ++i) m.col(i) = vector(random);
  return m;
}

TEST(VectorOperators, AnExpressionIsAVector) {
  const Vec3 a(1, 2, 3), b(4, 5, 6);
  const Mat3 m = Mat3::Identity();
  static_assert(std::is_same_v<decltype(a + b), Vec3>);
  static_assert(std::is_same_v<decltype(2.0 * a - b / 3.0), Vec3>);
  static_assert(std::is_same_v<decltype(-(a * 2)), Vec3>);
  static_assert(std::is_same_v<decltype(m.col(0) + b), Vec3>);
}

// Eigen's own operators, named as members.
TEST(VectorOperators, SumsAndMultiplesHaveEigensBits) {
  test::Random random(1);
  for (int i = 0; i < kCases; ++i) {
    const Vec3 a = vector(random), b = vector(random);
    const double s = random.uniform(-2.0, 2.0);
    EXPECT_EQ(a + b, Vec3(a.operator+(b)));
    EXPECT_EQ(a - b, Vec3(a.operator-(b)));
    EXPECT_EQ(-a, Vec3(a.operator-()));
    EXPECT_EQ(a * s, Vec3(a.operator*(s)));
    EXPECT_EQ(s * a, Vec3(a.operator*(s)));
    EXPECT_EQ(a / s, Vec3(a.operator/(s)));
    EXPECT_EQ(a.cwiseAbs() - b, Vec3(a.cwiseAbs().operator-(b)));
  }
}

// What Eigen does with a product hangs on what stands around it.
TEST(VectorOperators, ProductsStayEigens) {
  test::Random random(2);
  for (int i = 0; i < kCases; ++i) {
    const Mat3 m = matrix(random), n = matrix(random);
    const Vec3 a = vector(random), b = vector(random);
    const double s = random.uniform(-2.0, 2.0);
    static_assert(!std::is_same_v<decltype(m * a), Vec3>);
    EXPECT_EQ(Vec3(s * (m * a)), Vec3((s * m) * a));
    EXPECT_EQ(Vec3(b + m * a), Vec3(b.operator+(m.operator*(a))));
    EXPECT_EQ(Vec3(m * (a - b)), Vec3(m.operator*(a.operator-(b))));
    // Not a column that can be loaded in pairs.
    const auto row = m.row(0).transpose() - a;
    static_assert(!std::is_same_v<std::decay_t<decltype(row)>, Vec3>);
    EXPECT_EQ((m.col(0) - a).norm(), m.col(0).operator-(a).norm());
    EXPECT_EQ((a - 2.0 * m.col(1)).dot(n.col(2)),
              a.operator-(m.col(1).operator*(2.0)).dot(n.col(2)));
  }
}

TEST(VectorOperators, SumsOfMatricesAreMatricesWithTheBitsOfEigen) {
  test::Random random(3);
  for (int i = 0; i < 50; ++i) {
    const Mat3 m = matrix(random), n = matrix(random);
    static_assert(std::is_same_v<decltype(m + n), Mat3> && std::is_same_v<decltype(m - n), Mat3>);
    EXPECT_EQ(m + n, Mat3(m.operator+(n)));
    EXPECT_EQ(m - n, Mat3(m.operator-(n)));
  }
}

TEST(VectorOperators, AVectorMayBeAssignedToItself) {
  const Mat3 quarter = Mat3(Eigen::AngleAxisd(0.5 * kPi, Vec3::UnitZ())).array().round();
  Vec3 v(1, 2, 3);
  v = quarter * v - v;
  EXPECT_EQ(v, Vec3(-3, -1, 0));
}

}  // namespace
}  // namespace volcontact::vector_operators_test
