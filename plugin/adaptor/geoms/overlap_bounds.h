// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/window/solid_view.h"

namespace volcontact::adaptor {

/// Bounds in F of what a bounded convex solid at X_FS has in common with a box whose axes are those
/// of F. They certainly hold it, and are exact where one face of the box cuts the solid.
Aabb overlap_bounds(const SolidView& solid, const Pose& X_FS, const Aabb& box);
/// The same at a fraction of the cost.
Aabb overlap_bounds(const Box& solid, const Pose& X_FS, const Aabb& box);

}  // namespace volcontact::adaptor
