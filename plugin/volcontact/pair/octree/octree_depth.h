// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/octree/octree_scratch.h"

namespace volcontact {

/// Leaves of one site: from `first` to before `last` in scratch.leaves.
struct LeafRange {
  int first = 0;
  int last = 0;
  bool all = true;  ///< there is no other site
};

/// Columns along the normal n, from the leaves' surfaces: int L^2/2 dA and the longest L. From
/// which side to try first, in terms of n, `first_side` (1 or -1) tells. `volume`, known to
/// `volume_error`, is what they must add up to.
OctreeScratch::ColumnSum sum_columns(const OctreeTask& task, OctreeScratch& scratch,
                                     LeafRange leaves, const Vec3& n, double first_side,
                                     double volume, double volume_error);

/// Largest height e . x of the overlap over the origin of W; `inside` is a place within it.
double farthest(const OctreeTask& task, OctreeScratch& scratch, LeafRange leaves,
                const Vec3& inside, const Vec3& e);

}  // namespace volcontact
