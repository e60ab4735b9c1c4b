// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/pair/mesh_columns/radial/radial_sums.h"

namespace volcontact {

/// A triangle, in Q, that the wall passes through in one arc at most, or that lies in the solid.
struct RadialPart {
  Vec3 corner[3];
  int face;          ///< number of the triangle of the mesh that it is part of
  bool inside;       ///< all of it; else:
  bool alone_in;     ///< the first corner is in the solid and the others are not, or the reverse
  Vec3 chord[2];     ///< where the wall meets the edges to the second and the third corner
  double sag = 0.0;  ///< of the arc over the chord, away from what is in the solid [m]
};

/// Divides a triangle until the wall passes through each part in one plain arc, and appends the
/// parts that reach into the solid. `divisions` counts those before. False when that has no end or
/// there are more than `most_parts`.
bool divide_at_wall(const RadialWall& wall, const Vec3 (&corner)[3], int face, int divisions,
                    int most_parts, std::vector<RadialPart>& parts);

/// Where a part had better be divided: the edge along which the wall bends most, and begins.
int edge_to_divide(const RadialWall& wall, const RadialPart& part);

/// Appends what of a part lies in the solid.
void add_pieces(const RadialPart& part, int number, RadialPieces& pieces);

}  // namespace volcontact
