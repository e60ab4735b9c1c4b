// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/base/simd.h"
#include "volcontact/metrics/volume_metrics.h"
#include "volcontact/pair/mesh_columns/radial/radial_wall.h"

namespace volcontact {

/// Plane pieces of a surface in a solid with a radial wall, eight side by side, in Q: triangles,
/// and slivers between a chord and the arc in which the plane meets the wall. A lane without one
/// has no area.
struct RadialPieces {
  std::vector<double> corner[3][3];  ///< of triangles: corner[i][axis]
  std::vector<double> middle[3];     ///< of a sliver's chord
  std::vector<double> normal[3];     ///< of a sliver, of unit length
  std::vector<double> area;          ///< of a sliver, negative where the arc lies on the inner side
                                     ///< of the chord [m^2]
  std::vector<int> part_of_triangle, part_of_sliver;
  int triangles = 0, slivers = 0;
  void clear();
  void add_triangle(const Vec3& a, const Vec3& b, const Vec3& c, int part);
  void add_sliver(const Vec3& middle, const Vec3& normal, double area, int part);
  /// Fills the last eight up.
  void end();
};

/// Sums over the lines from pieces to the wall, about the origin of Q:
///   V = int F . n dS,   div F = 1,   F along the lines and 0 on the wall
/// so that the wall adds nothing; of a bore F = (rho - r^2 / rho) / 2 away from the axis.
struct RadialSum {
  MomentSum moments;
  double depth_moment = 0.0;  ///< int of the distance along the line from the wall, over the volume
  double depth = 0.0;         ///< largest such distance met [m]
  double doubt = 0.0;         ///< of the volume [m^3]
};

/// `doubt_of_part` has an entry for each part that the pieces belong to, and is added to.
RadialSum sum_radial_columns(const RadialWall& wall, const RadialPieces& pieces, SimdPath path,
                             std::vector<double>& doubt_of_part);

}  // namespace volcontact
