// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/reference/reference_solid.h"
#include "core/support/random.h"

namespace volcontact::test {

/// Volume of an overlap from the lengths of evenly spread lines in random directions. Each set of
/// lines is a lattice with a shift and a direction of its own, so that the sets are independent and
/// none favours a region: what the adaptive reference_integral may overlook counts here by its
/// share.
struct LatticeVolume {
  double volume = 0.0;  ///< mean of the sets [m^3]
  double error = 0.0;   ///< five standard errors of that mean [m^3]
};

/// Overlap of A and B at X_AB within `box`, a box in A's frame. `lines` per set.
LatticeVolume lattice_volume(const ReferenceSolid& a, const ReferenceSolid& b, const Pose& X_AB,
                             const Aabb& box, int lines, Random& random);

}  // namespace volcontact::test
