// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/convex/convex_view.h"

namespace volcontact {

/// A convex solid with one round face and up to two plane ones, posed in some frame Q. The round
/// face is convex(x) <= 0 with
///   convex(x) = |y| - 1                        ball, ellipsoid, tube (a row of `map` is zero)
///   convex(x) = |(y_x, y_y)| - y_z             cone
/// y = map (x - center), where x is first moved along `axis` towards the centre by `half_length` at
/// most (capsule). All of these are convex functions of x.
struct RoundSolid {
  int plane_count = 0;
  double normal[2][3];  ///< plane k: normal[k] . x <= offset[k]
  double offset[2];
  double rim_center[2][3];  ///< plane k ends at a circle
  double rim_radius[2];
  double map[3][3];
  double center[3];
  double axis[3];            ///< of a capsule
  double half_length = 0.0;  ///< 0: no capsule
  bool cone = false;
  bool has_axis = false;  ///< not a ball or an ellipsoid
  Vec3 axis_direction = Vec3::UnitZ();
  double size = 0.0;  ///< about its width [m]
  double wall_level =
      0.0;  ///< convex(x) above this is on the round face or outside, but for rounding

  Vec3 plane_normal(int k) const { return Vec3::from(normal[k]); }
  /// Height of x over plane face k, negative inside.
  double over_plane(int k, const Vec3& x) const { return plane_normal(k).dot(x) - offset[k]; }
};

/// The faces of B posed in Q; `faces` is scratch memory. False when it has no round face.
bool round_solid_of(const ConvexView& b, const Pose& X_QB, FaceSet& faces, RoundSolid& solid);

/// The part of the line o + t d inside of the round face alone.
RayInterval round_interval(const RoundSolid& solid, const Vec3& o, const Vec3& d);

/// convex(x) and its gradient.
double round_level(const RoundSolid& solid, const Vec3& x, Vec3& gradient);

/// A lower bound of convex(x) over a triangle with this unit normal, and nearly its least value on
/// the plane around: 0 where that only touches the round face.
double least_round_level(const RoundSolid& solid, const Vec3 (&corner)[3], const Vec3& normal);

}  // namespace volcontact
