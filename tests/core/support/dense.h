// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "volcontact/base/matrix.h"

namespace volcontact::test {

// For small matrices of any size. Eigen's own products and solvers of these, which are made for
// large ones, take seconds to compile in every file.

/// A vector or matrix of ours in Eigen's types.
template <int N>
Eigen::Matrix<double, N, 1> eigen(const Vector<N>& v) {
  return Eigen::Map<const Eigen::Matrix<double, N, 1>>(v.data());
}
template <int R, int C>
Eigen::Matrix<double, R, C> eigen(const Matrix<R, C>& m) {
  Eigen::Matrix<double, R, C> out;
  m.to(out.data());
  return out;
}

/// A B.
inline Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.lazyProduct(b);
}

/// A A'.
inline Eigen::MatrixXd square(const Eigen::MatrixXd& a) { return product(a, a.transpose()); }

/// X of A X = B, by Gauss's elimination with the largest pivot of each column.
inline Eigen::MatrixXd solution(Eigen::MatrixXd a, Eigen::MatrixXd b) {
  const Eigen::Index n = a.rows();
  for (Eigen::Index k = 0; k < n; ++k) {
    Eigen::Index pivot = k;
    for (Eigen::Index i = k + 1; i < n; ++i) {
      if (std::abs(a(i, k)) > std::abs(a(pivot, k))) pivot = i;
    }
    a.row(k).swap(a.row(pivot));
    b.row(k).swap(b.row(pivot));
    for (Eigen::Index i = k + 1; i < n; ++i) {
      const double by = a(i, k) / a(k, k);
      a.row(i) -= by * a.row(k);
      b.row(i) -= by * b.row(k);
    }
  }
  for (Eigen::Index k = n; k-- > 0;) {
    b.row(k) /= a(k, k);
    for (Eigen::Index i = 0; i < k; ++i) b.row(i) -= a(i, k) * b.row(k);
  }
  return b;
}

}  // namespace volcontact::test
