// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adaptor/evaluation/scratch.h"
#include "adaptor/scene/scene_contact.h"

namespace volcontact::adaptor {

/// What the passive callback does: evaluates all pairs at the poses and velocities in `d` and
/// writes the forces to the target. The same result however often it is called at one time.
void apply_contact(const SceneContact& contact, const mjModel* m, mjData* d,
                   EvaluationScratch& scratch);

/// Takes our part out of the force array of the target.
void release_contact(const SceneContact& contact, const mjModel* m, mjData* d) noexcept;

}  // namespace volcontact::adaptor
