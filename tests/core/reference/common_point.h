// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/reference/reference_solid.h"

namespace volcontact::test {

/// A point within both where there is one: false when none is, or for tori. Both are terms, within
/// `range` of the origin. The volume that can be missed is 1e-12 of the range's cube.
bool find_common_point(const ReferenceSolid& a, const ReferenceSolid& b, double range, Vec3& x);

}  // namespace volcontact::test
