// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/eigen/dense.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>

#include <optional>

#include "volcontact/base/types.h"

namespace volcontact::python {

using Matrix4 = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Pose from a 4x4 matrix, the identity when none is given. Throws std::invalid_argument naming the
/// argument when it is not finite, not a rotation or has another last row.
Pose pose_from(const std::optional<Matrix4>& matrix, const char* name);

/// Twist from (angular [rad/s], linear [m/s]), zero when none is given.
Twist twist_from(const std::optional<Vector6>& vector, const char* name);

}  // namespace volcontact::python
