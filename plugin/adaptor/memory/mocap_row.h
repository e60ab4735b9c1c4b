// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "volcontact/base/types.h"

namespace volcontact::adaptor {

/// What is kept of each mocap body at an evaluation: its pose, its twist, and the wrench of all
/// contacts on it and on what hangs on it, about its origin.
struct MocapRow {
  static constexpr int kNumbers = 7 + 6 + 6;
  double* p;

  Eigen::Map<Eigen::Matrix<double, 7, 1>> pose() const {
    return Eigen::Map<Eigen::Matrix<double, 7, 1>>(p);
  }
  Eigen::Map<Vec3> angular() const { return Eigen::Map<Vec3>(p + 7); }
  Eigen::Map<Vec3> linear() const { return Eigen::Map<Vec3>(p + 10); }
  Eigen::Map<Vec3> force() const { return Eigen::Map<Vec3>(p + 13); }
  Eigen::Map<Vec3> torque() const { return Eigen::Map<Vec3>(p + 16); }
};

}  // namespace volcontact::adaptor
