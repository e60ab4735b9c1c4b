// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/shape/shapes.h"

namespace volcontact {

/// Whether the points of a solid that lie deeper than d below its surface are, for every d, a solid
/// of the same kind: balls, capsules, cylinders, frusta, boxes, rounded or not, and tori.
bool has_parallel_solids(const Shape& solid);

/// Whether a composed solid has them: when all its members do, or are half-spaces. Members that are
/// taken away grow; in a union each member keeps its own depth, and no depth passes where they
/// meet. Making one allocates.
bool has_composed_parallels(const Shape& solid);

/// The greatest depth below the surface of such a solid, of a composed one a bound [m]; infinite
/// for any other.
double greatest_depth(const Shape& solid);

/// The part of a solid with parallel solids, of either kind, that is deeper than `depth` [m] below
/// its surface, as `inner` with its pose in the solid's frame. False when nothing is left.
/// Allocates nothing when `inner` is of the solid's kind already.
bool parallel_solid(const Shape& solid, double depth, Shape& inner, Pose& X_SI);

/// Area of the surface of such a solid [m^2]: what its volume falls by, per depth. Zero for a
/// composed one, whose own surface is not known.
double surface_area(const Shape& solid);

}  // namespace volcontact
