// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/pair/convex/face_set.h"

namespace volcontact {

/// Where a ring stands out of a wall, as angles about its axis [rad].
struct TorusExit {
  double low, high;  ///< the disc of the ring reaches through the wall between them
  bool all;          ///< it lies beyond the wall as a whole, somewhere between them
  double middle() const { return 0.5 * (low + high); }
  double width() const { return high - low; }
};

/// Finds where a ring of these radii, about the z axis, stands out of the faces of a body it lies
/// in, through planes and round faces each by itself: so narrow an exit that half-planes all round
/// the ring miss it may still be wide for a thin ring. The faces are those of the body, in the
/// ring's frame; of the planes those that the ring reaches. docs/theory.md, "Tori".
void find_torus_exits(const FaceSet& faces, double major_radius, double minor_radius,
                      std::vector<TorusExit>& exits);

}  // namespace volcontact
