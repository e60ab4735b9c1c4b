// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/pressure/pressure_field.h"

namespace volcontact {

/// Pressure field of a mesh and a solid that has no layers of its own kind: a mesh, a composed
/// solid or a user's one. That solid carries all of it: its signed distance presses on the
/// triangles of the mesh, which are divided until they agree with their quarters. Of two meshes the
/// one with the larger share carries, of equal shares the smaller one. Milliseconds; `error` says
/// how far off the force may be. In A's frame; docs/theory.md, "Pressure on triangles".
PressureField pressure_meshes(const Shape& a, const Shape& b, const Pose& X_AB,
                              const PressureSite& site, PressureScratch& scratch);

}  // namespace volcontact
