// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "volcontact/base/types.h"

namespace volcontact {

/// A round hole without ends about an axis: a tube, or one nappe of a cone.
struct Bore {
  Vec3 center;          ///< on the axis; the apex of a cone
  Vec3 axis;            ///< of unit length; a cone opens along it
  double radius = 0.0;  ///< of a tube, 0 for a cone [m]
  double slope = 0.0;   ///< of a cone: radius per height over the apex [-]; 0 for a tube

  bool is_cone() const { return slope > 0.0; }
  double height(const Vec3& x) const { return axis.dot(x - center); }
  /// The vector from the axis to x, normal to the axis.
  Vec3 from_axis(const Vec3& x) const {
    const Vec3 d = x - center;
    return d - axis * axis.dot(d);
  }
  /// At the height of x; negative beyond the apex.
  double radius_at(const Vec3& x) const { return is_cone() ? slope * height(x) : radius; }
  /// Distance from the axis in radii at that height; not beyond the apex.
  double radii(const Vec3& x) const { return from_axis(x).norm() / radius_at(x); }
  /// x as seen along the axis, or from the apex: from the axis, in radii at that height.
  Vec3 seen(const Vec3& x) const { return from_axis(x) / radius_at(x); }
  /// Normal of the wall in the direction `out`, a unit vector normal to the axis, away from the
  /// hole. The hole lies behind the plane normal . (x - center) = radius, which touches the wall
  /// along a line.
  Vec3 wall_normal(const Vec3& out) const {
    return (out - slope * axis) / std::sqrt(1.0 + slope * slope);
  }
};

inline Bore transformed(const Bore& bore_S, const Pose& X_SW) {
  Bore bore = bore_S;
  bore.center = X_SW.rotation.transpose() * (bore_S.center - X_SW.translation);
  bore.axis = X_SW.rotation.transpose() * bore_S.axis;
  return bore;
}

}  // namespace volcontact
