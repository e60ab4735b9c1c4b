// SPDX-License-Identifier: Apache-2.0
#include "arrays.h"

#include <sstream>
#include <string>

#include "volcontact/base/check.h"

namespace volcontact::python {

Pose pose_from(const std::optional<Matrix4>& matrix, const char* name) {
  if (!matrix) return {};
  constexpr double kOrthonormal = 1e-6;  // single precision input is welcome
  const Matrix4& m = *matrix;
  require(m.allFinite(), std::string(name) + ": the pose has a number that is not finite");
  const Pose pose{m.block<3, 3>(0, 0), m.col(3).head<3>()};
  const double skewed = (pose.rotation.transpose() * pose.rotation - Mat3::Identity()).norm();
  if (skewed > kOrthonormal || pose.rotation.determinant() < 0.0) {
    std::ostringstream message;
    message << name << ": the upper left 3x3 block is no rotation (determinant "
            << pose.rotation.determinant() << ", |R^T R - 1| = " << skewed << ", allowed "
            << kOrthonormal << ")";
    throw std::invalid_argument(message.str());
  }
  require(m.row(3) == Vector<4>::Unit(3),
          std::string(name) + ": the last row of a pose must be 0 0 0 1");
  return pose;
}

Twist twist_from(const std::optional<Vector6>& vector, const char* name) {
  if (!vector) return {};
  require(vector->allFinite(), std::string(name) + ": the twist has a number that is not finite");
  return {vector->head<3>(), vector->tail<3>()};
}

}  // namespace volcontact::python
