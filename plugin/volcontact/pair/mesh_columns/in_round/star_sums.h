// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/metrics/volume_metrics.h"
#include "volcontact/pair/mesh_columns/in_round/round_pieces.h"

namespace volcontact {

/// Sums over the rays from a point through pieces of a surface inside of a round solid, from there
/// on to the solid's surface; about the origin of Q:
///   V = 1/3 int (s^3 - 1) (x - c) . n dS,   c + s (x - c) on the surface
struct StarSum {
  MomentSum moments;          ///< negative where the pieces look at the point; without area_*
  double doubt = 0.0;         ///< of the volume, by the rule on the triangles
  double slivers = 0.0;       ///< volume of the slivers
  double depth = 0.0;         ///< of the ends of the rays behind the planes of the pieces [m]
  double depth_moment = 0.0;  ///< int of half of that over the volume, without its sign [m^4]
};

/// Memory of sum_star().
struct StarScratch {
  std::vector<RoundPieces::Triangle> parts, divided;
  std::vector<StarSum> sums;
};

/// What lies behind the triangles and slivers, seen from `center`, a point inside of the solid.
/// Triangles are divided until the doubt is below `share` of the volume, or there are more of them
/// than `most`. docs/theory.md, "Columns over round solids".
StarSum sum_star(const RoundSolid& solid, const Vec3& center,
                 const std::vector<RoundPieces::Triangle>& triangles,
                 const std::vector<RoundPieces::Sliver>& slivers, double share, int most,
                 StarScratch& scratch);

}  // namespace volcontact
