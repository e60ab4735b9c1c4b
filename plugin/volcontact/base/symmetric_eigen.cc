// SPDX-License-Identifier: Apache-2.0
#include "volcontact/base/symmetric_eigen.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace volcontact {
namespace {

template <int N>
class Jacobi {
 public:
  explicit Jacobi(const Matrix<N, N>& m) : m_(m) {}

  SymmetricEigen<N> run() {
    constexpr int kSweeps = 16;  // far more than doubles need
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      bool turned = false;
      for (int p = 0; p < N - 1; ++p) {
        for (int q = p + 1; q < N; ++q) turned = turn(p, q) || turned;
      }
      if (!turned) break;
    }
    return sorted();
  }

 private:
  // The rotation in the plane of two axes that makes their entry 0. False where it is, but for
  // rounding.
  bool turn(int p, int q) {
    const double beside = m_(p, q);
    const double size = std::sqrt(std::abs(m_(p, p))) * std::sqrt(std::abs(m_(q, q)));
    if (!(std::abs(beside) > std::numeric_limits<double>::epsilon() * size)) return false;
    const double theta = (m_(q, q) - m_(p, p)) / (2.0 * beside);
    const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
    const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
    for (int k = 0; k < N; ++k) {
      if (k == p || k == q) continue;
      const double at_p = m_(k, p), at_q = m_(k, q);
      m_(k, p) = m_(p, k) = c * at_p - s * at_q;
      m_(k, q) = m_(q, k) = s * at_p + c * at_q;
    }
    m_(p, p) -= t * beside;
    m_(q, q) += t * beside;
    m_(p, q) = m_(q, p) = 0.0;
    const Vector<N> along_p = vectors_.col(p), along_q = vectors_.col(q);
    vectors_.col(p) = c * along_p - s * along_q;
    vectors_.col(q) = s * along_p + c * along_q;
    return true;
  }

  SymmetricEigen<N> sorted() {
    SymmetricEigen<N> out{m_.diagonal(), vectors_};
    for (int i = 1; i < N; ++i) {
      for (int k = i; k > 0 && out.values[k] < out.values[k - 1]; --k) {
        std::swap(out.values[k], out.values[k - 1]);
        std::swap(out.vectors.col(k), out.vectors.col(k - 1));
      }
    }
    return out;
  }

  Matrix<N, N> m_, vectors_ = Matrix<N, N>::Identity();
};

}  // namespace

SymmetricEigen<3> symmetric_eigen(const Mat3& m) { return Jacobi<3>(m).run(); }
SymmetricEigen<2> symmetric_eigen(const Mat2& m) { return Jacobi<2>(m).run(); }

}  // namespace volcontact
