// SPDX-License-Identifier: Apache-2.0
#include "volcontact/base/matrix.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "core/support/judged_by_eigen.h"

namespace volcontact::matrix_test {
namespace {

// In the same order as those of Eigen, below.
template <int R, int C>
test::Findings found(const Matrix<R, C>& a, const Matrix<R, C>& b, const Matrix<C, R>& c,
                     const Vector<C>& v, const Vector<R>& u, double s) {
  test::Findings found;
  found.add(a + b);
  found.add(a - b);
  found.add(-a);
  found.add(s * a);
  found.add(a * s);
  found.add(a / s);
  found.add(a.transpose());
  found.add(a.cwiseAbs());
  found.add(a.cwiseAbs2());
  found.add(a.rounded());
  for (int k = 0; k < C; ++k) found.add(a.col(k));
  for (int k = 0; k < R; ++k) found.add(a.row(k));
  found.add(row_lengths(a));
  found.add(a * v);
  found.add(a.transposed_times(u));
  found.add(a * c);
  found.add(a.norm());
  found.add(a.sum());
  found.add(a.maxCoeff());
  if constexpr (R == C) {
    found.add(a.diagonal());
    found.add(a.trace());
    found.add(a * v.asDiagonal());
    found.add(v.asDiagonal() * a);
    found.add(Matrix<R, R>(v.asDiagonal()));
  }
  return found;
}

test::Findings found_by_eigen(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y,
                              const Eigen::MatrixXd& z, const Eigen::VectorXd& v,
                              const Eigen::VectorXd& u, double s) {
  const double rows = test::kRounding * static_cast<double>(x.rows());
  const double columns = test::kRounding * static_cast<double>(x.cols());
  test::Findings found;
  found.add(x + y);
  found.add(x - y);
  found.add(-x);
  found.add(s * x);
  found.add(x * s);
  found.add(x / s);
  found.add(x.transpose());
  found.add(x.cwiseAbs());
  found.add(x.cwiseAbs2());
  found.add(x.array().round().matrix());
  for (Eigen::Index k = 0; k < x.cols(); ++k) found.add(x.col(k));
  for (Eigen::Index k = 0; k < x.rows(); ++k) found.add(x.row(k).transpose());
  found.add(x.rowwise().norm(), columns * x.norm());
  found.add(test::product(x, v), columns * x.norm() * v.norm());
  found.add(test::product(x.transpose(), u), rows * x.norm() * u.norm());
  found.add(test::product(x, z), columns * x.norm() * z.norm());
  found.add(x.norm(), rows * static_cast<double>(x.cols()) * x.norm());
  found.add(x.sum(), rows * static_cast<double>(x.cols()) * x.cwiseAbs().sum());
  found.add(x.maxCoeff());
  if (x.rows() == x.cols()) {
    const double size = test::kRounding * x.norm() * v.norm();
    found.add(x.diagonal());
    found.add(x.trace(), rows * x.norm());
    found.add(x * v.asDiagonal(), size);
    found.add(v.asDiagonal() * x, size);
    found.add(v.asDiagonal().toDenseMatrix());
  }
  return found;
}

template <int R, int C>
void expect_arithmetic_of_matrices() {
  test::Random random(10 * R + C);
  for (int i = 0; i < test::kJudged; ++i) {
    const auto a = test::matrix_of_many_sizes<R, C>(random),
               b = test::matrix_of_many_sizes<R, C>(random);
    const auto c = test::matrix_of_many_sizes<C, R>(random);
    const auto v = test::vector_of_many_sizes<C>(random);
    const auto u = test::vector_of_many_sizes<R>(random);
    const double s = random.uniform(-2.0, 2.0);
    const auto theirs = found_by_eigen(test::eigen(a), test::eigen(b), test::eigen(c),
                                       test::eigen(v), test::eigen(u), s);
    theirs.expect(found(a, b, c, v, u, s));
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
