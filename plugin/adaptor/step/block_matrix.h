// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <cstddef>
#include <vector>

namespace volcontact::adaptor {

/// A square matrix of full blocks of K x K numbers, factored into L D U by blocks, without exchange
/// of rows: for the unit matrix plus one whose symmetric part is positive semidefinite. Memory is
/// reused from matrix to matrix.
template <int K>
class BlockMatrix {
 public:
  using Block = Eigen::Matrix<double, K, K>;
  using Vector = Eigen::Matrix<double, K, 1>;

  /// Of `count` blocks a side, with any values.
  void reset(int count, bool is_symmetric) {
    count_ = count;
    is_symmetric_ = is_symmetric;
    const std::size_t size = static_cast<std::size_t>(count) * static_cast<std::size_t>(count);
    blocks_.resize(size);
    scaled_.resize(size);
  }

  /// Block (i, k); of a symmetric matrix with k <= i.
  Block& operator()(int i, int k) { return blocks_[index(i, k)]; }

  /// In place. Below the diagonal L D, on it the inverse of D, above it U'; L apart.
  void factor() {
    for (int k = 0; k < count_; ++k) {
      for (int before = 0; before < k; ++before) {
        at(k, k).noalias() -= at(k, before) * upper(before, k).transpose();
      }
      const Block inverse = at(k, k).inverse();
      at(k, k) = inverse;
      for (int i = k + 1; i < count_; ++i) {
        Block& below = at(i, k);
        for (int before = 0; before < k; ++before) {
          below.noalias() -= at(i, before) * upper(before, k).transpose();
        }
        scaled_[index(i, k)].noalias() = below * inverse;
        if (is_symmetric_) continue;
        Block beside = at(k, i);
        for (int before = 0; before < k; ++before) {
          beside.noalias() -= at(k, before) * upper(before, i).transpose();
        }
        at(k, i).noalias() = (inverse * beside).transpose();
      }
    }
  }

  /// After `factor`: solves for one right side, K numbers a block, in place.
  void solve(double* x) const {
    for (int i = 0; i < count_; ++i) {
      for (int k = 0; k < i; ++k) of(x, i).noalias() -= scaled_[index(i, k)] * of(x, k);
    }
    for (int i = 0; i < count_; ++i) of(x, i) = (blocks_[index(i, i)] * of(x, i)).eval();
    for (int i = count_ - 1; i > 0; --i) {
      for (int k = 0; k < i; ++k) of(x, k).noalias() -= upper(k, i).transpose() * of(x, i);
    }
  }

 private:
  static Eigen::Map<Vector> of(double* x, int i) { return Eigen::Map<Vector>(x + K * i); }
  Block& at(int i, int k) { return blocks_[index(i, k)]; }
  // The transpose of block (k, i) of U, k < i.
  const Block& upper(int k, int i) const {
    return is_symmetric_ ? scaled_[index(i, k)] : blocks_[index(k, i)];
  }
  std::size_t index(int i, int k) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(count_) +
           static_cast<std::size_t>(k);
  }

  int count_ = 0;
  bool is_symmetric_ = true;
  std::vector<Block> blocks_, scaled_;
};

}  // namespace volcontact::adaptor
