// SPDX-License-Identifier: Apache-2.0
#include "volcontact/step/matrix/dense_matrix.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "core/support/dense.h"
#include "core/support/random.h"

namespace volcontact::dense_matrix_test {
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

DenseMatrix of(const MatrixXd& dense, bool is_symmetric) {
  DenseMatrix out;
  const int n = static_cast<int>(dense.rows());
  out.reset(n, is_symmetric);
  for (int k = 0; k < n; ++k) {
    for (int i = is_symmetric ? k : 0; i < n; ++i) out.column(k)[i] = dense(i, k);
  }
  return out;
}

std::vector<double> with_zeros(const VectorXd& x) {
  std::vector<double> out(x.begin(), x.end());
  out.resize(out.size() + kLanes, 0.0);
  return out;
}

VectorXd numbers(const std::vector<double>& x) {
  return Eigen::Map<const VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()) - kLanes);
}

TEST(DenseMatrix, SolvesAsTheWholeMatrix) {
  test::Random random(7);
  for (const bool is_symmetric : {true, false}) {
    for (const int n : {1, 2, 3, 5, 6, 8, 15, 16, 17, 39, 78}) {
      const MatrixXd dense = stiff(random, n, is_symmetric);
      DenseMatrix matrix = of(dense, is_symmetric);
      const VectorXd right = random_matrix(random, n, 1), truth = test::solution(dense, right);
      std::vector<double> parts = with_zeros(right);
      matrix.eliminate(n);
      matrix.go_down(parts.data());
      matrix.go_up(parts.data());
      const VectorXd x = numbers(parts);
      // As far from the right side as rounding of the largest entries takes it.
      EXPECT_LT((test::product(dense, x) - right).norm(), 1e-13 * dense.norm() * x.norm() + 1e-12);
      EXPECT_LT((x - truth).norm(), 1e-7 * x.norm()) << n;
    }
  }
}

// What is left is the matrix of the other unknowns, and its right side theirs; from these come the
// ones that were eliminated.
TEST(DenseMatrix, LeavesTheMatrixOfTheOthers) {
  test::Random random(5);
  for (const bool is_symmetric : {true, false}) {
    for (const int n : {6, 12, 23, 36}) {
      const int out = n / 2, left = n - out;
      const MatrixXd dense = stiff(random, n, is_symmetric);
      const VectorXd right = random_matrix(random, n, 1), truth = test::solution(dense, right);
      DenseMatrix matrix = of(dense, is_symmetric);
      std::vector<double> x = with_zeros(right);
      matrix.eliminate(out);
      matrix.go_down(x.data());
      MatrixXd others(left, left);
      for (int k = 0; k < left; ++k) {
        for (int i = 0; i < left; ++i) {
          const bool is_there = !is_symmetric || i >= k;
          others(i, k) =
              is_there ? matrix.column(out + k)[out + i] : matrix.column(out + i)[out + k];
        }
      }
      const MatrixXd of_out =
          test::solution(dense.topLeftCorner(out, out), dense.topRightCorner(out, left));
      const MatrixXd complement = dense.bottomRightCorner(left, left) -
                                  test::product(dense.bottomLeftCorner(left, out), of_out);
      EXPECT_LT((others - complement).norm(), 1e-9 * dense.norm());
      const VectorXd solved = test::solution(others, numbers(x).tail(left));
      EXPECT_LT((solved - truth.tail(left)).norm(), 1e-6 * truth.norm());
      for (int i = 0; i < left; ++i) x[static_cast<std::size_t>(out + i)] = solved[i];
      matrix.go_up(x.data());
      EXPECT_LT((numbers(x) - truth).norm(), 1e-6 * truth.norm()) << n;
    }
  }
}

// A pivot is at least what rounding leaves of the whole that the matrix is left of.
TEST(DenseMatrix, KnowsWhatItIsLeftOf) {
  for (const bool is_symmetric : {true, false}) {
    DenseMatrix matrix = of(Eigen::Vector3d(1.0, -1e-3, 4.0).asDiagonal(), is_symmetric);
    const double whole[] = {2.0, 1e13, 5.0};
    matrix.eliminate(3, whole);
    std::vector<double> x = with_zeros(Eigen::Vector3d(1.0, 1.0, 1.0));
    matrix.go_down(x.data());
    matrix.go_up(x.data());
    EXPECT_EQ(x[0], 1.0);
    EXPECT_NEAR(x[1] * 1e13 * std::numeric_limits<double>::epsilon(), 1.0, 1e-12);
    EXPECT_EQ(x[2], 0.25);
  }
}

TEST(DenseMatrix, SolvesForNothing) {
  DenseMatrix matrix;
  matrix.reset(0, true);
  matrix.eliminate(0);
  std::vector<double> x(kLanes, 0.0);
  matrix.go_down(x.data());
  matrix.go_up(x.data());
  EXPECT_EQ(x, std::vector<double>(kLanes, 0.0));
}

TEST(DenseMatrix, StaysFiniteWhereRoundingHasMadeItSingular) {
  test::Random random(9);
  for (const bool is_symmetric : {true, false}) {
    for (const double scale : {1e6, 1e12, 1e18}) {
      const int n = 15;
      const MatrixXd dense =
          MatrixXd::Identity(n, n) + scale * test::square(random_matrix(random, n, 4));
      DenseMatrix matrix = of(dense, is_symmetric);
      std::vector<double> x = with_zeros(random_matrix(random, n, 1));
      matrix.eliminate(n);
      matrix.go_down(x.data());
      matrix.go_up(x.data());
      EXPECT_TRUE(numbers(x).allFinite()) << scale;
    }
  }
}

// Every path, and from another matrix's memory.
TEST(DenseMatrix, HasTheSameBitsOnEveryPath) {
  test::Random random(11);
  for (const bool is_symmetric : {true, false}) {
    for (const int n : {6, 21, 36}) {
      const MatrixXd dense = stiff(random, n, is_symmetric);
      const VectorXd right = random_matrix(random, n, 1);
      std::vector<double> first;
      for (const SimdPath path : {SimdPath::kPortable, SimdPath::kAvx2, SimdPath::kAvx512}) {
        if (!can_run(path)) continue;
        DenseMatrix matrix = of(stiff(random, 40, false), false);
        matrix.path = path;
        matrix.reset(n, is_symmetric);
        for (int k = 0; k < n; ++k) {
          for (int i = is_symmetric ? k : 0; i < n; ++i) matrix.column(k)[i] = dense(i, k);
        }
        std::vector<double> x = with_zeros(right);
        matrix.eliminate(n / 2);
        matrix.go_down(x.data());
        matrix.go_up(x.data());
        if (first.empty()) first = x;
        EXPECT_EQ(x, first) << static_cast<int>(path) << " " << n;
      }
    }
  }
}

MatrixXd with_columns_padded(const MatrixXd& m) {
  MatrixXd out =
      MatrixXd::Zero(static_cast<Eigen::Index>(padded(static_cast<int>(m.rows()))), m.cols());
  out.topRows(m.rows()) = m;
  return out;
}

TEST(DenseProducts, AreThoseOfEigen) {
  test::Random random(13);
  for (const SimdPath path : {SimdPath::kPortable, SimdPath::kAvx2, SimdPath::kAvx512}) {
    if (!can_run(path)) continue;
    for (const int n : {6, 12, 18, 30, 42, 66}) {
      const MatrixXd dense = random_matrix(random, n, n), padded_one = with_columns_padded(dense);
      const VectorXd x = random_matrix(random, n, 1);
      const Eigen::Index rows = padded_one.rows();
      VectorXd y(rows);
      multiply(padded_one.data(), n, x.data(), y.data(), path);
      EXPECT_LT((y.head(n) - test::product(dense, x)).norm(), 1e-14 * n);

      Mat3 root = Mat3::Zero();
      for (int k = 0; k < 3; ++k) {
        for (int i = k; i < 3; ++i) root(i, k) = random.uniform(-1.0, 1.0);
      }
      MatrixXd by_root(rows, 3);
      multiply_by_root(padded_one.data(), static_cast<std::size_t>(rows), root, by_root.data(),
                       path);
      const MatrixXd truth = test::product(dense.leftCols(3), test::eigen(root));
      EXPECT_LT((by_root.topRows(n) - truth).norm(), 1e-14);

      const int count = 3;
      const MatrixXd a = random_matrix(random, n, count), b = random_matrix(random, n, count);
      std::vector<double> by_places;
      for (int place = 0; place < n / 6; ++place) {
        for (int c = 0; c < count; ++c) {
          for (int i = 0; i < 6; ++i) by_places.push_back(b(6 * place + i, c));
        }
      }
      MatrixXd less(rows, n);
      subtract_product(padded_one.data(), n, with_columns_padded(a).data(), by_places.data(), count,
                       less.data(), path);
      const MatrixXd left = dense - test::product(a, b.transpose());
      EXPECT_LT((less.topRows(n) - left).norm(), 1e-13) << n;
    }
  }
}

}  // namespace
}  // namespace volcontact::dense_matrix_test
