// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adaptor/evaluation/scratch.h"
#include "adaptor/scene/scene_contact.h"

// The forces of a solved step cannot be had from positions and velocities alone. They are kept: for
// whoever reads them, and for the later stages of a Runge-Kutta step, in which they go on to act as
// they are, so that the work they do is the one that was solved for.

namespace volcontact::adaptor {

/// Keeps the forces of the pairs that other forces act on than their laws say.
void keep_solved(const SceneContact& contact, const UserdataBlock& our,
                 const EvaluationScratch& scratch);

/// Puts what was kept into the reports of its pairs.
void recall_solved(const UserdataBlock& our, EvaluationScratch& scratch);

/// The same at a later stage of Runge-Kutta, and marks what that cannot hold in `scratch.stiff`.
void hold_solved(const mjModel* m, mjData* d, const UserdataBlock& our, EvaluationScratch& scratch);

/// What a later stage of Runge-Kutta cannot hold, and was not solved when the step began, waits
/// for the next.
void postpone_stiff(EvaluationScratch& scratch);

/// Adds what was kept to the forces on the bodies.
void add_held(const SceneContact& contact, const mjModel* m, const mjData* d,
              const UserdataBlock& our, BodyForces& forces);

}  // namespace volcontact::adaptor
