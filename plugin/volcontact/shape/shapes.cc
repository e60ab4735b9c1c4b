// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/shapes.h"

#include <optional>

namespace volcontact {

Shape make_shape(std::string_view name, const FieldValues& values) {
  std::optional<Shape> made;
  std::vector<std::string> names;
  for_each_type(Shapes{}, [&](auto tag) {
    using S = typename decltype(tag)::Type;
    if constexpr (requires { S::kFields; }) {
      names.emplace_back(S::kName);
      if (name == S::kName) made = S(params_from<S>(values));
    }
  });
  require(made.has_value(),
          "unknown shape '" + std::string(name) + "'" + did_you_mean(name, names));
  return *made;
}

}  // namespace volcontact
