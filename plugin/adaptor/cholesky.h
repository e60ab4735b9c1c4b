// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>

#include "volcontact/base/types.h"

namespace volcontact::adaptor {

// Cholesky factor L of a symmetric positive definite matrix of any size, in place: unlike
// Eigen::LLT this takes no memory of its own, and for the few rows of a scene it is as fast. Of the
// n x n matrix `a`, row by row, the lower triangle is read and overwritten; the diagonal gets the
// inverse of that of L.

inline void factor_in_place(double* a, int n) {
  using Row = Eigen::Map<const Eigen::VectorXd>;
  for (int i = 0; i < n; ++i) {
    double* row = a + static_cast<std::ptrdiff_t>(i) * n;
    for (int k = 0; k < i; ++k) {
      const double* other = a + static_cast<std::ptrdiff_t>(k) * n;
      row[k] = (row[k] - Row(row, k).dot(Row(other, k))) * other[k];
    }
    row[i] = 1.0 / std::sqrt(row[i] - Row(row, i).squaredNorm());
  }
}

/// Solves L L' x = b with such a factor; `x` holds b at first.
inline void solve_in_place(const double* factor, int n, double* x) {
  using Row = Eigen::Map<const Eigen::VectorXd>;
  for (int i = 0; i < n; ++i) {
    const double* row = factor + static_cast<std::ptrdiff_t>(i) * n;
    x[i] = (x[i] - Row(row, i).dot(Row(x, i))) * row[i];
  }
  for (int i = n - 1; i >= 0; --i) {
    const double* row = factor + static_cast<std::ptrdiff_t>(i) * n;
    x[i] *= row[i];
    Eigen::Map<Eigen::VectorXd>(x, i) -= x[i] * Row(row, i);
  }
}

}  // namespace volcontact::adaptor
