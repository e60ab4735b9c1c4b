// SPDX-License-Identifier: Apache-2.0
#include "volcontact/force/laws.h"

#include <algorithm>
#include <utility>

namespace volcontact {
namespace {

template <typename Base>
using Entries = std::vector<LawEntry<Base>>;

template <typename Base, typename List>
Entries<Base> entries_of(List list) {
  Entries<Base> entries;
  for_each_type(list, [&](auto tag) {
    entries.push_back(detail::entry_of<typename decltype(tag)::Type, Base>());
  });
  return entries;
}

// Made at the first use, which may be before main().
Entries<NormalForce>& normal_entries() {
  static Entries<NormalForce> entries = entries_of<NormalForce>(NormalLaws{});
  return entries;
}
Entries<Friction>& friction_entries() {
  static Entries<Friction> entries = entries_of<Friction>(FrictionLaws{});
  return entries;
}

template <typename Base>
std::shared_ptr<const Base> make(const char* kind, const Entries<Base>& entries,
                                 std::string_view name, const FieldValues& values,
                                 const ChoiceValues& choices) {
  std::vector<std::string> names;
  for (const LawEntry<Base>& entry : entries) {
    if (entry.row.name == name) return entry.make(values, choices);
    names.push_back(entry.row.name);
  }
  require(false, unknown_word_message(kind, name, names));
  return nullptr;
}

const MaterialRule* rule_in(const std::vector<FieldRow>& fields, const std::string& name) {
  for (const FieldRow& field : fields) {
    if (field.name == name) return field.rule;
  }
  return nullptr;
}

// The rule of the first law that has a field of this name.
const MaterialRule& rule_of(const std::string& name) {
  for (const auto& entry : normal_entries()) {
    if (const MaterialRule* rule = rule_in(entry.row.fields, name)) return *rule;
  }
  for (const auto& entry : friction_entries()) {
    if (const MaterialRule* rule = rule_in(entry.row.fields, name)) return *rule;
  }
  return rules::kLargerOfTwo;
}

template <typename Base>
void add(Entries<Base>& entries, LawEntry<Base> entry) {
  for (const LawEntry<Base>& other : entries) {
    require(other.row.name != entry.row.name,
            "add_law: there is a law '" + entry.row.name + "' already");
  }
  for (FieldRow& field : entry.row.fields) {
    if (!field.rule) field.rule = &rule_of(field.name);
  }
  entries.push_back(std::move(entry));
}

}  // namespace

const Entries<NormalForce>& normal_law_entries() { return normal_entries(); }
const Entries<Friction>& friction_law_entries() { return friction_entries(); }

std::shared_ptr<const NormalForce> make_normal(std::string_view name, const FieldValues& values,
                                               const ChoiceValues& choices) {
  return make("normal law", normal_entries(), name, values, choices);
}

std::shared_ptr<const Friction> make_friction(std::string_view name, const FieldValues& values,
                                              const ChoiceValues& choices) {
  return make("friction law", friction_entries(), name, values, choices);
}

void detail::add_entry(LawEntry<NormalForce> entry) { add(normal_entries(), std::move(entry)); }
void detail::add_entry(LawEntry<Friction> entry) { add(friction_entries(), std::move(entry)); }

}  // namespace volcontact
