// SPDX-License-Identifier: Apache-2.0
#include "volcontact/step/block_matrix.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "core/support/dense.h"
#include "core/support/random.h"

namespace volcontact::block_matrix_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd random_matrix(test::Random& random, Eigen::Index rows, Eigen::Index columns) {
  MatrixXd out(rows, columns);
  for (double& x : out.reshaped()) x = random.uniform(-1.0, 1.0);
  return out;
}

// The unit matrix and one that is semidefinite, of half the rank and up to 1e6 as large; with a
// part that is not symmetric where it is asked for.
MatrixXd stiff(test::Random& random, int n, bool is_symmetric) {
  const MatrixXd root = 1e3 * random_matrix(random, n, (n + 1) / 2);
  const MatrixXd turn = random_matrix(random, n, n);
  const MatrixXd dense = MatrixXd::Identity(n, n) + test::square(root);
  return is_symmetric ? dense : MatrixXd(dense + 10.0 * (turn - turn.transpose()));
}

template <int K>
BlockMatrix<K> in_blocks(const MatrixXd& dense, bool is_symmetric) {
  BlockMatrix<K> out;
  const int count = static_cast<int>(dense.rows()) / K;
  out.reset(count, is_symmetric);
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < (is_symmetric ? i + 1 : count); ++k) {
      out(i, k) = dense.block<K, K>(K * i, K * k);
    }
  }
  return out;
}

template <int K>
std::vector<Vector<K>> in_parts(const VectorXd& x) {
  std::vector<Vector<K>> out;
  for (Eigen::Index i = 0; i < x.size(); i += K) out.push_back(Vector<K>::from(x.data() + i));
  return out;
}

template <int K>
void expect_solves(int count, bool is_symmetric) {
  test::Random random(7);
  const int n = K * count;
  const MatrixXd dense = stiff(random, n, is_symmetric);
  BlockMatrix<K> matrix = in_blocks<K>(dense, is_symmetric);
  const VectorXd right = random_matrix(random, n, 1), truth = test::solution(dense, right);
  std::vector<Vector<K>> parts = in_parts<K>(right);
  matrix.factor();
  matrix.solve(parts.data());
  const VectorXd x = Eigen::Map<const VectorXd>(parts[0].data(), n);
  // As far from the right side as rounding of the largest entries takes it.
  EXPECT_LT((test::product(dense, x) - right).norm(), 1e-13 * dense.norm() * x.norm() + 1e-12);
  EXPECT_LT((x - truth).norm(), 1e-7 * x.norm());
}

TEST(BlockMatrix, SolvesAsTheWholeMatrix) {
  for (const bool is_symmetric : {true, false}) {
    for (const int count : {1, 2, 5, 13}) {
      expect_solves<3>(count, is_symmetric);
      expect_solves<6>(count, is_symmetric);
    }
  }
}

// With G U = A: Y' A^-1 X = (U'^-1 Y)' (G^-1 X).
TEST(BlockMatrix, HasHalvesThatMakeTheWhole) {
  test::Random random(5);
  for (const bool is_symmetric : {true, false}) {
    for (const int count : {1, 2, 5}) {
      const int n = 3 * count;
      const MatrixXd dense = stiff(random, n, is_symmetric);
      const MatrixXd x = random_matrix(random, n, 3), y = random_matrix(random, n, 3);
      BlockMatrix<3> matrix = in_blocks<3>(dense, is_symmetric);
      matrix.factor();
      const auto parts_of = [&](const MatrixXd& whole) {
        std::vector<Mat3> parts;
        for (int i = 0; i < count; ++i) parts.emplace_back(whole.block<3, 3>(3 * i, 0));
        return parts;
      };
      std::vector<Mat3> lower = parts_of(x), upper = parts_of(y);
      matrix.solve_lower(lower.data());
      matrix.solve_transposed_upper(upper.data());
      Mat3 sum = Mat3::Zero();
      for (std::size_t i = 0; i < lower.size(); ++i) sum += upper[i].transpose() * lower[i];
      const MatrixXd truth = test::product(y.transpose(), test::solution(dense, x));
      EXPECT_LT((test::eigen(sum) - truth).norm(), 1e-9 * (1.0 + truth.norm())) << count;
    }
  }
}

// A pivot is at least what rounding leaves of the whole that the matrix is left of.
TEST(BlockMatrix, KnowsWhatItIsLeftOf) {
  for (const bool is_symmetric : {true, false}) {
    BlockMatrix<3> matrix;
    matrix.reset(1, is_symmetric);
    matrix(0, 0) = Vec3(1.0, -1e-3, 4.0).asDiagonal();
    const Vec3 whole(2.0, 1e13, 5.0);
    matrix.factor(&whole);
    Vec3 x(1.0, 1.0, 1.0);
    matrix.solve(&x);
    EXPECT_EQ(x[0], 1.0);
    EXPECT_NEAR(x[1] * 1e13 * std::numeric_limits<double>::epsilon(), 1.0, 1e-12);
    EXPECT_EQ(x[2], 0.25);
  }
}

TEST(BlockMatrix, SolvesForNothing) {
  BlockMatrix<3> matrix;
  matrix.reset(0, true);
  matrix.factor();
  matrix.solve(nullptr);
}

// Stiffnesses of 1e30 along directions that are nearly one: in doubles there is no inverse.
TEST(BlockMatrix, StaysFiniteWhereRoundingHasMadeItSingular) {
  test::Random random(3);
  for (const bool is_symmetric : {true, false}) {
    for (int run = 0; run < 200; ++run) {
      MatrixXd root(6, 2);
      for (double& x : root.reshaped()) x = 1e15 * random.uniform(0.9, 1.1);
      const MatrixXd dense = MatrixXd::Identity(6, 6) + test::square(root);
      BlockMatrix<3> matrix = in_blocks<3>(dense, is_symmetric);
      matrix.factor();
      std::vector<Vec3> x(2, Vec3::Constant(1.0));
      matrix.solve(x.data());
      ASSERT_TRUE(x[0].allFinite() && x[1].allFinite()) << run;
    }
  }
}

}  // namespace
}  // namespace volcontact::block_matrix_test
