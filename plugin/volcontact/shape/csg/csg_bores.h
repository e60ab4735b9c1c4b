// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "volcontact/shape/csg/csg_carved.h"

namespace volcontact {

/// The carved faces of a piece as bores; none when one is no tube or cone, or when the body comes
/// near the apex of a cone.
std::vector<Bore> csg_bores(const Carving& carving, const CarvedPiece& piece);

/// The plane across the axis that two tubes or cones share, where one begins to hold the other.
/// `size` [m] is that of the solid.
std::optional<MemberFace> csg_crossing(const MemberFace& one, const MemberFace& other, double size);

}  // namespace volcontact
