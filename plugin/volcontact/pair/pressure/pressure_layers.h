// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/pressure/pressure_field.h"

namespace volcontact {

/// Pressure field of a pair of which at least one solid has parallel solids, by the volumes that
/// the solids under the layers have in common: int psi dV = int V(t) dt, with V(t) the overlap
/// where psi > t. Any engine serves, whatever it is that the other solid is. A solid without
/// parallel solids is rigid, and the other one carries the whole field. The wrench is the gradient
/// of the sum, not only of the integral. In A's frame; docs/theory.md, "Layers".
PressureField pressure_layers(const Shape& a, const Shape& b, const Pose& X_AB,
                              const PressureSite& site, PressureScratch& scratch);

}  // namespace volcontact
