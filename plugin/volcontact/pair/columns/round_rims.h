// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/pair/columns/round_pieces.h"

namespace volcontact {

/// Splits triangles inside of the solid where the lines down from them meet the rim of its plane
/// face k: there the length of the lines has a kink.
void split_at_rim(const RoundSolid& solid, int k, const Vec3& up,
                  const std::vector<RoundPieces::Triangle>& triangles,
                  std::vector<RoundPieces::Triangle>& parts);

}  // namespace volcontact
