// SPDX-License-Identifier: Apache-2.0
#include "volcontact/base/symmetric_eigen.h"

#include <Eigen/Eigenvalues>

namespace volcontact {

SymmetricEigen<Vec3, Mat3> symmetric_eigen(const Mat3& m) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(m);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

SymmetricEigen<Eigen::Vector2d, Eigen::Matrix2d> symmetric_eigen(const Eigen::Matrix2d& m) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(m);
  return {solver.eigenvalues(), solver.eigenvectors()};
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
