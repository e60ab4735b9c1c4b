// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adaptor/evaluation/scratch.h"
#include "adaptor/scene/scene_contact.h"

namespace volcontact::adaptor {

/// The sites that the evaluation before left, of which `committed` is null when there was none.
struct SitesBefore {
  const double* committed = nullptr;
  double elapsed = 0.0;
  bool keeps_inputs = false;
};

/// Finds the pairs that are near and evaluates them at the poses and velocities in `d`, into
/// `scratch.reports`, by as many threads as are worth it: the same bits by any number.
void evaluate_pairs(const SceneContact& contact, const mjModel* m, const mjData* d,
                    const SitesBefore& before, EvaluationScratch& scratch);

}  // namespace volcontact::adaptor
