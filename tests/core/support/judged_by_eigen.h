// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "core/support/dense.h"
#include "core/support/random.h"

// Eigen is the judge of vectors and matrices.
namespace volcontact::test {

inline constexpr int kJudged = 200;
inline constexpr double kRounding = 1e-15;  // of a sum of products, of its terms' size

/// Components of many sizes.
template <int N>
Vector<N> vector_of_many_sizes(Random& random) {
  Vector<N> v;
  for (double& x : v) x = random.uniform(-1.0, 1.0) * random.log_uniform(1e-3, 1e3);
  return v;
}
template <int R, int C>
Matrix<R, C> matrix_of_many_sizes(Random& random) {
  Matrix<R, C> m;
  for (int k = 0; k < C; ++k) m.col(k) = vector_of_many_sizes<R>(random);
  return m;
}

/// Numbers that one library finds, and how far those of another may be from them.
class Findings {
 public:
  void add(const Eigen::MatrixXd& numbers, double tolerance = 0.0) {
    numbers_.push_back(numbers);
    tolerances_.push_back(tolerance);
  }
  void add(double number, double tolerance = 0.0) {
    add(Eigen::MatrixXd(Eigen::MatrixXd::Constant(1, 1, number)), tolerance);
  }
  template <int N>
  void add(const Vector<N>& v) {
    add(Eigen::MatrixXd(Eigen::MatrixXd::Map(v.data(), N, 1)));
  }
  template <int R, int C>
  void add(const Matrix<R, C>& m) {
    add(Eigen::MatrixXd(Eigen::MatrixXd::Map(m.columns[0].data(), R, C)));
  }

  void expect(const Findings& ours) const {
    ASSERT_EQ(ours.numbers_.size(), numbers_.size());
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
      ASSERT_EQ(ours.numbers_[i].rows(), numbers_[i].rows()) << "number " << i;
      ASSERT_EQ(ours.numbers_[i].cols(), numbers_[i].cols()) << "number " << i;
      // Squares of tiny differences are 0: the same numbers are asked for by themselves.
      const bool is_near = (ours.numbers_[i] - numbers_[i]).norm() <= tolerances_[i];
      EXPECT_TRUE(tolerances_[i] > 0.0 ? is_near : ours.numbers_[i] == numbers_[i])
          << "number " << i;
    }
  }

 private:
  std::vector<Eigen::MatrixXd> numbers_;
  std::vector<double> tolerances_;
};

}  // namespace volcontact::test
