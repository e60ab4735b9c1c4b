// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "volcontact/base/matrix.h"

namespace volcontact {

/// A square matrix of full blocks of K x K numbers, and its Cholesky factor, or L and U without
/// exchange of rows where it is not symmetric: for matrices whose symmetric part is positive
/// definite. Memory is reused from matrix to matrix.
template <int K>
class BlockMatrix {
 public:
  using Block = Matrix<K, K>;
  using Column = Vector<K>;

  /// Of `count` blocks a side, with any values.
  void reset(int count, bool is_symmetric) {
    count_ = count;
    is_symmetric_ = is_symmetric;
    const std::size_t rows = static_cast<std::size_t>(count);
    blocks_.resize(rows * rows);
    inverse_.resize(rows);
  }

  /// Block (i, k); of a symmetric matrix with k <= i.
  Block& operator()(int i, int k) { return blocks_[index(i, k)]; }

  /// In place: blocks of L below the diagonal, and of U, transposed, above it.
  void factor() {
    for (int k = 0; k < count_; ++k) {
      const Column whole = (*this)(k, k).diagonal();
      subtract_before(k, k);
      factor_block(k, whole);
      for (int i = k + 1; i < count_; ++i) {
        subtract_before(i, k);
        divide(k, (*this)(i, k), true);
        if (is_symmetric_) continue;
        subtract_before(k, i);
        (*this)(k, i) = (*this)(k, i).transpose();
        divide(k, (*this)(k, i), false);
      }
    }
  }

  /// After `factor`: solves for one right side, K numbers a block, in place.
  void solve(double* x) const {
    for (int i = 0; i < count_; ++i) {
      Column out = of(x, i);
      for (int k = 0; k < i; ++k) out -= at(i, k) * of(x, k);
      const Block& block = at(i, i);
      for (int r = 0; r < K; ++r) {
        for (int c = 0; c < r; ++c) out[r] -= block(r, c) * out[c];
        if (is_symmetric_) out[r] *= inverse(i)[r];
      }
      out.to(x + K * i);
    }
    for (int i = count_ - 1; i >= 0; --i) {
      Column out = of(x, i);
      const Block& block = at(i, i);
      for (int r = K - 1; r >= 0; --r) {
        for (int c = r + 1; c < K; ++c) {
          out[r] -= (is_symmetric_ ? block(c, r) : block(r, c)) * out[c];
        }
        out[r] *= inverse(i)[r];
      }
      out.to(x + K * i);
      for (int k = 0; k < i; ++k) {
        (of(x, k) - upper(k, i).transposed_times(out)).to(x + K * k);
      }
    }
  }

 private:
  static Column of(const double* x, int i) { return Column::from(x + K * i); }
  const Block& at(int i, int k) const { return blocks_[index(i, k)]; }
  // The transpose of block (k, i) of U, k < i.
  const Block& upper(int k, int i) const { return is_symmetric_ ? at(i, k) : at(k, i); }
  const Column& inverse(int i) const { return inverse_[static_cast<std::size_t>(i)]; }

  // What the columns factored so far make of block (i, k).
  void subtract_before(int i, int k) {
    Block sum = (*this)(i, k);
    for (int before = 0; before < std::min(i, k); ++before) {
      sum -= at(i, before) * upper(before, k).transpose();
    }
    (*this)(i, k) = sum;
  }

  // L and U of a block of the diagonal, L with ones on its diagonal where it is not symmetric.
  // `whole`: its diagonal at first. Where rounding has made the matrix singular, a pivot is what
  // rounding leaves of it.
  void factor_block(int k, const Column& whole) {
    Block& block = (*this)(k, k);
    Column& inverse = inverse_[static_cast<std::size_t>(k)];
    for (int c = 0; c < K; ++c) {
      const double pivot = std::max(block(c, c), std::numeric_limits<double>::epsilon() * whole[c]);
      inverse[c] = 1.0 / (is_symmetric_ ? std::sqrt(pivot) : pivot);
      for (int r = c + 1; r < K; ++r) block(r, c) *= inverse[c];
      for (int j = c + 1; j < K; ++j) {
        const double by = is_symmetric_ ? block(j, c) : block(c, j);
        for (int r = is_symmetric_ ? j : c + 1; r < K; ++r) block(r, j) -= block(r, c) * by;
      }
    }
  }

  // x U^-1, or x L'^-1, of the block k of the diagonal.
  void divide(int k, Block& x, bool by_upper) const {
    const Block& block = at(k, k);
    for (int c = 0; c < K; ++c) {
      for (int b = 0; b < c; ++b) {
        x.col(c) -= (by_upper && !is_symmetric_ ? block(b, c) : block(c, b)) * x.col(b);
      }
      if (by_upper || is_symmetric_) x.col(c) *= inverse(k)[c];
    }
  }

  std::size_t index(int i, int k) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(count_) +
           static_cast<std::size_t>(k);
  }

  int count_ = 0;
  bool is_symmetric_ = true;
  std::vector<Block> blocks_;
  std::vector<Column> inverse_;  // of U's diagonal
};

}  // namespace volcontact
