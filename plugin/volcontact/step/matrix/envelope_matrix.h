// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "volcontact/base/types.h"

namespace volcontact {

/// The lower triangle of a symmetric matrix, of each row what lies between its first entry that is
/// not zero and the diagonal. A Cholesky factor fills no more, so bodies that do not touch cost
/// each other nothing. A matrix that is not symmetric has the mirror image of this pattern above
/// the diagonal, and LU factors without exchange of rows. Memory is reused from matrix to matrix.
class EnvelopeMatrix {
 public:
  int size() const { return static_cast<int>(first_.size()); }

  /// Sets all to zero; `first` has the first column of each row.
  void reset(std::span<const int> first, bool is_symmetric = true) {
    first_.assign(first.begin(), first.end());
    start_.resize(first.size());
    std::ptrdiff_t count = 0;
    for (std::size_t i = 0; i < first.size(); ++i) {
      start_[i] = count - first_[i];
      count += static_cast<std::ptrdiff_t>(i) + 1 - first_[i];
    }
    numbers_.assign(static_cast<std::size_t>(count), 0.0);
    upper_.assign(is_symmetric ? 0 : numbers_.size(), 0.0);
    last_.resize(first.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
      last_[i] = static_cast<int>(i);
      int& last = last_[static_cast<std::size_t>(first_[i])];
      last = std::max(last, static_cast<int>(i));
    }
    for (std::size_t k = 1; k < last_.size(); ++k) last_[k] = std::max(last_[k], last_[k - 1]);
  }

  bool is_symmetric() const { return upper_.empty(); }
  int first(int i) const { return first_[static_cast<std::size_t>(i)]; }

  /// Entry (i, j), first(i) <= j <= i.
  double& operator()(int i, int j) { return numbers_[index(i, j)]; }
  double operator()(int i, int j) const { return numbers_[index(i, j)]; }
  /// Entry (j, i), first(i) <= j < i, of a matrix that is not symmetric.
  double& mirrored(int i, int j) { return upper_[index(i, j)]; }
  double mirrored(int i, int j) const {
    return is_symmetric() ? (*this)(i, j) : upper_[index(i, j)];
  }

  /// Adds `x` to entries (i, j) and (j, i), j <= i.
  void add_both(int i, int j, double x) {
    (*this)(i, j) += x;
    if (!is_symmetric() && j < i) mirrored(i, j) += x;
  }

  /// Adds a matrix whose envelope is within that of this one; to a symmetric one a symmetric one.
  void add(const EnvelopeMatrix& other) {
    for (int i = 0; i < size(); ++i) {
      for (int k = other.first(i); k <= i; ++k) {
        (*this)(i, k) += other(i, k);
        if (!is_symmetric() && k < i) mirrored(i, k) += other.mirrored(i, k);
      }
    }
  }

  /// The Cholesky factor of a positive definite matrix, or L and U of one that is not symmetric, L
  /// with ones on its diagonal; in place, the diagonal as inverses.
  void factor() {
    if (is_symmetric()) {
      factor_symmetric();
    } else {
      factor_other();
    }
  }

  /// After `factor`: solves for the unknowns begin ... end - 1, which no other row has entries
  /// with, under `kSides` right sides. `x` has as many numbers for each of these unknowns, the
  /// right sides at first.
  template <int kSides = 1>
  void solve(double* x, int begin, int end) const {
    using Numbers = Vector<kSides>;
    const auto at_unknown = [&](int i) { return x + kSides * (i - begin); };
    const auto of = [&](int i) { return Numbers::from(at_unknown(i)); };
    for (int i = begin; i < end; ++i) {
      const double* row = at(i, first(i));
      Numbers sum = of(i);
      for (int k = first(i); k < i; ++k) sum -= *row++ * of(k);
      (is_symmetric() ? *row * sum : sum).to(at_unknown(i));
    }
    for (int i = end - 1; i >= begin; --i) {
      const Numbers solved = (*this)(i, i) * of(i);
      solved.to(at_unknown(i));
      const double* row = is_symmetric() ? at(i, first(i)) : &upper_[index(i, first(i))];
      for (int k = first(i); k < i; ++k) (of(k) - *row++ * solved).to(at_unknown(k));
    }
  }

 private:
  // Both column by column, whose entries do not wait for each other.
  void factor_symmetric() {
    for (int k = 0; k < size(); ++k) {
      const double* const pivot = at(k, first(k));
      double& diagonal = (*this)(k, k);
      diagonal = 1.0 / std::sqrt(pivot_left(diagonal, dot(pivot, pivot, k - first(k))));
      for (int i = k + 1; i <= last_[static_cast<std::size_t>(k)]; ++i) {
        if (first(i) > k) continue;
        const int from = std::max(first(i), first(k));
        double& entry = (*this)(i, k);
        entry = (entry - dot(at(i, from), at(k, from), k - from)) * diagonal;
      }
    }
  }

  void factor_other() {
    for (int k = 0; k < size(); ++k) {
      const double* const left = at(k, first(k));
      const double* const above = &upper_[index(k, first(k))];
      double& diagonal = (*this)(k, k);
      diagonal = 1.0 / pivot_left(diagonal, dot(left, above, k - first(k)));
      for (int i = k + 1; i <= last_[static_cast<std::size_t>(k)]; ++i) {
        if (first(i) > k) continue;
        const int from = std::max(first(i), first(k));
        const std::ptrdiff_t count = k - from, skipped = from - first(k);
        double& entry = (*this)(i, k);
        entry = (entry - dot(at(i, from), above + skipped, count)) * diagonal;
        mirrored(i, k) -= dot(left + skipped, &upper_[index(i, from)], count);
      }
    }
  }

  // Where rounding has made the matrix singular, what rounding leaves.
  static double pivot_left(double diagonal, double taken) {
    return std::max(diagonal - taken, std::numeric_limits<double>::epsilon() * diagonal);
  }

  // In two sums, side by side; rows are short.
  static double dot(const double* a, const double* b, std::ptrdiff_t count) {
    double even = 0.0, odd = 0.0;
    std::ptrdiff_t i = 0;
    for (; i + 2 <= count; i += 2) {
      even += a[i] * b[i];
      odd += a[i + 1] * b[i + 1];
    }
    if (i < count) even += a[i] * b[i];
    return even + odd;
  }

  const double* at(int i, int j) const { return numbers_.data() + index(i, j); }
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(start_[static_cast<std::size_t>(i)] + j);
  }

  std::vector<int> first_;
  std::vector<int> last_;              // the last row that begins at or before each column
  std::vector<std::ptrdiff_t> start_;  // where column 0 of each row would be
  std::vector<double> numbers_;
  std::vector<double> upper_;  // column by column, as the rows in `numbers_`; empty when symmetric
};

}  // namespace volcontact
