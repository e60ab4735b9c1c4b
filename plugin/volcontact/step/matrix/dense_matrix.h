// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "volcontact/base/simd.h"
#include "volcontact/base/types.h"

namespace volcontact {

/// Whole registers of `count` numbers.
inline std::size_t padded(int count) {
  return static_cast<std::size_t>((count + kLanes - 1) / kLanes * kLanes);
}

/// A square matrix, written column by column, from which unknowns are eliminated, the first ones
/// before the others: what is left of the others, as of their own matrix, stands in its place.
/// Gauss's elimination without exchange of rows, for matrices whose symmetric part is positive
/// definite. Memory is reused from matrix to matrix.
class DenseMatrix {
 public:
  SimdPath path = best_simd_path();

  /// Of any values.
  void reset(int size, bool is_symmetric);

  int size() const { return size_; }
  bool is_symmetric() const { return is_symmetric_; }

  /// Its numbers; of a symmetric matrix those from the diagonal on.
  double* column(int i) { return numbers_.data() + static_cast<std::size_t>(i) * stride_; }
  const double* column(int i) const {
    return numbers_.data() + static_cast<std::size_t>(i) * stride_;
  }

  /// Eliminates the first `count` unknowns. A pivot is at least what rounding leaves of `whole`,
  /// the diagonal of what this matrix is left of; without, of its own.
  void eliminate(int count, const double* whole = nullptr);

  // After it, for a right side: a number a row, and `kLanes` zeros behind them.

  /// Takes the eliminated unknowns out of the right sides of the others.
  void go_down(double* x) const;
  /// Solves for the eliminated unknowns, once the others stand in place of their right sides.
  void go_up(double* x) const;

 private:
  int size_ = 0, eliminated_ = 0;
  bool is_symmetric_ = true;
  std::size_t stride_ = 0;
  std::vector<double> numbers_;
  std::vector<double> shares_;  // of each pivot's column in the next, where it is not symmetric
  std::vector<double> inverse_, whole_;  // of the pivots
};

// Products of matrices whose columns stand one after another, each padded with zeros.

/// y = M x of a square matrix; y has room for a padded column.
void multiply(const double* matrix, int size, const double* x, double* y,
              SimdPath path = best_simd_path());

/// Three columns of `stride` numbers, times a lower triangular matrix.
void multiply_by_root(const double* columns, std::size_t stride, const Mat3& root, double* out,
                      SimdPath path = best_simd_path());

/// out = M - A B' of a square matrix, with `count` columns of A and of B. B stands by blocks of six
/// rows, the columns of each block one after another.
void subtract_product(const double* matrix, int size, const double* a, const double* b, int count,
                      double* out, SimdPath path = best_simd_path());

}  // namespace volcontact
