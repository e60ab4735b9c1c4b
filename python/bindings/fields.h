// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>

#include <array>
#include <cctype>
#include <string>
#include <utility>

#include "volcontact/base/fields.h"

namespace volcontact::python {

namespace nb = nanobind;

/// "hunt_crossley" -> "HuntCrossley": the Python class name follows from the component's name.
inline std::string camel_case(std::string_view name) {
  std::string camel;
  bool upper = true;
  for (const char c : name) {
    if (c == '_') {
      upper = true;
    } else {
      camel += upper ? static_cast<char>(std::toupper(c)) : c;
      upper = false;
    }
  }
  return camel;
}

/// One line a field: name, unit, meaning, allowed range.
template <typename Component>
std::string describe_fields() {
  std::string text;
  if constexpr (requires { Component::kFields; }) {
    for (const auto& field : Component::kFields) {
      text += std::string("\n    ") + field.name + " [" + field.unit + "]: " + field.meaning +
              (field.size() == 3 ? ", shape (3,)" : "") + "; " + field.range.text;
    }
  }
  if constexpr (kHasChoices<Component>) {
    for (const auto& choice : Component::kChoices) {
      text += std::string("\n    ") + choice.name + ": " + choice.meaning + "; one of";
      for (const char* word : choice.words) text += std::string(" '") + word + "'";
    }
  }
  return text.empty() ? text : "\n\nArgs:" + text;
}

/// One line a state that a law keeps for each contact site: name, unit, meaning.
template <typename Law>
std::string describe_states() {
  std::string text;
  if constexpr (requires { Law::kStates; }) {
    for (const auto& state : Law::kStates) {
      text += std::string("\n    ") + state.name + " [" + state.unit + "]: " + state.meaning +
              (state.size() == 3 ? ", shape (3,)" : "");
    }
  }
  return text.empty() ? text : "\n\nKeeps, for each contact site:" + text;
}

namespace detail {

template <typename Component, std::size_t I>
using FieldType = std::conditional_t<Component::kFields[I].scalar != nullptr, double,
                                     std::array<double, 3>>;  // a tuple will do

template <typename Component, std::size_t I>
void assign(typename Component::Params& params, const FieldType<Component, I>& value) {
  constexpr auto& field = Component::kFields[I];
  if constexpr (field.scalar != nullptr) {
    params.*(field.scalar) = value;
  } else {
    params.*(field.vector) = Vec3(value[0], value[1], value[2]);
  }
}

template <typename Component, std::size_t I>
auto value_of(const typename Component::Params& params) {
  constexpr auto& field = Component::kFields[I];
  if constexpr (field.scalar != nullptr) {
    return params.*(field.scalar);
  } else {
    return Vec3(params.*(field.vector));
  }
}

template <typename Component, std::size_t I>
const char* word_of(const typename Component::Params& params) {
  const auto& choice = Component::kChoices[I];
  return choice.words[static_cast<std::size_t>(params.*(choice.member))];
}

template <std::size_t>
using Word = const std::string&;

template <typename Component>
constexpr std::size_t choice_count() {
  if constexpr (kHasChoices<Component>) {
    return Component::kChoices.size();
  } else {
    return 0;
  }
}

// Shapes: positional or keyword, nothing optional.
template <typename Component, std::size_t... I>
void def_shape_init(nb::class_<Component>& type, std::index_sequence<I...>) {
  type.def(
      "__init__",
      [](Component* self, FieldType<Component, I>... values) {
        typename Component::Params params{};
        (assign<Component, I>(params, values), ...);
        new (self) Component(params);
      },
      nb::arg(Component::kFields[I].name)...);
}

// Laws: keywords only, every field with its default.
template <typename Component, typename Base, std::size_t... I, std::size_t... C>
void def_law_init(nb::class_<Component, Base>& type, std::index_sequence<I...>,
                  std::index_sequence<C...>) {
  const typename Component::Params defaults{};
  type.def(
      "__init__",
      [](Component* self, FieldType<Component, I>... values, Word<C>... words) {
        typename Component::Params params{};
        (assign<Component, I>(params, values), ...);
        ChoiceValues choices;
        ((choices[Component::kChoices[C].name] = words), ...);
        set_choices<Component>(params, choices);
        new (self) Component(params);
      },
      nb::kw_only(), (nb::arg(Component::kFields[I].name) = value_of<Component, I>(defaults))...,
      (nb::arg(Component::kChoices[C].name) = word_of<Component, C>(defaults))...);
}

}  // namespace detail

/// Read-only properties for every field (and choice) of the component's table.
template <typename Component, typename Class>
void def_properties(Class& type) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (type.def_prop_ro(
         Component::kFields[I].name,
         [](const Component& self) { return detail::value_of<Component, I>(self.params()); },
         (std::string(Component::kFields[I].meaning) + " [" + Component::kFields[I].unit + "]")
             .c_str()),
     ...);
  }(std::make_index_sequence<Component::kFields.size()>{});
  if constexpr (kHasChoices<Component>) {
    [&]<std::size_t... C>(std::index_sequence<C...>) {
      (type.def_prop_ro(
           Component::kChoices[C].name,
           [](const Component& self) { return detail::word_of<Component, C>(self.params()); },
           Component::kChoices[C].meaning),
       ...);
    }(std::make_index_sequence<detail::choice_count<Component>()>{});
  }
}

}  // namespace volcontact::python
