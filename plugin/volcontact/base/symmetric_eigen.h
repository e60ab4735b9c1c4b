// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/base/types.h"

namespace volcontact {

/// Of a symmetric matrix: eigenvalues, rising, and unit eigenvectors, one a column.
template <int N>
struct SymmetricEigen {
  Vector<N> values;
  Matrix<N, N> vectors;
};

/// To rounding, by Jacobi's rotations. [Golub and Van Loan, Matrix Computations, 8.5]
SymmetricEigen<3> symmetric_eigen(const Mat3& m);
SymmetricEigen<2> symmetric_eigen(const Mat2& m);

}  // namespace volcontact
