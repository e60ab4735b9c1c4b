// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "volcontact/base/types.h"

namespace volcontact::cell_math {

/// Polytope face number of tangent 0; the cell's sides have those below.
inline constexpr int kFirstFace = 6;
/// Share of |slope|; where a bent face rises less than that there is no use in following it.
inline constexpr double kSteepEnough = 0.05;

/// The cell's sides as the box graph numbers them: -z, +z, -y, +y, -x, +x.
inline int cell_side(int axis, bool high) { return 2 * (2 - axis) + (high ? 1 : 0); }
inline Vec3 cell_side_normal(int side) {
  return (side & 1 ? 1.0 : -1.0) * Vec3::Unit(2 - side / 2);
}

}  // namespace volcontact::cell_math
