// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/pressure/pressure_field.h"

namespace volcontact {

/// Pressure field of two convex solids with plane faces, exact: the overlap is divided into the
/// cells in which the layer of one face is the softest. In A's frame; `centroid` is that of the
/// overlap.
///
///   int psi dV,   int grad psi dV,   cell by cell, where psi is linear
PressureField pressure_cells(const Box& a, const Box& b, const Pose& X_AB, const Vec3& centroid,
                             double share_of_a, PressureScratch& scratch);
PressureField pressure_cells(const Box& a, const ConvexPolytope& b, const Pose& X_AB,
                             const Vec3& centroid, double share_of_a, PressureScratch& scratch);
PressureField pressure_cells(const ConvexPolytope& a, const Box& b, const Pose& X_AB,
                             const Vec3& centroid, double share_of_a, PressureScratch& scratch);
PressureField pressure_cells(const ConvexPolytope& a, const ConvexPolytope& b, const Pose& X_AB,
                             const Vec3& centroid, double share_of_a, PressureScratch& scratch);

}  // namespace volcontact
