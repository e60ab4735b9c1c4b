// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bindings.h"
#include "fields.h"
#include "volcontact/force/elastic_layer.h"
#include "volcontact/force/laws.h"

namespace volcontact::python {
namespace {

namespace nb = nanobind;

template <typename Law, typename Base>
void bind_law(nb::module_& m, const char* what) {
  const std::string doc = std::string(what) + " '" + Law::kName + "'." + describe_fields<Law>() +
                          describe_states<Law>();
  nb::class_<Law, Base> type(m, camel_case(Law::kName).c_str(), doc.c_str());
  detail::def_law_init<Law, Base>(type, std::make_index_sequence<Law::kFields.size()>{},
                                  std::make_index_sequence<detail::choice_count<Law>()>{});
  def_properties<Law>(type);
}

// Keywords of Python as the fields and choices of a law: words, numbers, or some numbers.
template <typename Base>
std::shared_ptr<const Base> make_by_name(std::shared_ptr<const Base> (*make)(std::string_view,
                                                                             const FieldValues&,
                                                                             const ChoiceValues&),
                                         const std::string& name, const nb::kwargs& parameters) {
  FieldValues values;
  ChoiceValues choices;
  for (const auto [key, value] : parameters) {
    const std::string field = nb::cast<std::string>(key);
    if (nb::isinstance<nb::str>(value)) {
      choices[field] = nb::cast<std::string>(value);
    } else if (nb::isinstance<nb::sequence>(value)) {
      values[field] = nb::cast<std::vector<double>>(value);
    } else {
      values[field] = {nb::cast<double>(value)};
    }
  }
  return make(name, values, choices);
}

void bind_makers(nb::module_& m) {
  m.def(
      "make_normal",
      [](const std::string& name, const nb::kwargs& parameters) {
        return make_by_name<NormalForce>(&make_normal, name, parameters);
      },
      nb::arg("name"), nb::arg("parameters"),
      nb::sig("def make_normal(name: str, **parameters: float | str) -> NormalForce"),
      "The normal law called `name`, as in MJCF keys, with its parameters as keywords: also one "
      "that was built in by VOLCONTACT_LAWS");
  m.def(
      "make_friction",
      [](const std::string& name, const nb::kwargs& parameters) {
        return make_by_name<Friction>(&make_friction, name, parameters);
      },
      nb::arg("name"), nb::arg("parameters"),
      nb::sig("def make_friction(name: str, **parameters: float | str) -> Friction"),
      "The same for friction laws");
}

void bind_units(nb::module_& m) {
  m.def(
      "units_of_law_fields",
      [] {
        std::map<std::string, std::string> units;
        const auto add = [&](const auto& entries) {
          for (const auto& entry : entries) {
            for (const FieldRow& field : entry.row.fields) units.emplace(field.name, field.unit);
          }
        };
        add(normal_law_entries());
        add(friction_law_entries());
        return units;
      },
      "Unit of each parameter of the laws by its name, such as N/m^3");
}

void bind_layers(nb::module_& m) {
  m.def(
      "layer_stiffness",
      [](double modulus, double thickness, std::optional<double> poisson_ratio) {
        return poisson_ratio ? confined_layer_stiffness(modulus, thickness, *poisson_ratio)
                             : layer_stiffness(modulus, thickness);
      },
      nb::kw_only(), nb::arg("modulus"), nb::arg("thickness"),
      nb::arg("poisson_ratio") = nb::none(),
      R"(Stiffness of an elastic layer on a rigid core.

Args:
    modulus [Pa]: Young's modulus E
    thickness [m]: H
    poisson_ratio [-]: nu of a layer that cannot bulge sideways; left out, it can

Returns:
    E / H, or (1 - nu) E / ((1 + nu) (1 - 2 nu) H) [N/m^3])");
  m.def("series_stiffness", &series_stiffness, nb::arg("stiffness_a"), nb::arg("stiffness_b"),
        "k_v [N/m^3] of two layers in series");
  m.def("series_damping", &series_damping, nb::arg("stiffness_a"), nb::arg("damping_a"),
        nb::arg("stiffness_b"), nb::arg("damping_b"),
        "a [s/m] of two layers in series, each with its own against a rigid body");
  m.def("series_restitution", &series_restitution, nb::arg("stiffness_a"), nb::arg("restitution_a"),
        nb::arg("stiffness_b"), nb::arg("restitution_b"),
        "e [-] of two layers in series, each with its own against a rigid body");
}

}  // namespace

void bind_laws(nb::module_& m) {
  nb::class_<NormalForce>(m, "NormalForce", "Base of all normal laws.")
      .def_prop_ro("name", &NormalForce::name, "As in MJCF keys")
      .def_prop_ro("state_size", &NormalForce::state_size, "Doubles of state per contact site");
  nb::class_<Friction>(m, "Friction", "Base of all friction laws.")
      .def_prop_ro("name", &Friction::name, "As in MJCF keys")
      .def_prop_ro("state_size", &Friction::state_size, "Doubles of state per contact site");
  for_each_type(NormalLaws{}, [&](auto tag) {
    bind_law<typename decltype(tag)::Type, NormalForce>(m, "Normal law");
  });
  for_each_type(FrictionLaws{}, [&](auto tag) {
    bind_law<typename decltype(tag)::Type, Friction>(m, "Friction law");
  });
  bind_makers(m);
  bind_units(m);
  bind_layers(m);
}

}  // namespace volcontact::python
