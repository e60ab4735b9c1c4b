// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include "adaptor/evaluation/scratch.h"
#include "adaptor/scene/scene_contact.h"

namespace volcontact::adaptor {

/// Adds the contact sites of the last evaluation to a drawing, as MuJoCo adds its own contacts:
/// with mjVIS_CONTACTPOINT a disc of the area of each patch, with mjVIS_CONTACTFORCE an arrow for
/// the force on the second geom, scaled by the model's `vis.map.force`. Draws as many as there is
/// room for.
void draw_sites(const SceneContact& contact, const mjModel* m, const mjData* d,
                const mjvOption* option, mjvScene* scene, EvaluationScratch& scratch);

}  // namespace volcontact::adaptor
