// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "volcontact/base/types.h"

namespace volcontact {

/// The lower triangular L with L L' = m, of a symmetric matrix that may be semidefinite: a column
/// without a positive pivot is 0.
inline Mat3 cholesky(Mat3 m) {
  Mat3 out = Mat3::Zero();
  for (int k = 0; k < 3; ++k) {
    if (!(m(k, k) > 0.0)) continue;
    const double pivot = std::sqrt(m(k, k));
    out(k, k) = pivot;
    for (int i = k + 1; i < 3; ++i) out(i, k) = m(i, k) / pivot;
    for (int j = k + 1; j < 3; ++j) {
      for (int i = j; i < 3; ++i) m(i, j) -= out(i, k) * out(j, k);
    }
  }
  return out;
}

}  // namespace volcontact
