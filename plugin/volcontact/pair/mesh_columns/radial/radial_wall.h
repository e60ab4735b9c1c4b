// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include "volcontact/base/types.h"
#include "volcontact/shape/csg/bore.h"
#include "volcontact/shape/torus.h"

namespace volcontact {

/// A wall to which lines run along the normals of its circles, in a frame Q about its axis z: the
/// wall of a bore, with the solid outside of r = radius + slope z, or the surface of a torus.
struct RadialWall {
  bool torus = false;
  double radius = 0.0;  ///< of the bore at z = 0, or of the tube of the torus [m]
  double slope = 0.0;   ///< of a conical bore [-]
  double major = 0.0;   ///< from the axis to the middle of the tube of a torus [m]

  RadialWall() = default;
  explicit RadialWall(const Bore& bore) : radius(bore.radius), slope(bore.slope) {}
  explicit RadialWall(const Torus& ring)
      : torus(true), radius(ring.minor_radius()), major(ring.major_radius()) {}

  /// Negative in the solid: across the axis to the wall of a bore, or the distance from a torus.
  double level(const Vec3& x) const {
    const double r = length(x.x(), x.y());
    return torus ? length(r - major, x.z()) - radius : radius + slope * x.z() - r;
  }
  /// Its gradient; any of them on the axis.
  Vec3 gradient(const Vec3& x) const {
    const double r = length(x.x(), x.y());
    const Vec3 out = r > 0.0 ? Vec3(x.x() / r, x.y() / r, 0.0) : Vec3(1.0, 0.0, 0.0);
    if (!torus) return Vec3(-out.x(), -out.y(), slope);
    const double across = r - major, distance = length(across, x.z());
    return distance > 0.0 ? Vec3((across * out + Vec3(0.0, 0.0, x.z())) / distance) : out;
  }

  // Quicker than hypot(), which also serves numbers that no solid has.
  static double length(double x, double y) { return std::sqrt(x * x + y * y); }
};

}  // namespace volcontact
