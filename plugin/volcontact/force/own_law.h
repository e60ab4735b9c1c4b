// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "volcontact/base/fields.h"
#include "volcontact/force/friction.h"
#include "volcontact/force/material_rule.h"
#include "volcontact/force/normal_force.h"

namespace volcontact {

/// What every law has in common, taken from its tables: derive from OwnNormalLaw<Law> or
/// OwnFrictionLaw<Law>, with `kName`, `Params`, `kFields`, where something is kept `kStates`, and
/// `evaluate`. docs/own_laws.md has one of ten lines.
template <typename Law, typename Base>
class OwnLaw : public Base {
 public:
  const char* name() const noexcept override { return Law::kName; }
  std::span<const StateField> states() const noexcept override {
    if constexpr (requires { Law::kStates; }) {
      return Law::kStates;
    } else {
      return {};
    }
  }
};

template <typename Law>
using OwnNormalLaw = OwnLaw<Law, NormalForce>;
template <typename Law>
using OwnFrictionLaw = OwnLaw<Law, Friction>;

}  // namespace volcontact
