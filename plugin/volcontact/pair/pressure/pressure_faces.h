// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/pressure/pressure_field.h"

namespace volcontact {

/// Pressure field of a convex polytope, which carries all of it, with any rigid solid: the overlap
/// of the other one with the cell of each face, exact as far as its engine is. In A's frame. One
/// of the two is a polytope; of two the first one carries. docs/theory.md, "Cells of faces".
PressureField pressure_faces(const Shape& a, const Shape& b, const Pose& X_AB,
                             const PressureSite& site, PressureScratch& scratch);

}  // namespace volcontact
