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
inline void add_pieces(const Ellipsoid& solid, PieceList& list) {
  list.add(Quadric::round(solid.semi_axes().cwiseAbs2().cwiseInverse(), Vec3::Zero(), 1.0));
  list.end_piece();
}
inline void add_pieces(const ConvexPolytope& solid, PieceList& list) {
  for (const ConvexPolytope::Face& face : solid.faces()) {
    list.add(Quadric::plane(face.normal, face.offset));
  }
  list.end_piece();
}
template <typename S>
  requires requires(const S& solid, PieceList& list) { solid.pieces(list); }
void add_pieces(const S& solid, PieceList& list) {
  solid.pieces(list);
}
template <typename S>
concept HasPieces = requires(const S& solid, PieceList& list) { add_pieces(solid, list); };

inline bool has_pieces(const SimpleShape& shape) {
  return std::visit([](const auto& solid) { return HasPieces<std::decay_t<decltype(solid)>>; },
                    shape);
}
/// Whether its faces have it as their intersection: HasFaces.
inline bool is_made_of_faces(const SimpleShape& shape) {
  return std::visit([](const auto& solid) { return HasFaces<std::decay_t<decltype(solid)>>; },
                    shape);
}

}  // namespace volcontact
