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

/// Plane faces of two solids that look at each other and are nearly in one plane.
struct FlushFaces {
  Vec3 normal_a;  ///< of unit length, in A's frame
  double offset_a;
  Vec3 normal_b;  ///< nearly opposite
  double depth;   ///< how far B reaches behind A's face, at most [m]
  double size;    ///< of the solids, about [m]
};

/// The same for two solids that overlap in a thin layer between two such faces, if at all: lengths
/// across the layer count by how thin it is.
bool find_common_point_in_layer(const ConvexView& a, const ConvexView& b, const Pose& X_AB,
                                const FlushFaces& faces, Vec3& point);

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
