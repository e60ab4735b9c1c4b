// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"
#include "fields.h"
#include "volcontact/force/laws.h"

namespace volcontact::python {
namespace {

namespace nb = nanobind;

template <typename Law, typename Base>
void bind_law(nb::module_& m, const char* what) {
  const std::string doc = std::string(what) + " '" + Law::kName + "'." + describe_fields<Law>();
  nb::class_<Law, Base> type(m, camel_case(Law::kName).c_str(), doc.c_str());
  detail::def_law_init<Law, Base>(type, std::make_index_sequence<Law::kFields.size()>{},
                                  std::make_index_sequence<detail::choice_count<Law>()>{});
  def_properties<Law>(type);
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
}

}  // namespace volcontact::python
