// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "volcontact/base/scene_run.h"

namespace volcontact::fmu {

/// Loads the adaptor and the MuJoCo of a scene unit, which lie beside this binary under names that
/// no other library has, so that other copies may be in the process. They stay loaded: units that
/// have the same ones share them. Throws std::invalid_argument naming the file.
const SceneRunFunctions& load_scene_library(const std::string& adaptor, const std::string& mujoco);

}  // namespace volcontact::fmu
