// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/pressure/pressure_field.h"

namespace volcontact {

/// Pressure field of an ellipsoid, which carries all of it, with a rigid mesh, whose triangles it
/// presses on: exact but for rules of eight points along analytic pieces. In A's frame; one of the
/// two is an ellipsoid, the other one a mesh. docs/theory.md, "Pressure on triangles".
PressureField pressure_ellipsoid(const Shape& a, const Shape& b, const Pose& X_AB,
                                 const PressureSite& site, PressureScratch& scratch);

}  // namespace volcontact
