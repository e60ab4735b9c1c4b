// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/search/contact_poses.h"
#include "volcontact/pair/interference.h"

namespace volcontact::test {

/// What is wrong with an answer by itself, in a few words; null when nothing is. Finite numbers, a
/// volume between that of a ball known to lie in both solids and that of the smaller solid, sites
/// that add up, a centroid and second moments that a body can have, an area vector no longer than
/// the areas on either side (the surface of an overlap is closed). `inside` is a point near the
/// overlap, in A.
const char* fault_of(const Interference& answer, const Example& a, const Example& b,
                     const Pose& X_AB, const Vec3& inside);

/// What two answers for A with B and B with A disagree in. `smooth`: no shared faces, so that the
/// area vectors can be compared as well.
const char* disagreement_of(const VolumeMetrics& in_A, const VolumeMetrics& in_B, const Pose& X_AB,
                            double smaller_body, bool exact, bool smooth);

}  // namespace volcontact::test
