// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/shape/csg/csg.h"

namespace volcontact {

/// Parts of the line o + t d inside the solid, in order, as intervals of t. Replaces what is in
/// `spans`.
void csg_line(const Csg& solid, const Vec3& o, const Vec3& d, std::vector<RayInterval>& spans);

}  // namespace volcontact
