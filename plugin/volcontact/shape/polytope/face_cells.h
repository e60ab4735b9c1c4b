// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/shape/polytope/convex_polytope.h"

namespace volcontact {

/// The points of a polytope that are nearer to one face than to any other one: again a polytope.
struct FaceCell {
  int face;  ///< among ConvexPolytope::faces()
  ConvexPolytope solid;
};

/// The cells of all faces; together they fill the polytope. Cells of no more than a 1e-14th of its
/// volume are left out. Works N^2 for N faces, and allocates.
std::vector<FaceCell> make_face_cells(const ConvexPolytope& solid);

}  // namespace volcontact
