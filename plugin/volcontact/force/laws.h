// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "volcontact/base/type_list.h"
#include "volcontact/force/bristle.h"
#include "volcontact/force/elastic_coulomb.h"
#include "volcontact/force/hunt_crossley.h"
#include "volcontact/force/law_table.h"
#include "volcontact/force/regularized_coulomb.h"
#include "volcontact/force/volume_spring.h"

namespace volcontact {

/// Every law of the library. A new one is added here and nowhere else; the first is the default.
/// Laws of a user's own program are added by add_law().
using NormalLaws = TypeList<HuntCrossley, VolumeSpring>;
using FrictionLaws = TypeList<ElasticCoulomb, RegularizedCoulomb, Bristle>;

/// A law with its table and the way to make one.
template <typename Base>
struct LawEntry {
  LawRow row;
  std::shared_ptr<const Base> (*make)(const FieldValues&, const ChoiceValues&);
};

/// All laws, those of the lists first, then those added.
const std::vector<LawEntry<NormalForce>>& normal_law_entries();
const std::vector<LawEntry<Friction>>& friction_law_entries();

/// A law from its name, parameters and choices. Throws std::invalid_argument on an unknown name,
/// unknown parameter or value out of range.
std::shared_ptr<const NormalForce> make_normal(std::string_view name, const FieldValues& values,
                                               const ChoiceValues& choices = {});
std::shared_ptr<const Friction> make_friction(std::string_view name, const FieldValues& values,
                                              const ChoiceValues& choices = {});

namespace detail {
void add_entry(LawEntry<NormalForce> entry);
void add_entry(LawEntry<Friction> entry);

template <typename Law, typename Base>
LawEntry<Base> entry_of() {
  return {
      row_of<Law>(),
      [](const FieldValues& values, const ChoiceValues& choices) -> std::shared_ptr<const Base> {
        auto params = params_from<Law>(values);
        set_choices<Law>(params, choices);
        return std::make_shared<const Law>(params);
      }};
}
}  // namespace detail

/// Adds a law of the user's own, with `kName`, `Params`, `kFields` and a constructor from Params,
/// so that it is found by its name: in MJCF keys, by make_normal() and make_friction(). To be
/// called before the first scene is read, as by a static variable; plugin/cmake/VolcontactAddLaw
/// .cmake does it. Throws std::invalid_argument where the name is taken. Returns true.
template <typename Law>
bool add_law() {
  using Base = std::conditional_t<std::is_base_of_v<NormalForce, Law>, NormalForce, Friction>;
  static_assert(std::is_base_of_v<Base, Law>, "a law derives from NormalForce or from Friction");
  detail::add_entry(detail::entry_of<Law, Base>());
  return true;
}

}  // namespace volcontact
