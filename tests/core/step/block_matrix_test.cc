// SPDX-License-Identifier: Apache-2.0
#include "volcontact/step/block_matrix.h"

#include <gtest/gtest.h>

#include "core/support/dense.h"
#include "core/support/random.h"

namespace volcontact::block_matrix_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// The unit matrix and one that is semidefinite, of half the rank and up to 1e6 as large; with a
// part that is not symmetric where it is asked for.
template <int K>
void expect_solves(int count, bool is_symmetric) {
  test::Random random(7);
  BlockMatrix<K> matrix;
  const int n = K * count;
  const auto fill = [&](Eigen::Index rows, Eigen::Index columns) {
    MatrixXd out(rows, columns);
    for (double& x : out.reshaped()) x = random.uniform(-1.0, 1.0);
    return out;
  };
  const MatrixXd root = 1e3 * fill(n, (n + 1) / 2), turn = fill(n, n);
  MatrixXd dense = MatrixXd::Identity(n, n) + test::square(root);
  if (!is_symmetric) dense += 10.0 * (turn - turn.transpose());
  matrix.reset(count, is_symmetric);
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < (is_symmetric ? i + 1 : count); ++k) {
      matrix(i, k) = dense.block<K, K>(K * i, K * k);
    }
  }
  const VectorXd right = fill(n, 1), truth = test::solution(dense, right);
  VectorXd x = right;
  matrix.factor();
  matrix.solve(x.data());
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
      BlockMatrix<3> matrix;
      matrix.reset(2, is_symmetric);
      for (int i = 0; i < 2; ++i) {
        for (int k = 0; k < (is_symmetric ? i + 1 : 2); ++k) {
          matrix(i, k) = dense.block<3, 3>(3 * i, 3 * k);
        }
      }
      matrix.factor();
      VectorXd x = VectorXd::Ones(6);
      matrix.solve(x.data());
      ASSERT_TRUE(x.allFinite()) << run;
    }
  }
}

}  // namespace
}  // namespace volcontact::block_matrix_test
