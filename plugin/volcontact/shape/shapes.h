// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "volcontact/base/type_list.h"
#include "volcontact/shape/box.h"
#include "volcontact/shape/capsule.h"
#include "volcontact/shape/convex_polytope.h"
#include "volcontact/shape/cylinder.h"
#include "volcontact/shape/ellipsoid.h"
#include "volcontact/shape/frustum.h"
#include "volcontact/shape/half_space.h"
#include "volcontact/shape/sphere.h"
#include "volcontact/shape/torus.h"

namespace volcontact {

/// Every shape there is. A new one is added here and nowhere else.
using Shapes =
    TypeList<HalfSpace, Sphere, Ellipsoid, Capsule, Cylinder, Frustum, Box, Torus, ConvexPolytope>;

/// One solid of any shape, in its own frame.
using Shape = Shapes::Variant;

inline const char* name_of(const Shape& shape) {
  return std::visit([](const auto& solid) { return solid.kName; }, shape);
}
inline Aabb bounds_of(const Shape& shape) {
  return std::visit([](const auto& solid) { return solid.bounds(); }, shape);
}
inline VolumeMetrics own_metrics_of(const Shape& shape) {
  return std::visit([](const auto& solid) { return solid.own_metrics(); }, shape);
}

/// A shape from its name and parameters. Throws std::invalid_argument on an unknown name, unknown
/// parameter or value out of range. Convex polytopes are made from vertices, not from numbers.
Shape make_shape(std::string_view name, const FieldValues& values);

}  // namespace volcontact
