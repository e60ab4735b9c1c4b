// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/shape/csg/csg_split.h"

namespace volcontact {

/// A CarvedPiece in the making: a body, and the round faces that are cut out of it.
struct Carving {
  PosedShape body;
  PartHull hull;
  std::vector<MemberFace> carved;

  explicit Carving(PosedShape from) : body(std::move(from)), hull(body.shape, body.X_SM) {}
};

/// The solid as convex bodies outside of round faces; empty when it cannot be written so.
std::vector<Carving> csg_carvings(const Csg& solid);

/// The same with seams, as a solid offers it. docs/theory.md, "Composed solids".
std::vector<CarvedPiece> csg_carved_pieces(const Csg& solid);

}  // namespace volcontact
