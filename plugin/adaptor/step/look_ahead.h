// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

namespace volcontact::adaptor {

/// Completes the rows of MuJoCo's constraints in `d`, with their impedance as of the present state.
/// Under the integrator `discrete` MuJoCo makes it only after the passive callback, of the matrix
/// that it divides by; until then these numbers are of another step, or none. So the step is begun
/// on a copy of the state, once per evaluation and thread. Returns false where the copy has other
/// rows than `d`: nothing is known of them then.
bool complete_constraints(const mjModel* m, mjData* d);

/// Whether the present evaluation is of such a copy, which has no volumetric contact.
bool is_looking_ahead();

/// After an error of MuJoCo's that left a copy unfinished.
void stop_looking_ahead();

}  // namespace volcontact::adaptor
