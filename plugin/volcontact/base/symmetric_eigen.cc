// SPDX-License-Identifier: Apache-2.0
#include "volcontact/base/symmetric_eigen.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace volcontact {

SymmetricEigen<Vec3, Mat3> symmetric_eigen(const Mat3& m) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(m);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

// As the solver's own compute(), to the same bits; but it does not look for the reflections that
// make the matrix tridiagonal, which one of two rows is: they took half of the time to compile this
// file.
SymmetricEigen<Eigen::Vector2d, Eigen::Matrix2d> symmetric_eigen(const Eigen::Matrix2d& m) {
  using Solver = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>;
  const double beside = m(1, 0);
  double scale = std::max({std::abs(m(0, 0)), std::abs(beside), std::abs(m(1, 1))});
  if (scale == 0.0) scale = 1.0;
  Solver solver;
  solver.computeFromTridiagonal(Eigen::Vector2d(m(0, 0) / scale, m(1, 1) / scale),
                                Solver::SubDiagonalType::Constant(beside / scale));
  return {scale * solver.eigenvalues(), solver.eigenvectors()};
}

Vec3 direct_eigenvalues(const Mat3& m) {
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  return solver.computeDirect(m, Eigen::EigenvaluesOnly).eigenvalues();
}

Mat3 direct_eigenvectors(const Mat3& m) {
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  return solver.computeDirect(m).eigenvectors();
}

}  // namespace volcontact
