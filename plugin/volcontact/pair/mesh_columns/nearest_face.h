// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/mesh_columns/column_cells.h"

namespace volcontact {

/// What the bounds of A reach of a convex solid.
enum class FaceReach { kApart, kPart, kWhole };

/// The face of a convex solid B under which the bounds of A, posed in B, reach least: kPart with
/// its prism and its pose X_BC, kWhole when they lie below all of it. `margin` [m] is what rounding
/// may misplace.
FaceReach nearest_face(const Aabb& a, const SurfaceView& b, const Pose& X_BA, double margin,
                       ColumnPrism& prism, Pose& X_BC);

}  // namespace volcontact
