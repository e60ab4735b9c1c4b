// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/shapes.h"

#include <optional>
#include <stdexcept>
#include <type_traits>

namespace volcontact {

const char* name_of(const Shape& shape) {
  return std::visit([](const auto& solid) { return solid.kName; }, shape);
}

Aabb bounds_of(const Shape& shape) {
  return std::visit([](const auto& solid) { return solid.bounds(); }, shape);
}

VolumeMetrics own_metrics_of(const Shape& shape) {
  return std::visit([](const auto& solid) { return solid.own_metrics(); }, shape);
}

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

Csg composed(const Shape& shape) {
  return std::visit(
      [](const auto& solid) -> Csg {
        using Solid = std::decay_t<decltype(solid)>;
        if constexpr (std::is_same_v<Solid, Csg>) {
          return solid;
        } else if constexpr (std::is_same_v<Solid, SignedDistance>) {
          throw std::invalid_argument(
              "a solid with a signed distance cannot be composed: combine the distances instead, "
              "min(a, b), max(a, b) or max(a, -b)");
        } else if constexpr (std::is_same_v<Solid, Mesh>) {
          throw std::invalid_argument(
              "a mesh cannot be composed: cut or join the triangles themselves, for example with "
              "manifold3d or trimesh, and make a mesh of the result");
        } else {
          return Csg(solid);
        }
      },
      shape);
}

}  // namespace volcontact
