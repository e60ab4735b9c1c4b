// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/octree_scratch.h"

namespace volcontact {

/// Leaves of one site: from `first` to before `last` in scratch.leaves.
struct LeafRange {
  int first = 0;
  int last = 0;
  bool all = true;  ///< there is no other site
};

/// int L^2/2 dA along the normal n, by columns from the leaves' surfaces; `first_side` (1 or -1)
/// tells from which side, in terms of n, to try first. `volume` is what the columns must add up to.
double depth_moment(const OctreeTask& task, OctreeScratch& scratch, LeafRange leaves, const Vec3& n,
                    double first_side, double volume);

/// Largest height e . x of the overlap over the origin of W.
double farthest(const OctreeTask& task, OctreeScratch& scratch, LeafRange leaves, const Vec3& e);

}  // namespace volcontact
