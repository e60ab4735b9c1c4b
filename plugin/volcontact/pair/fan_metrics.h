// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/metrics/volume_metrics.h"
#include "volcontact/pair/fan.h"
#include "volcontact/pair/lines_region.h"

namespace volcontact {

/// The sums of a fan in A's axes, about the center of its frame. The area vector is taken from the
/// solid whose faces give it best: plane ones and the wall of a bore.
MomentSum moments_of(const Fan& fan, const FaceSet& faces, const FanFrame& frame);

/// Which share of the push on the owner of a bore comes from its wall, from 0 to 1.
double share_of_bore(const Fan& fan, const FaceSet& faces, const FanFrame& frame);

/// The parts of the surface that lie in plane faces, in A's frame.
void add_patches(const Fan& fan, const FaceSet& faces, const FanFrame& frame,
                 std::vector<LinesRegion::PlanePatch>& patches);

}  // namespace volcontact
