// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "fmu/unit.h"

namespace volcontact::fmu {

/// A whole scene: MuJoCo with volumetric contact inside, Co-Simulation only. A communication step
/// is a number of time steps. Throws std::invalid_argument.
std::unique_ptr<Unit> make_scene_unit(const std::string& resources);

}  // namespace volcontact::fmu
