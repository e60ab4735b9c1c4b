// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

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

template <typename A, typename B>
void expect_same(const A& ours, const B& theirs) {
  EXPECT_EQ(eigen(ours), theirs.eval());
}
template <typename A, typename B>
void expect_near(const A& ours, const B& theirs, double size) {
  EXPECT_LE((eigen(ours) - theirs).norm(), kRounding * size);
}

}  // namespace volcontact::test
