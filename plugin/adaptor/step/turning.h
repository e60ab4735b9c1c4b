// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adaptor/mujoco/mujoco_compat.h"
#include "volcontact/base/types.h"

namespace volcontact::adaptor {

/// Acceleration of a point of a body that no force makes: with all generalized velocities kept up,
/// as a step keeps those it ends with, the point moves by h v + h^2/2 of it [m/s^2]. Zero for what
/// moves along a line. Reads what MuJoCo has once velocities are known (cvel, cdof_dot).
Vec3 turning_acceleration(const mjModel* m, const mjData* d, int body, const Vec3& point);

}  // namespace volcontact::adaptor
