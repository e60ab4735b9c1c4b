// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <vector>

#include "adaptor/memory/userdata_layout.h"

// Programs set mjData.time: to count from 0 again, to follow a clock of their own. The motion goes
// on as it was, and so does what contact keeps of it. Where they set another state with the time,
// what was kept is of no use. The two are told apart by the motion itself.

namespace volcontact::adaptor {

/// Where the time in `d` is no continuation of the evaluations in `block` and the positions are,
/// those evaluations are moved to the new time. Call it before open_slot(). `difference`: memory
/// that is reused.
void follow_clock(const mjModel* m, const mjData* d, const UserdataBlock& block,
                  std::vector<double>& difference);

/// Keeps positions and velocities of this evaluation for the next call of follow_clock(); zeros for
/// what is no number.
void keep_motion(const mjModel* m, const mjData* d, const UserdataBlock& block);

}  // namespace volcontact::adaptor
