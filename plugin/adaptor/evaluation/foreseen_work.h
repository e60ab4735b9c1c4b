// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adaptor/evaluation/scratch.h"
#include "adaptor/scene/scene_contact.h"

namespace volcontact::adaptor {

/// All that acts on the degrees of freedom beside contacts and native constraints, into
/// `scratch.known`: made once an evaluation.
void know_forces(const SceneContact& contact, const mjModel* m, mjData* d,
                 EvaluationScratch& scratch);

/// Marks in `scratch.stiff` the pairs whose explicit forces would do more work over the step than
/// the pair may, by the motion that all forces together make of it: where a servo or a limb turns
/// the slip round, friction pushes. Pairs of bodies that fly alone, which nobody pushes, are looked
/// at only where they may give back more than they hold. Returns whether there is any.
bool foresee_work(const SceneContact& contact, const mjModel* m, mjData* d,
                  EvaluationScratch& scratch);

}  // namespace volcontact::adaptor
