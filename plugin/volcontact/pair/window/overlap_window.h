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

/// The greatest height e . x of the overlap of two convex solids, both in W, from their window and
/// its hull: to 1e-5 of the height over `inside_W`, a place within both. Kelley's cutting planes,
/// each laid where the way from that place to the hull's highest corner leaves a solid, as in A. F.
/// Veinott, "The supporting hyperplane method for unimodal programming", 1967.
double overlap_height(const SolidView& a, const SolidView& b, const OverlapWindow& window,
                      const CutPolytope& hull_W, const Vec3& inside_W, const Vec3& e,
                      CutPolytope& scratch);

}  // namespace volcontact
