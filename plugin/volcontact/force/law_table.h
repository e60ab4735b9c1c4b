// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "volcontact/base/fields.h"
#include "volcontact/force/law_state.h"
#include "volcontact/force/material_rule.h"

namespace volcontact {

/// A law's table with the law's type taken away: what a reader of files needs of it.
struct FieldRow {
  std::string name;
  std::string unit;
  Range range;
  std::vector<double> defaults;
  const MaterialRule* rule;  ///< never null in the entries of force/laws.h
};
struct ChoiceRow {
  std::string name;
  std::vector<std::string> words;
};
struct LawRow {
  std::string name;
  std::vector<FieldRow> fields;
  std::vector<ChoiceRow> choices;
  int largest_state = 0;  ///< numbers that the law keeps of a contact site at most

  const FieldRow* field(std::string_view field_name) const { return find(fields, field_name); }
  const ChoiceRow* choice(std::string_view choice_name) const { return find(choices, choice_name); }

 private:
  template <typename Row>
  static const Row* find(const std::vector<Row>& rows, std::string_view row_name) {
    for (const Row& row : rows) {
      if (row.name == row_name) return &row;
    }
    return nullptr;
  }
};

template <typename Law>
LawRow row_of() {
  const typename Law::Params params{};
  LawRow row{Law::kName, {}, {}, 0};
  for (const auto& field : Law::kFields) {
    FieldRow entry{field.name, field.unit, field.range, {}, field.rule};
    for (int i = 0; i < field.size(); ++i) entry.defaults.push_back(field.get(params, i));
    row.fields.push_back(entry);
  }
  if constexpr (kHasChoices<Law>) {
    for (const auto& choice : Law::kChoices) {
      row.choices.push_back({choice.name, {choice.words.begin(), choice.words.end()}});
    }
  }
  if constexpr (requires { Law::kStates; }) row.largest_state = size_of(Law::kStates);
  return row;
}

}  // namespace volcontact
