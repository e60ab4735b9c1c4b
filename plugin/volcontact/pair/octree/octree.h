// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/octree/octree_scratch.h"
#include "volcontact/pair/overlap.h"
#include "volcontact/pair/window/solid_view.h"
#include "volcontact/shape/shapes.h"

namespace volcontact {

/// Interference of A and B by recursive cells, for any two solids of which at least one is bounded:
/// metrics in A's frame about A's origin. `options.tolerance` is met by the certified bound of V
/// (Status::kApproximate when the budget of cells ends first). docs/theory.md, "Octree".
void octree_interference(const Shape& a, const Shape& b, const Pose& X_AB,
                         const InterferenceOptions& options, OctreeScratch& scratch,
                         Interference& out);

/// The same for solids of any type: octree_interference(view_of(solid), ...).
void octree_interference(const SolidView& a, const SolidView& b, const Pose& X_AB,
                         const InterferenceOptions& options, OctreeScratch& scratch,
                         Interference& out);

}  // namespace volcontact
