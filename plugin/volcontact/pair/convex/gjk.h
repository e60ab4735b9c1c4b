// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/pair/convex/convex_view.h"

namespace volcontact {

/// Finds a common point of two bounded convex solids, in A's frame, or proves by a direction in
/// which their support functions do not meet that there is none. A point of bare touch may be
/// reported either way. Method of Gilbert, Johnson and Keerthi, IEEE J. Robotics and Automation
/// 4(2), 1988.
bool find_common_point(const ConvexView& a, const ConvexView& b, const Pose& X_AB, Vec3& point);

/// What keeps a ball and a convex solid apart, or a place of the solid in the ball.
struct BallGap {
  bool apart;
  Vec3 normal;    ///< unit length; when apart, normal . x <= offset in the solid
  double offset;  ///< and the ball lies beyond
  Vec3 place;     ///< of the solid, about the nearest to the center; when not apart, in the ball
};

/// Parts the ball about `center` from a bounded convex solid, in A's frame, by a supporting plane
/// of the solid, which is certain, or finds a place of the solid in the ball: to about a tenth of
/// the ball's depth as near to the center as any. By Gilbert, Johnson and Keerthi's method, too.
BallGap ball_gap(const ConvexView& solid, const Pose& X_AS, const Vec3& center, double radius);

/// The point of the convex hull of some points (at least one) nearest the origin.
Vec3 nearest_in_hull(const std::vector<Vec3>& points);

}  // namespace volcontact
