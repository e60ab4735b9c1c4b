// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/pair/mesh_columns/in_round/round_pieces.h"

namespace volcontact {

/// What triangles count too much, as they end at a chord in place of the image of a rim: between
/// the two they take the length of lines that go on to the other face.
struct RimExcess {
  Vec3 middle;  ///< of the lines
  double volume;
  double length;  ///< of the lines
  double doubt;   ///< of the volume
};

/// Splits triangles inside of the solid where the lines down from them meet the rim of its plane
/// face k: there the length of the lines has a kink. Appends to `excess`.
void split_at_rim(const RoundSolid& solid, int k, const Vec3& up,
                  const std::vector<RoundPieces::Triangle>& triangles,
                  std::vector<RoundPieces::Triangle>& parts, std::vector<RimExcess>& excess);

}  // namespace volcontact
