// SPDX-License-Identifier: Apache-2.0
#include "adaptor/law_tables.h"

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

template <typename Law>
LawRow row_of() {
  const typename Law::Params params{};
  LawRow row{Law::kName, {}, {}};
  for (const auto& field : Law::kFields) {
    FieldRow entry{field.name, field.unit, field.range, {}};
    for (int i = 0; i < field.size(); ++i) entry.defaults.push_back(field.get(params, i));
    row.fields.push_back(entry);
  }
  if constexpr (kHasChoices<Law>) {
    for (const auto& choice : Law::kChoices) {
      row.choices.push_back({choice.name, {choice.words.begin(), choice.words.end()}});
    }
  }
  return row;
}

template <typename List>
std::vector<LawRow> rows_of(List list) {
  std::vector<LawRow> rows;
  for_each_type(list, [&](auto tag) { rows.push_back(row_of<typename decltype(tag)::Type>()); });
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

const FieldRow* LawRow::field(std::string_view field_name) const {
  return find(fields, field_name);
}

const ChoiceRow* LawRow::choice(std::string_view choice_name) const {
  return find(choices, choice_name);
}

const std::vector<LawRow>& normal_laws() {
  static const std::vector<LawRow> rows = rows_of(NormalLaws{});
  return rows;
}

const std::vector<LawRow>& friction_laws() {
  static const std::vector<LawRow> rows = rows_of(FrictionLaws{});
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
