// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "volcontact/shape/csg/csg.h"
#include "volcontact/shape/mesh/mesh.h"
#include "volcontact/shape/signed_distance.h"
#include "volcontact/shape/simple_shapes.h"

namespace volcontact {

/// Every shape there is. A new one is added to the simple shapes and nowhere else.
using Shapes = SimpleShapes::With<Csg, SignedDistance, Mesh>;

/// One solid of any shape, in its own frame.
using Shape = Shapes::Variant;

const char* name_of(const Shape& shape);
Aabb bounds_of(const Shape& shape);
VolumeMetrics own_metrics_of(const Shape& shape);

/// A shape from its name and parameters. Throws std::invalid_argument on an unknown name, unknown
/// parameter or value out of range. Convex polytopes and meshes are made from vertices, not from
/// numbers, and composed solids from solids.
Shape make_shape(std::string_view name, const FieldValues& values);

/// The shape as a composed solid: itself, or a solid of one member. Throws std::invalid_argument on
/// a signed distance and on a mesh.
Csg composed(const Shape& shape);

}  // namespace volcontact
