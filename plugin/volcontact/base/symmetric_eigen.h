// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/base/types.h"

namespace volcontact {

/// Of a symmetric matrix: eigenvalues, rising, and unit eigenvectors, one a column.
template <typename Vector, typename Matrix>
struct SymmetricEigen {
  Vector values;
  Matrix vectors;
};

// Eigen's solvers, compiled once: each file that has one takes seconds longer to compile.

/// By iteration, to rounding.
SymmetricEigen<Vec3, Mat3> symmetric_eigen(const Mat3& m);
SymmetricEigen<Eigen::Vector2d, Eigen::Matrix2d> symmetric_eigen(const Eigen::Matrix2d& m);

/// By the roots of the cubic: quicker, half the digits where two eigenvalues are nearly the same.
Vec3 direct_eigenvalues(const Mat3& m);
Mat3 direct_eigenvectors(const Mat3& m);

}  // namespace volcontact
