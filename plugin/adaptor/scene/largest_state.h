// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstddef>

namespace volcontact::adaptor {

/// Contact sites for which a scene keeps numbers: as many as a crowded scene has, not as many as
/// there could be, since every copy of mjData takes them along.
inline int rows_for(std::size_t pairs, std::size_t geoms) {
  constexpr std::size_t kPerPair = 16, kPerGeom = 6, kBase = 32;
  return static_cast<int>(std::min(kPerPair * pairs, kBase + kPerGeom * geoms));
}

/// Numbers that the state of a model needs at most, whatever its keys say: MuJoCo asks an engine
/// plugin while it compiles, before they are there.
int largest_state(const mjModel* m);

}  // namespace volcontact::adaptor
