// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/model/contact_model.h"

namespace volcontact {

using Mat12 = Matrix<12, 12>;

/// How the wrenches on both bodies change with their motion, in the world frame. Rows: torque and
/// force on A about A's origin, then those on B about B's. Columns: turn [rad] and displacement [m]
/// of A's frame, then of B's, or their speeds. At fixed states; the patch is taken as flat
/// (docs/theory.md, "Stiffness of a site"), and friction from differences of its law alone.
struct ContactTangent {
  Mat12 by_motion = Mat12::Zero();  ///< dW/dx
  Mat12 by_speed = Mat12::Zero();   ///< dW/dv
};

/// Of a report that keeps its inputs, by the model that made it. What the laws keep is as before.
ContactTangent contact_tangent(const ContactModel& model, ContactReport& report);

}  // namespace volcontact
