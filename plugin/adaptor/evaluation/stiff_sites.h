// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adaptor/evaluation/scratch.h"
#include "adaptor/scene/scene_contact.h"
#include "volcontact/step/explicit_bounds.h"

namespace volcontact::adaptor {

/// Whether an explicit step could not hold the site: by its friction, or by h^2 k/m of its patch
/// against displacements and turns, with the mass that MuJoCo knows of each body at its first pose.
bool is_stiff(const mjModel* m, mjData* d, const PairContact& pair, ContactReport& report,
              std::size_t site, ExplicitBounds most, EvaluationScratch& scratch);

/// Marks the stiff sites of all pairs in `scratch.stiff`; whether there are some.
bool find_stiff_sites(const SceneContact& contact, const mjModel* m, mjData* d,
                      EvaluationScratch& scratch);

}  // namespace volcontact::adaptor
