// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/base/simd.h"
#include "volcontact/metrics/volume_metrics.h"
#include "volcontact/pair/mesh_columns/in_round/round_solid.h"

namespace volcontact {

/// Triangles inside of a round solid, eight side by side; a lane without one has no area.
struct RoundTriangles {
  std::vector<double> corner[3][3];  ///< corner[i][axis]
  std::vector<double> doubt;         ///< of what each adds to V [m^3]
  std::vector<double> longest;       ///< of the columns on each [m]
  std::vector<double> steep;         ///< V over each at most, where columns end on a steep face
  void resize(std::size_t count);
  void set(std::size_t i, const Vec3& a, const Vec3& b, const Vec3& c);
};

/// Points that stand for slivers: see RoundPieces::Sliver.
struct RoundPoints {
  std::vector<double> middle[3], tip[3], area_vector[3];
  std::vector<double> tip_depth;  ///< of the solid below the tip where it looks upwards, else 0
  void resize(std::size_t count);
};

/// Sums over columns from the triangles down to the surface of the solid, about the origin of Q:
///   V = int L n . up dS,   L the way from x against `up` to the surface
struct RoundSum {
  double volume = 0.0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  double energy = 0.0;  ///< int L^2/2 over the columns' cross-section [m^4]
  double counter_area = 0.0;
  double longest = 0.0;     ///< of the columns that were looked at [m]
  double doubt = 0.0;       ///< of the volume, by the rule on the triangles, if it is smooth there
  double difference = 0.0;  ///< between that rule and the rough one, each triangle's own size
  double slivers = 0.0;     ///< volume of the slivers
};

/// Columns run against the unit vector `up`. `triangles` and `points` are multiples of eight; their
/// doubts, longest columns and tip depths are filled in.
RoundSum sum_round_columns(const RoundSolid& solid, const Vec3& up, RoundTriangles& triangles,
                           RoundPoints& points, SimdPath path);

}  // namespace volcontact
