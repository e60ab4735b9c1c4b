// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/pair/convex/face_set.h"

namespace volcontact {

/// Angles in which the section of a half-plane through the axis of a ring with the overlap changes
/// its make-up [rad], any order: at corners of the body in the ring, where its edges pierce the
/// ring, and where a plane face touches the disc. The faces are those of the body, in the ring's
/// frame. Into `roots`, where given, go those about which a section grows from next to nothing like
/// the root of the angle: a plane along the axis touches the body there, in a line beside the axis.
void find_torus_breaks(const FaceSet& faces, double major_radius, double minor_radius,
                       std::vector<double>& angles, std::vector<double>* roots = nullptr);

}  // namespace volcontact
