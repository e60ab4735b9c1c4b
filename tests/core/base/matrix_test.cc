// SPDX-License-Identifier: Apache-2.0
#include "volcontact/base/matrix.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "core/support/judged_by_eigen.h"

namespace volcontact::matrix_test {
namespace {

template <int R, int C>
void expect_arithmetic_of_matrices() {
  test::Random random(10 * R + C);
  for (int i = 0; i < test::kJudged; ++i) {
    const auto a = test::matrix_of_many_sizes<R, C>(random),
               b = test::matrix_of_many_sizes<R, C>(random);
    const auto c = test::matrix_of_many_sizes<C, R>(random);
    const auto v = test::vector_of_many_sizes<C>(random);
    const auto u = test::vector_of_many_sizes<R>(random);
    const auto x = test::eigen(a), y = test::eigen(b);
    const double s = random.uniform(-2.0, 2.0);
    test::expect_same(a + b, x + y);
    test::expect_same(a - b, x - y);
    test::expect_same(-a, -x);
    test::expect_same(s * a, s * x);
    test::expect_same(a * s, x * s);
    test::expect_same(a / s, x / s);
    test::expect_same(a.transpose(), x.transpose());
    test::expect_same(a.cwiseAbs(), x.cwiseAbs());
    test::expect_same(a.cwiseAbs2(), x.cwiseAbs2());
    test::expect_same(a.rounded(), x.array().round().matrix());
    for (int k = 0; k < C; ++k) test::expect_same(a.col(k), x.col(k));
    for (int k = 0; k < R; ++k) test::expect_same(a.row(k), x.row(k).transpose());
    test::expect_near(row_lengths(a), x.rowwise().norm(), C * x.norm());
    test::expect_near(a * v, x * test::eigen(v), C * x.norm() * v.norm());
    test::expect_near(a.transposed_times(u), x.transpose() * test::eigen(u),
                      R * x.norm() * u.norm());
    test::expect_near(a * c, x * test::eigen(c), C * x.norm() * c.norm());
    EXPECT_NEAR(a.norm(), x.norm(), R * C * test::kRounding * x.norm());
    EXPECT_NEAR(a.sum(), x.sum(), R * C * test::kRounding * x.cwiseAbs().sum());
    EXPECT_EQ(a.maxCoeff(), x.maxCoeff());
    if constexpr (R == C) {
      test::expect_same(a.diagonal(), x.diagonal());
      EXPECT_NEAR(a.trace(), x.trace(), R * test::kRounding * x.norm());
      test::expect_near(a * v.asDiagonal(), x * test::eigen(v).asDiagonal(), x.norm() * v.norm());
      test::expect_near(v.asDiagonal() * a, test::eigen(v).asDiagonal() * x, x.norm() * v.norm());
      test::expect_same(Matrix<R, R>(v.asDiagonal()), test::eigen(v).asDiagonal().toDenseMatrix());
    }
  }
}

TEST(Matrix, HasTheArithmeticOfEigen) {
  expect_arithmetic_of_matrices<2, 2>();
  expect_arithmetic_of_matrices<3, 3>();
  expect_arithmetic_of_matrices<3, 2>();
  expect_arithmetic_of_matrices<6, 6>();
}

TEST(Matrix, DeterminantsAndInversesAreThoseOfEigen) {
  test::Random random(5);
  for (int i = 0; i < test::kJudged; ++i) {
    const auto a = test::matrix_of_many_sizes<3, 3>(random);
    const auto b = test::matrix_of_many_sizes<2, 2>(random);
    const double size = a.col(0).norm() * a.col(1).norm() * a.col(2).norm();
    EXPECT_NEAR(a.determinant(), test::eigen(a).determinant(), 1e-15 * size);
    EXPECT_NEAR(b.determinant(), test::eigen(b).determinant(), 1e-15 * b.squaredNorm());
    const Mat3 inverse = a.inverse();
    // Relative to how far the matrix is from a singular one.
    const double condition = inverse.norm() * a.norm();
    EXPECT_LE((a * inverse - Mat3::Identity()).norm(), 1e-14 * condition);
  }
}

TEST(Matrix, NumbersByRowsAndByColumns) {
  const Mat3 m(1, 2, 3, 4, 5, 6, 7, 8, 9);
  EXPECT_EQ(m(0, 1), 2);
  EXPECT_EQ(m.row(0), Vec3(1, 2, 3));
  EXPECT_EQ(m.col(0), Vec3(1, 4, 7));
  double rows[9], columns[9];
  m.to_rows(rows);
  m.to(columns);
  EXPECT_EQ(rows[1], 2);
  EXPECT_EQ(columns[1], 4);
  EXPECT_EQ(Mat3::from_rows(rows), m);
  EXPECT_EQ(Mat3::from(columns), m);
  EXPECT_EQ(Mat3::with_rows(m.row(0), m.row(1), m.row(2)), m);
  EXPECT_EQ(Mat3::with_columns(m.col(0), m.col(1), m.col(2)), m);
  EXPECT_EQ(Mat3(test::eigen(m)), m);
  Mat3 other = Mat3::Zero();
  for (int i = 0; i < 3; ++i) other.set_row(i, m.row(i));
  EXPECT_EQ(other, m);
}

TEST(Matrix, Blocks) {
  const Mat3 m(1, 2, 3, 4, 5, 6, 7, 8, 9);
  EXPECT_EQ((m.block<2, 2>(1, 1)), Mat2(5, 6, 8, 9));
  EXPECT_EQ(m.leftCols<2>().col(1), m.col(1));
  Matrix<6, 6> wide = Matrix<6, 6>::Zero();
  wide.set_block(3, 0, m);
  wide.add_block(3, 0, m);
  EXPECT_EQ((wide.block<3, 3>(3, 0)), 2.0 * m);
  EXPECT_EQ(wide.sum(), 2.0 * m.sum());
}

}  // namespace
}  // namespace volcontact::matrix_test
