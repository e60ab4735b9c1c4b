// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "volcontact/base/type_list.h"
#include "volcontact/force/bristle.h"
#include "volcontact/force/hunt_crossley.h"
#include "volcontact/force/regularized_coulomb.h"
#include "volcontact/force/volume_spring.h"

namespace volcontact {

/// Every law there is. A new one is added here and nowhere else; the first is the default.
using NormalLaws = TypeList<HuntCrossley, VolumeSpring>;
using FrictionLaws = TypeList<RegularizedCoulomb, Bristle>;

/// A law from its name, parameters and choices. Throws std::invalid_argument on an unknown name,
/// unknown parameter or value out of range.
std::shared_ptr<const NormalForce> make_normal(std::string_view name, const FieldValues& values,
                                               const ChoiceValues& choices = {});
std::shared_ptr<const Friction> make_friction(std::string_view name, const FieldValues& values,
                                              const ChoiceValues& choices = {});

}  // namespace volcontact
