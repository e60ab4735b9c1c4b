// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "volcontact/base/check.h"
#include "volcontact/base/spelling.h"
#include "volcontact/base/types.h"

namespace volcontact {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Allowed values of a field: an interval, open or closed at each end. Infinite values and NaN are
/// never allowed.
struct Range {
  double low;
  double high;
  bool low_open;
  bool high_open;
  const char* text;  ///< how a message spells it, e.g. "> 0"

  constexpr bool contains(double x) const {
    if (!(x - x == 0.0)) return false;  // not finite
    return (low_open ? x > low : x >= low) && (high_open ? x < high : x <= high);
  }
};

inline constexpr Range kPositive{0.0, kInfinity, true, true, "> 0"};
inline constexpr Range kNonNegative{0.0, kInfinity, false, true, ">= 0"};
inline constexpr Range kAnyNumber{-kInfinity, kInfinity, true, true, "any finite number"};
inline constexpr Range kZeroToOne{0.0, 1.0, false, false, "0 to 1"};

struct MaterialRule;

/// One row of a component's table: the parameter's name, unit, member, range and meaning, and for a
/// law how a pair finds it from its materials (force/material_rule.h). From this table come
/// validation, MJCF keys, Python keywords and the reference page. A field is one number or a
/// 3-vector.
template <typename Params>
struct Field {
  const char* name;
  const char* unit;  ///< SI, "-" for none
  double Params::* scalar = nullptr;
  Vec3 Params::* vector = nullptr;
  Range range;
  const char* meaning;
  const MaterialRule* rule = nullptr;

  constexpr Field(const char* field_name, const char* field_unit, double Params::* member,
                  Range allowed, const char* text, const MaterialRule* of_materials = nullptr)
      : name(field_name),
        unit(field_unit),
        scalar(member),
        range(allowed),
        meaning(text),
        rule(of_materials) {}
  constexpr Field(const char* field_name, const char* field_unit, Vec3 Params::* member,
                  Range allowed, const char* text)
      : name(field_name), unit(field_unit), vector(member), range(allowed), meaning(text) {}

  constexpr int size() const { return scalar ? 1 : 3; }
  /// The numbers of the parameter.
  auto* of(auto& params) const { return scalar ? &(params.*scalar) : (params.*vector).data(); }
  double get(const Params& params, int i = 0) const { return of(params)[i]; }
  void set(Params& params, int i, double value) const { of(params)[i] = value; }
};

/// A parameter that is a choice among words, held in an enum whose values count from 0 in the order
/// of `words`. A component with choices lists them in `kChoices`.
template <typename Params, typename Enum, std::size_t kCount>
struct Choice {
  const char* name;
  Enum Params::* member;
  std::array<const char*, kCount> words;
  const char* meaning;
};

/// Parameter values by name, as a file or a keyword call gives them.
using FieldValues = std::map<std::string, std::vector<double>, std::less<>>;
using ChoiceValues = std::map<std::string, std::string, std::less<>>;

/// "hunt_crossley: stiffness = -1 [N/m^3] is out of range: must be > 0".
std::string out_of_range_message(std::string_view component, std::string_view field,
                                 std::string_view unit, double value, const Range& range);
/// "box has no field 'half_size' (did you mean 'half_sizes'?)".
std::string unknown_field_message(std::string_view component, std::string_view field,
                                  const std::vector<std::string>& fields);
/// "box: half_sizes takes 3 numbers, got 2".
std::string wrong_size_message(std::string_view component, std::string_view field, int wanted,
                               std::size_t got);

// A component is any class with `kName`, `Params` and `kFields` (a std::array of Field<Params>).

template <typename Component>
inline constexpr bool kHasChoices = requires { Component::kChoices; };

template <typename Component>
std::vector<std::string> field_names() {
  std::vector<std::string> names;
  for (const auto& field : Component::kFields) names.emplace_back(field.name);
  return names;
}

/// Pointer to the field called `name`, or null.
template <typename Component>
const Field<typename Component::Params>* find_field(std::string_view name) {
  for (const auto& field : Component::kFields) {
    if (name == field.name) return &field;
  }
  return nullptr;
}

/// Returns `params` unchanged, or throws std::invalid_argument naming component, field, unit, value
/// and allowed range.
template <typename Component>
typename Component::Params validated(const typename Component::Params& params) {
  for (const auto& field : Component::kFields) {
    for (int i = 0; i < field.size(); ++i) {
      const double value = field.get(params, i);
      if (field.range.contains(value)) continue;  // and no message made: solids change in steps
      require(false,
              out_of_range_message(Component::kName, field.name, field.unit, value, field.range));
    }
  }
  return params;
}

/// Parameters by name; what is not named keeps its default. Throws std::invalid_argument on an
/// unknown name (with the nearest valid spelling), a wrong count and a value out of range.
template <typename Component>
typename Component::Params params_from(const FieldValues& values) {
  typename Component::Params params{};
  for (const auto& [name, numbers] : values) {
    const auto* field = find_field<Component>(name);
    if (field == nullptr) {
      throw std::invalid_argument(
          unknown_field_message(Component::kName, name, field_names<Component>()));
    }
    if (static_cast<int>(numbers.size()) != field->size()) {
      throw std::invalid_argument(
          wrong_size_message(Component::kName, name, field->size(), numbers.size()));
    }
    for (int i = 0; i < field->size(); ++i) field->set(params, i, numbers[i]);
  }
  return validated<Component>(params);
}

/// "unknown coupling 'elipsoid': one of ellipsoid, none (did you mean 'ellipsoid'?)".
std::string unknown_word_message(std::string_view what, std::string_view word,
                                 const std::vector<std::string>& words);

/// Sets the component's choices by name. Throws std::invalid_argument on an unknown choice or word.
template <typename Component>
void set_choices(typename Component::Params& params, const ChoiceValues& values) {
  for (const auto& [name, word] : values) {
    bool known_name = false;
    if constexpr (kHasChoices<Component>) {
      for (const auto& choice : Component::kChoices) {
        if (name != choice.name) continue;
        known_name = true;
        std::vector<std::string> words(choice.words.begin(), choice.words.end());
        const auto found = std::find(words.begin(), words.end(), word);
        require(found != words.end(),
                std::string(Component::kName) + ": " + unknown_word_message(name, word, words));
        using Enum = std::remove_reference_t<decltype(params.*(choice.member))>;
        params.*(choice.member) = static_cast<Enum>(found - words.begin());
      }
    }
    require(known_name, std::string(Component::kName) + " has no choice '" + name + "'");
  }
}

/// The inverse of params_from: every field by name.
template <typename Component>
FieldValues values_of(const typename Component::Params& params) {
  FieldValues values;
  for (const auto& field : Component::kFields) {
    auto& numbers = values[field.name];
    for (int i = 0; i < field.size(); ++i) numbers.push_back(field.get(params, i));
  }
  return values;
}

}  // namespace volcontact
