// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/pair/convex/face_set.h"

namespace volcontact {

/// Angles in which the section of a half-plane through the axis of a ring with the overlap changes
/// its make-up [rad], any order: at corners of the body in the ring, where its edges pierce the
/// ring, and where a plane face touches the disc. The faces are those of the body, in the ring's
/// frame.
void find_torus_breaks(const FaceSet& faces, double major_radius, double minor_radius,
                       std::vector<double>& angles);

}  // namespace volcontact
