// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

namespace volcontact::adaptor {

/// The present step as MuJoCo will begin it, without volumetric contact. Under the integrator
/// `discrete` MuJoCo makes the matrix that it divides by, and the impedance of its constraints of
/// that, only after the passive callback; so the step is begun on a copy of the state. Null where
/// nothing is made later, and with other integrators. Good until the next call of this thread.
const mjData* look_ahead(const mjModel* m, const mjData* d);

/// Completes the rows of MuJoCo's constraints in `d`, with their impedance as of the present state;
/// until then these numbers are of another step, or none. Returns false where the copy has other
/// rows than `d`: nothing is known of them then.
bool complete_constraints(mjData* d, const mjData* ahead);

/// Whether the present evaluation is of such a copy, which has no volumetric contact.
bool is_looking_ahead();

/// After an error of MuJoCo's that left a copy unfinished.
void stop_looking_ahead();

}  // namespace volcontact::adaptor
