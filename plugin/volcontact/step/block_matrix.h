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

  bool is_symmetric() const { return is_symmetric_; }

  /// Block (i, k); of a symmetric matrix with k <= i.
  Block& operator()(int i, int k) { return blocks_[index(i, k)]; }

  /// In place: blocks of L below the diagonal, and of U, transposed, above it. `whole`: the
  /// diagonal of what this matrix is left of, as other unknowns were eliminated; without, its own.
  void factor(const Column* whole = nullptr) {
    if (is_symmetric_) {
      factor_as<true>(whole);
    } else {
      factor_as<false>(whole);
    }
  }

  /// After `factor`: solves for one right side, K numbers a block, in place.
  void solve(Column* x) const {
    solve_lower(x);
    solve_upper(x);
  }

  // The two halves of that, and L replaced by U', for right sides of one column or several. U is L'
  // of a symmetric matrix.
  template <typename X>
  void solve_lower(X* x) const {
    if (is_symmetric_) {
      go_down<true, false>(x);
    } else {
      go_down<false, false>(x);
    }
  }
  template <typename X>
  void solve_transposed_upper(X* x) const {
    if (is_symmetric_) {
      go_down<true, false>(x);
    } else {
      go_down<false, true>(x);
    }
  }
  void solve_upper(Column* x) const {
    if (is_symmetric_) {
      go_up<true>(x);
    } else {
      go_up<false>(x);
    }
  }

 private:
  const Block& at(int i, int k) const { return blocks_[index(i, k)]; }
  const Column& inverse(int i) const { return inverse_[static_cast<std::size_t>(i)]; }
  // The transpose of block (k, i) of U, k < i.
  template <bool kSymmetric>
  const Block& upper(int k, int i) const {
    return kSymmetric ? at(i, k) : at(k, i);
  }

  template <bool kSymmetric>
  void factor_as(const Column* whole) {
    for (int k = 0; k < count_; ++k) {
      const Column before = whole ? whole[k] : (*this)(k, k).diagonal();
      subtract_before<kSymmetric>(k, k);
      factor_block<kSymmetric>(k, before);
      for (int i = k + 1; i < count_; ++i) {
        subtract_before<kSymmetric>(i, k);
        divide<kSymmetric, true>(k, (*this)(i, k));
        if constexpr (!kSymmetric) {
          subtract_before<kSymmetric>(k, i);
          (*this)(k, i) = (*this)(k, i).transpose();
          divide<kSymmetric, false>(k, (*this)(k, i));
        }
      }
    }
  }

  // What the columns factored so far make of block (i, k).
  template <bool kSymmetric>
  void subtract_before(int i, int k) {
    Block sum = (*this)(i, k);
    for (int before = 0; before < std::min(i, k); ++before) {
      sum -= at(i, before) * upper<kSymmetric>(before, k).transpose();
    }
    (*this)(i, k) = sum;
  }

  // L and U of a block of the diagonal, L with ones on its diagonal where it is not symmetric.
  // Where rounding has made the matrix singular, a pivot is what rounding leaves of it.
  template <bool kSymmetric>
  void factor_block(int k, const Column& whole) {
    Block& block = (*this)(k, k);
    Column& inverse = inverse_[static_cast<std::size_t>(k)];
    for (int c = 0; c < K; ++c) {
      const double pivot = std::max(block(c, c), std::numeric_limits<double>::epsilon() * whole[c]);
      inverse[c] = 1.0 / (kSymmetric ? std::sqrt(pivot) : pivot);
      for (int r = c + 1; r < K; ++r) block(r, c) *= inverse[c];
      for (int j = c + 1; j < K; ++j) {
        const double by = kSymmetric ? block(j, c) : block(c, j);
        for (int r = kSymmetric ? j : c + 1; r < K; ++r) block(r, j) -= block(r, c) * by;
      }
    }
  }

  // x U^-1, or x L'^-1, of the block k of the diagonal.
  template <bool kSymmetric, bool kByUpper>
  void divide(int k, Block& x) const {
    const Block& block = at(k, k);
    for (int c = 0; c < K; ++c) {
      for (int b = 0; b < c; ++b) {
        x.col(c) -= (kByUpper && !kSymmetric ? block(b, c) : block(c, b)) * x.col(b);
      }
      if constexpr (kByUpper || kSymmetric) x.col(c) *= inverse(k)[c];
    }
  }

  // Column by column.
  template <typename Use>
  static void for_each_column(Column& x, const Use& use) {
    use(x);
  }
  template <int M, typename Use>
  static void for_each_column(Matrix<K, M>& x, const Use& use) {
    for (int k = 0; k < M; ++k) use(x.col(k));
  }

  template <bool kSymmetric, bool kByUpper, typename X>
  void go_down(X* x) const {
    for (int i = 0; i < count_; ++i) {
      X out = x[i];
      for (int k = 0; k < i; ++k) out -= (kByUpper ? upper<kSymmetric>(k, i) : at(i, k)) * x[k];
      const Block& block = at(i, i);
      for_each_column(out, [&](Column& column) {
        for (int r = 0; r < K; ++r) {
          for (int c = 0; c < r; ++c)
            column[r] -= (kByUpper ? block(c, r) : block(r, c)) * column[c];
          if constexpr (kByUpper || kSymmetric) column[r] *= inverse(i)[r];
        }
      });
      x[i] = out;
    }
  }

  template <bool kSymmetric>
  void go_up(Column* x) const {
    for (int i = count_ - 1; i >= 0; --i) {
      Column out = x[i];
      const Block& block = at(i, i);
      for (int r = K - 1; r >= 0; --r) {
        for (int c = r + 1; c < K; ++c) {
          out[r] -= (kSymmetric ? block(c, r) : block(r, c)) * out[c];
        }
        out[r] *= inverse(i)[r];
      }
      x[i] = out;
      for (int k = 0; k < i; ++k) x[k] -= upper<kSymmetric>(k, i).transposed_times(out);
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
