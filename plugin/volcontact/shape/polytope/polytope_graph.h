// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/base/types.h"

namespace volcontact {

/// Surface of a convex polytope as a graph in which every vertex has three neighbours, the form
/// that clipping by planes keeps whatever the rounding. A corner where k faces meet stands k - 2
/// times, joined by edges of no length.
///
/// Half-edge h = 4 v + slot leaves vertex v; its left face, seen from outside with the vertices
/// counterclockwise, is face[h]. Arriving at a vertex by a twin in slot s, the same face leaves it
/// by slot s + 1 (mod 3). Entries 4 v + 3 are unused.
struct PolytopeGraph {
  std::vector<Vec3> points;
  std::vector<int> corner;  ///< of each vertex, the index of its point among the corners
  std::vector<int> twin;
  std::vector<int> face;
};

/// Graph of the polytope with these corners and faces (loops of corners, counterclockwise from
/// outside, every edge in two faces).
PolytopeGraph make_polytope_graph(const std::vector<Vec3>& corners,
                                  const std::vector<std::vector<int>>& loops);

/// Graph of a box; its vertex i has the signs of the bits of i (x, y, z). Its faces 0 to 5 look
/// along -z, +z, -y, +y, -x and +x.
const PolytopeGraph& box_graph();

}  // namespace volcontact
