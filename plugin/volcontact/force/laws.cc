// SPDX-License-Identifier: Apache-2.0
#include "volcontact/force/laws.h"

namespace volcontact {
namespace {

template <typename Base, typename List>
std::shared_ptr<const Base> make(const char* kind, std::string_view name, const FieldValues& values,
                                 const ChoiceValues& choices) {
  std::shared_ptr<const Base> made;
  std::vector<std::string> names;
  for_each_type(List{}, [&](auto tag) {
    using Law = typename decltype(tag)::Type;
    names.emplace_back(Law::kName);
    if (name != Law::kName) return;
    auto params = params_from<Law>(values);
    set_choices<Law>(params, choices);
    made = std::make_shared<const Law>(params);
  });
  require(made != nullptr, unknown_word_message(kind, name, names));
  return made;
}

}  // namespace

std::shared_ptr<const NormalForce> make_normal(std::string_view name, const FieldValues& values,
                                               const ChoiceValues& choices) {
  return make<NormalForce, NormalLaws>("normal law", name, values, choices);
}

std::shared_ptr<const Friction> make_friction(std::string_view name, const FieldValues& values,
                                              const ChoiceValues& choices) {
  return make<Friction, FrictionLaws>("friction law", name, values, choices);
}

}  // namespace volcontact
