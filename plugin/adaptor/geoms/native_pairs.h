// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <string>
#include <vector>

// What volumetric contact takes of a <contact><pair> of the model: its sliding friction.

namespace volcontact::adaptor {

/// "<pair> 'name'", or its number where it has none.
std::string native_pair_label(const mjModel* m, int pair);

/// Fields of a <pair> that say something its two geoms do not, and that have no meaning under
/// volumetric contact: "condim", "solref" and so on. MuJoCo fills in what the file leaves out from
/// the geoms, so what two geoms could make of their own numbers is not named.
std::vector<std::string> native_pair_fields_unused(const mjModel* m, int pair);

}  // namespace volcontact::adaptor
