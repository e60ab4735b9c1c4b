// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "volcontact/base/vector.h"

namespace volcontact {

/// The degrees of freedom of kinematic trees, each before the one that carries it.
class DofTrees {
 public:
  /// `parents` by number, negative for none.
  void set(std::span<const int> parents) {
    if (std::equal(parents.begin(), parents.end(), parents_.begin(), parents_.end())) return;
    parents_.clear();  // known at the end alone: none of it where there is no memory
    depths_.resize(parents.size());
    starts_.resize(parents.size());
    for (std::size_t i = parents.size(); i-- > 0;) {
      depths_[i] = parents[i] < 0 ? 0 : depths_[static_cast<std::size_t>(parents[i])] + 1;
    }
    count_ = 0;
    for (std::size_t i = 0; i < parents.size(); ++i) {
      starts_[i] = count_;
      count_ += static_cast<std::size_t>(depths_[i]) + 1;
    }
    parents_.assign(parents.begin(), parents.end());
  }

  int size() const { return static_cast<int>(parents_.size()); }
  int parent(int i) const { return parents_[static_cast<std::size_t>(i)]; }
  int depth(int i) const { return depths_[static_cast<std::size_t>(i)]; }
  /// Of the entries of all rows, the first of row i: itself, its parent, and so on.
  std::size_t start(int i) const { return starts_[static_cast<std::size_t>(i)]; }
  std::size_t entries() const { return count_; }

 private:
  std::vector<int> parents_, depths_;
  std::vector<std::size_t> starts_;
  std::size_t count_ = 0;
};

/// A matrix with entries only between degrees of freedom one of which carries the other, as masses
/// have, and as its factors U D L have: nothing fills in. L has ones on its diagonal and the
/// pattern of the rows here, U that of its mirror image. Memory is reused from matrix to matrix.
class TreeMatrix {
 public:
  /// Sets all to zero. `trees` must stay.
  void reset(const DofTrees& trees, bool is_symmetric) {
    trees_ = &trees;
    lower_.assign(trees.entries(), 0.0);
    upper_.assign(is_symmetric ? 0 : trees.entries(), 0.0);
  }

  int size() const { return trees_->size(); }
  bool is_symmetric() const { return upper_.empty(); }
  /// Forgets what lies above the diagonal.
  void mirror() { upper_.clear(); }

  /// Entry (i, k), k = i or what carries i; and its mirror image, k not i.
  double& operator()(int i, int k) { return lower_[index(i, k)]; }
  double operator()(int i, int k) const { return lower_[index(i, k)]; }
  double& mirrored(int i, int k) { return (is_symmetric() ? lower_ : upper_)[index(i, k)]; }
  double mirrored(int i, int k) const { return (is_symmetric() ? lower_ : upper_)[index(i, k)]; }

  /// Entry (i, i) and those with what carries i, one after another.
  double* row(int i) { return &lower_[trees_->start(i)]; }

  /// In place; the diagonal as inverses.
  void factor() {
    for (int i = 0; i < size(); ++i) {
      const std::size_t row = trees_->start(i);
      const int count = trees_->depth(i);
      const double inverse = 1.0 / lower_[row];
      double* const low = lower_.data() + row + 1;
      double* const up = is_symmetric() ? low : upper_.data() + row + 1;
      int carrier = trees_->parent(i);
      for (int q = 0; q < count; ++q, carrier = trees_->parent(carrier)) {
        const double by = up[q] * inverse;
        double* const to = &lower_[trees_->start(carrier)];
        for (int k = 0; k < count - q; ++k) to[k] -= by * low[q + k];
        if (is_symmetric()) continue;
        const double mirrored_by = low[q] * inverse;
        double* const beside = &upper_[trees_->start(carrier)];
        for (int k = 1; k < count - q; ++k) beside[k] -= mirrored_by * up[q + k];
      }
      lower_[row] = inverse;
      for (int q = 0; q < count; ++q) low[q] *= inverse;
      if (is_symmetric()) continue;
      for (int q = 0; q < count; ++q) up[q] *= inverse;
    }
  }

  // After `factor`.

  /// Inverse of D.
  double inverse_pivot(int i) const { return lower_[trees_->start(i)]; }

  const DofTrees& trees() const { return *trees_; }
  /// The rows of L and the columns of U, where DofTrees has them begin.
  const double* lower() const { return lower_.data(); }
  const double* upper() const { return (is_symmetric() ? lower_ : upper_).data(); }

  /// L'^-1 x, or U^-1 x, of a vector that is zero but at `support`, which has with each number
  /// those that carry it, ascending.
  void carry_lower(std::span<const int> support, double* x) const { carry(lower(), support, x); }
  void carry_upper(std::span<const int> support, double* x) const { carry(upper(), support, x); }

  /// Solves in place.
  void solve(double* x) const {
    const std::vector<double>& up = is_symmetric() ? lower_ : upper_;
    for (int i = 0; i < size(); ++i) {
      const double* entry = &up[trees_->start(i)];
      for (int k = trees_->parent(i); k >= 0; k = trees_->parent(k)) x[k] -= *++entry * x[i];
      x[i] *= inverse_pivot(i);
    }
    for (int i = size() - 1; i >= 0; --i) {
      const double* entry = &lower_[trees_->start(i)];
      double sum = x[i];
      for (int k = trees_->parent(i); k >= 0; k = trees_->parent(k)) sum -= *++entry * x[k];
      x[i] = sum;
    }
  }

  /// Before `factor`: A' x.
  void multiply_transposed(const double* x, double* out) const {
    for (int i = 0; i < size(); ++i) out[i] = lower_[trees_->start(i)] * x[i];
    for (int i = 0; i < size(); ++i) {
      for (int k = trees_->parent(i); k >= 0; k = trees_->parent(k)) {
        out[k] += (*this)(i, k) * x[i];
        out[i] += mirrored(i, k) * x[k];
      }
    }
  }

 private:
  void carry(const double* entries, std::span<const int> support, double* x) const {
    for (const int i : support) {
      const double* entry = entries + trees_->start(i);
      for (int k = trees_->parent(i); k >= 0; k = trees_->parent(k)) x[k] -= *++entry * x[i];
    }
  }
  std::size_t index(int i, int k) const {
    return trees_->start(i) + static_cast<std::size_t>(trees_->depth(i) - trees_->depth(k));
  }

  const DofTrees* trees_ = nullptr;
  std::vector<double> lower_, upper_;
};

}  // namespace volcontact
