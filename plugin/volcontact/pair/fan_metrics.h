// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/metrics/volume_metrics.h"
#include "volcontact/pair/fan.h"

namespace volcontact {

/// The sums of a fan in A's axes, about the center of its frame. The area vector is taken from the
/// solid whose faces give it best: plane ones and the wall of a bore.
MomentSum moments_of(const Fan& fan, const FaceSet& faces, const FanFrame& frame);

}  // namespace volcontact
