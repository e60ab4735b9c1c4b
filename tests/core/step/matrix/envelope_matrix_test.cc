// SPDX-License-Identifier: Apache-2.0
#include "volcontact/step/matrix/envelope_matrix.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/support/dense.h"
#include "core/support/random.h"

namespace volcontact::envelope_matrix_test {
namespace {

using Eigen::MatrixXd;

// A random positive definite matrix whose rows begin where `first` says.
MatrixXd fill(const std::vector<int>& first, test::Random& random, EnvelopeMatrix& out) {
  const int n = static_cast<int>(first.size());
  MatrixXd dense = MatrixXd::Zero(n, n);
  out.reset(first);
  for (int i = 0; i < n; ++i) {
    for (int k = out.first(i); k <= i; ++k) {
      dense(i, k) = dense(k, i) = out(i, k) = random.uniform(-1.0, 1.0) + (i == k ? n : 0.0);
    }
  }
  return dense;
}

TEST(EnvelopeMatrix, SolvesAsTheWholeMatrix) {
  test::Random random(1);
  for (const std::vector<int>& first : {std::vector<int>{0},
                                        {0, 0, 0, 2, 2, 1, 0, 7, 7, 3, 9},
                                        {0, 1, 2, 3},
                                        {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}}) {
    EnvelopeMatrix matrix;
    const MatrixXd dense = fill(first, random, matrix);
    const int n = matrix.size();
    MatrixXd right(6, n);
    for (int i = 0; i < 6 * n; ++i) right.data()[i] = random.uniform(-1.0, 1.0);
    const MatrixXd truth = test::solution(dense, right.transpose()).transpose();
    matrix.factor();
    Eigen::VectorXd one = right.row(2);
    matrix.solve(one.data(), 0, n);
    matrix.solve<6>(right.data(), 0, n);
    EXPECT_LT((right - truth).norm(), 1e-13 * truth.norm());
    EXPECT_LT((one - truth.row(2)).norm(), 1e-13 * truth.norm());
  }
}

TEST(EnvelopeMatrix, SolvesWhereItIsNotSymmetric) {
  test::Random random(4);
  const std::vector<int> first = {0, 0, 0, 2, 2, 1, 0, 7, 7, 3, 9};
  const int n = static_cast<int>(first.size());
  EnvelopeMatrix matrix, symmetric;
  MatrixXd dense = fill(first, random, symmetric);
  matrix.reset(first, false);
  matrix.add(symmetric);
  for (int i = 0; i < n; ++i) {
    for (int k = matrix.first(i); k < i; ++k) {
      const double below = random.uniform(-1.0, 1.0), above = random.uniform(-1.0, 1.0);
      matrix(i, k) += below;
      matrix.mirrored(i, k) += above;
      dense(i, k) += below;
      dense(k, i) += above;
    }
  }
  Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(n, -1.0, 2.0);
  const Eigen::VectorXd truth = test::solution(dense, x);
  matrix.factor();
  matrix.solve(x.data(), 0, n);
  EXPECT_LT((x - truth).norm(), 1e-13 * truth.norm());
}

TEST(EnvelopeMatrix, SolvesForUnknownsThatStandAlone) {
  test::Random random(2);
  EnvelopeMatrix matrix;
  const MatrixXd dense = fill({0, 0, 2, 2, 3, 5, 5}, random, matrix);
  Eigen::Vector3d x(1.0, -2.0, 0.5);
  const Eigen::Vector3d truth = test::solution(dense.block<3, 3>(2, 2), x);
  matrix.factor();
  matrix.solve(x.data(), 2, 5);
  EXPECT_LT((x - truth).norm(), 1e-14 * truth.norm());
}

TEST(EnvelopeMatrix, AddsANarrowerOne) {
  test::Random random(3);
  EnvelopeMatrix wide, narrow;
  const MatrixXd sum = fill({0, 0, 0, 1}, random, wide) + fill({0, 1, 0, 3}, random, narrow);
  wide.add(narrow);
  for (int i = 0; i < 4; ++i) {
    for (int k = wide.first(i); k <= i; ++k) EXPECT_EQ(wide(i, k), sum(i, k));
  }
}

// Constraints of 1e15 along directions that are nearly one: in doubles 1 + G G' has no inverse.
TEST(EnvelopeMatrix, StaysFiniteWhereRoundingHasMadeItSingular) {
  constexpr int kCount = 4;
  test::Random random(3);
  for (const bool is_symmetric : {true, false}) {
    for (int run = 0; run < 200; ++run) {
      MatrixXd root(kCount, 2);
      for (double& x : root.reshaped()) x = 1e15 * random.uniform(0.9, 1.1);
      const MatrixXd dense = MatrixXd::Identity(kCount, kCount) + test::square(root);
      EnvelopeMatrix matrix;
      matrix.reset(std::vector<int>(kCount, 0), is_symmetric);
      for (int i = 0; i < kCount; ++i) {
        for (int k = 0; k <= i; ++k) {
          matrix(i, k) = dense(i, k);
          if (!is_symmetric && k < i) matrix.mirrored(i, k) = dense(k, i);
        }
      }
      matrix.factor();
      Eigen::VectorXd x = Eigen::VectorXd::Ones(kCount);
      matrix.solve(x.data(), 0, kCount);
      ASSERT_TRUE(x.allFinite()) << run;
    }
  }
}

}  // namespace
}  // namespace volcontact::envelope_matrix_test
