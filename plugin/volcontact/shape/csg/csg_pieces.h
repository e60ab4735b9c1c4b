// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/shape/csg/csg.h"

namespace volcontact {

/// The solid as pieces of quadric faces that are surface all over or not at all. Empty when a
/// member has no pieces, or when there would be too many. docs/theory.md, "Composed solids".
PieceList csg_pieces(const Csg& solid);

}  // namespace volcontact
