// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/window/solid_view.h"
#include "volcontact/shape/polytope/cut_polytope.h"

namespace volcontact {

/// Where two solids can overlap: a frame W whose axes fit the overlap, with its origin in the
/// middle.
struct OverlapWindow {
  bool apart = false;  ///< the solids certainly share no volume
  Pose X_AW;
  Pose X_BW;
};

/// Finds the window of A and B, and leaves in `hull_W` a polytope that certainly holds the overlap.
/// Starts from the bounds and cuts off, for convex solids, the corners that stick out of either one
/// by supporting planes; any supporting plane is a valid bound, so no part of the overlap is
/// missed. At least one solid must be bounded. docs/theory.md, "Octree".
OverlapWindow find_window(const SolidView& a, const SolidView& b, const Pose& X_AB,
                          CutPolytope& hull_W, CutPolytope& scratch);

}  // namespace volcontact
