// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "volcontact/force/law_table.h"

namespace volcontact::adaptor {

/// The laws of the lists in force/laws.h, in their order, and those a program added: the first is
/// the default. As they are when first asked for.
const std::vector<LawRow>& normal_laws();
const std::vector<LawRow>& friction_laws();

/// The law called `name`. Throws std::invalid_argument when there is none.
const LawRow& law_called(const std::vector<LawRow>& laws, std::string_view name);

/// Field of any law, the first that has it; null when none has.
const FieldRow* field_of_any_law(std::string_view name);

/// Every field name of every law, once.
std::vector<std::string> all_field_names();

/// Every choice a material can make: normal_law, friction_law, rolling, and the laws' own.
const std::vector<ChoiceRow>& all_choices();

inline constexpr const char* kNormalLaw = "normal_law";
inline constexpr const char* kFrictionLaw = "friction_law";
inline constexpr const char* kRolling = "rolling";
inline constexpr const char* kOff = "off";

}  // namespace volcontact::adaptor
