// SPDX-License-Identifier: Apache-2.0
#include "volcontact/step/matrix/tree_matrix.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/support/dense.h"
#include "core/support/random.h"

namespace volcontact::tree_matrix_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Two trees: limbs 0-1 and 2-3 of the trunk 4-5-6, and 7-8 of the other, each carried by the later.
const std::vector<int> kParents = {1, 4, 3, 4, 5, 6, -1, 8, -1};

MatrixXd fill(const DofTrees& trees, bool is_symmetric, TreeMatrix& out) {
  test::Random random(5);
  MatrixXd dense = MatrixXd::Zero(trees.size(), trees.size());
  out.reset(trees, is_symmetric);
  for (int i = 0; i < trees.size(); ++i) {
    dense(i, i) = out(i, i) = 9.0 + random.uniform(0.0, 1.0);
    for (int k = trees.parent(i); k >= 0; k = trees.parent(k)) {
      dense(i, k) = out(i, k) = random.uniform(-1.0, 1.0);
      dense(k, i) = dense(i, k);
      if (!is_symmetric) dense(k, i) = out.mirrored(i, k) = random.uniform(-1.0, 1.0);
    }
  }
  return dense;
}

VectorXd right_side(int n) {
  test::Random random(6);
  VectorXd out(n);
  for (double& x : out) x = random.uniform(-1.0, 1.0);
  return out;
}

class TreeMatrices : public ::testing::TestWithParam<bool> {
 protected:
  TreeMatrices() {
    trees_.set(kParents);
    dense_ = fill(trees_, GetParam(), matrix_);
  }
  DofTrees trees_;
  TreeMatrix matrix_;
  MatrixXd dense_;
};

TEST_P(TreeMatrices, ReadsBothHalves) {
  const TreeMatrix& matrix = matrix_;
  EXPECT_EQ(matrix.is_symmetric(), GetParam());
  for (int i = 0; i < trees_.size(); ++i) {
    for (int k = trees_.parent(i); k >= 0; k = trees_.parent(k)) {
      EXPECT_EQ(matrix(i, k), dense_(i, k));
      EXPECT_EQ(matrix.mirrored(i, k), dense_(k, i));
      EXPECT_EQ(matrix_.mirrored(i, k), dense_(k, i));
    }
  }
}

TEST_P(TreeMatrices, SolvesAndMultipliesAsTheWholeMatrix) {
  const VectorXd right = right_side(trees_.size());
  VectorXd product(trees_.size()), x = right;
  matrix_.multiply_transposed(right.data(), product.data());
  EXPECT_LT((product - test::product(dense_.transpose(), right)).norm(), 1e-13);
  matrix_.factor();
  matrix_.solve(x.data());
  EXPECT_LT((test::product(dense_, x) - right).norm(), 1e-13);
}

// x' A^-1 y of vectors with few entries, by their carriers alone.
TEST_P(TreeMatrices, CarriesWhatFewDegreesOfFreedomHave) {
  VectorXd left = VectorXd::Zero(trees_.size()), right = left;
  left[0] = 2.0;
  left[7] = 1.0;
  right[2] = -1.0;
  right[5] = 0.5;
  const double truth = left.dot(test::solution(dense_, right).col(0));
  matrix_.factor();
  const std::vector<int> of_left = {0, 1, 4, 5, 6, 7, 8}, of_right = {2, 3, 4, 5, 6};
  matrix_.carry_lower(of_left, left.data());
  matrix_.carry_upper(of_right, right.data());
  double sum = 0.0;
  for (int i = 0; i < trees_.size(); ++i) sum += left[i] * matrix_.inverse_pivot(i) * right[i];
  EXPECT_NEAR(sum, truth, 1e-14);
  EXPECT_EQ(left[2], 0.0);
  EXPECT_EQ(right[0], 0.0);
}

INSTANTIATE_TEST_SUITE_P(Both, TreeMatrices, ::testing::Bool(), [](const auto& run) {
  return std::string(run.param ? "Symmetric" : "Other");
});

}  // namespace
}  // namespace volcontact::tree_matrix_test
