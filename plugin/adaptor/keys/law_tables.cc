// SPDX-License-Identifier: Apache-2.0
#include "adaptor/keys/law_tables.h"

#include <algorithm>

#include "volcontact/force/laws.h"

namespace volcontact::adaptor {
namespace {

template <typename Row>
const Row* find(const std::vector<Row>& rows, std::string_view name) {
  const auto found =
      std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return row.name == name; });
  return found == rows.end() ? nullptr : &*found;
}

template <typename Base>
std::vector<LawRow> rows_of(const std::vector<LawEntry<Base>>& entries) {
  std::vector<LawRow> rows;
  for (const LawEntry<Base>& entry : entries) rows.push_back(entry.row);
  return rows;
}

std::vector<std::string> names_of(const std::vector<LawRow>& laws) {
  std::vector<std::string> names;
  for (const LawRow& law : laws) names.push_back(law.name);
  return names;
}

std::vector<ChoiceRow> collect_choices() {
  std::vector<ChoiceRow> rows{{kNormalLaw, names_of(normal_laws())},
                              {kFrictionLaw, names_of(friction_laws())},
                              {kRolling, {"on", kOff}}};
  for (const auto* laws : {&normal_laws(), &friction_laws()}) {
    for (const LawRow& law : *laws) {
      for (const ChoiceRow& choice : law.choices) {
        if (!find(rows, choice.name)) rows.push_back(choice);
      }
    }
  }
  return rows;
}

}  // namespace

const std::vector<LawRow>& normal_laws() {
  static const std::vector<LawRow> rows = rows_of(normal_law_entries());
  return rows;
}

const std::vector<LawRow>& friction_laws() {
  static const std::vector<LawRow> rows = rows_of(friction_law_entries());
  return rows;
}

const LawRow& law_called(const std::vector<LawRow>& laws, std::string_view name) {
  const LawRow* law = find(laws, name);
  require(law != nullptr, unknown_word_message("law", name, names_of(laws)));
  return *law;
}

const FieldRow* field_of_any_law(std::string_view name) {
  for (const auto* laws : {&normal_laws(), &friction_laws()}) {
    for (const LawRow& law : *laws) {
      if (const FieldRow* field = law.field(name)) return field;
    }
  }
  return nullptr;
}

std::vector<std::string> all_field_names() {
  std::vector<std::string> names;
  for (const auto* laws : {&normal_laws(), &friction_laws()}) {
    for (const LawRow& law : *laws) {
      for (const FieldRow& field : law.fields) {
        if (std::find(names.begin(), names.end(), field.name) == names.end()) {
          names.push_back(field.name);
        }
      }
    }
  }
  return names;
}

const std::vector<ChoiceRow>& all_choices() {
  static const std::vector<ChoiceRow> rows = collect_choices();
  return rows;
}

}  // namespace volcontact::adaptor
