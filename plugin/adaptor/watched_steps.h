// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adaptor/volcontact_mujoco.h"

namespace volcontact::adaptor {

/// Steps a scene, attached or not, until `watch` says that its trial ends, at most `most` times.
/// Returns the steps done. Contact is looked at as the step had it, at the state it began with.
int step_watched(const mjModel* m, mjData* d, int most, volcontact_watch& watch);

/// A number of the scene as it is now; those of the contact sites as `watch` last felt them, NaN
/// without.
double read_number(const mjModel* m, const mjData* d, const volcontact_number& number,
                   const volcontact_watch* watch) noexcept;

}  // namespace volcontact::adaptor
