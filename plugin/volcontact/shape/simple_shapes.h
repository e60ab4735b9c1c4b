// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "volcontact/base/type_list.h"
#include "volcontact/shape/box.h"
#include "volcontact/shape/capsule.h"
#include "volcontact/shape/cylinder.h"
#include "volcontact/shape/ellipsoid.h"
#include "volcontact/shape/frustum.h"
#include "volcontact/shape/half_space.h"
#include "volcontact/shape/polytope/convex_polytope.h"
#include "volcontact/shape/rounded_box.h"
#include "volcontact/shape/sphere.h"
#include "volcontact/shape/torus.h"

namespace volcontact {

/// The shapes that are not made of others.
using SimpleShapes = TypeList<HalfSpace, Sphere, Ellipsoid, Capsule, Cylinder, Frustum, Box,
                              RoundedBox, Torus, ConvexPolytope>;

/// One solid of a simple shape, in its own frame.
using SimpleShape = SimpleShapes::Variant;

// Pieces of the shapes that do not write them themselves.
void add_pieces(const Ellipsoid& solid, PieceList& list);
void add_pieces(const ConvexPolytope& solid, PieceList& list);
template <typename S>
  requires requires(const S& solid, PieceList& list) { solid.pieces(list); }
void add_pieces(const S& solid, PieceList& list) {
  solid.pieces(list);
}
template <typename S>
concept HasPieces = requires(const S& solid, PieceList& list) { add_pieces(solid, list); };

bool has_pieces(const SimpleShape& shape);
/// Whether its faces have it as their intersection: HasFaces.
bool is_made_of_faces(const SimpleShape& shape);

}  // namespace volcontact
