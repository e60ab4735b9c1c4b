// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "volcontact/base/fields.h"
#include "volcontact/base/types.h"

namespace volcontact {

/// x = center + radius (u cos + v sin); u and v are of length 1 and orthogonal.
struct Circle {
  Vec3 center, u, v;
  double radius;

  Vec3 at(double angle) const {
    return center + radius * (std::cos(angle) * u + std::sin(angle) * v);
  }
};

/// The ring about the z axis of all points within `minor` of the circle of radius `major`.
struct TorusSize {
  double major, minor;
};

/// q^2 - minor^2, q the distance of x from the circle of the ring: negative inside.
inline double torus_value(const TorusSize& ring, const Vec3& x) {
  const double across = std::sqrt(x.x() * x.x() + x.y() * x.y()) - ring.major;
  return across * across + (x.z() - ring.minor) * (x.z() + ring.minor);
}

/// The circle of a ring's surface in the half-plane at `angle` through its axis, angle zero of it
/// on the outer side; the ring has the pose X in the frame of the result.
inline Circle section_circle(const TorusSize& ring, const Pose& X, double angle) {
  const Vec3 out = std::cos(angle) * X.rotation.col(0) + std::sin(angle) * X.rotation.col(1);
  return {X.translation + ring.major * out, out, X.rotation.col(2), ring.minor};
}

/// What the ball of a ring about its circle at an angle has in common with another ring, on the
/// line to the circle of that one; negative depth: nothing.
struct TorusTouch {
  Vec3 middle;
  double depth;
};

/// The ring has the pose X in the frame of the other one, and so has the result.
inline TorusTouch touch_of(const TorusSize& ring, const Pose& X, const TorusSize& other,
                           double angle) {
  const Vec3 c = section_circle(ring, X, angle).center;
  const double rho = std::sqrt(c.x() * c.x() + c.y() * c.y());
  const double scale = rho > 0.0 ? other.major / rho - 1.0 : 0.0;
  const Vec3 way =
      rho > 0.0 ? Vec3(scale * c.x(), scale * c.y(), -c.z()) : Vec3(other.major, 0.0, -c.z());
  const double distance = way.norm();
  const double from = std::max(-ring.minor, distance - other.minor),
               to = std::min(ring.minor, distance + other.minor);
  const Vec3 along = distance > 0.0 ? Vec3(way / distance) : Vec3::Zero();
  return {c + 0.5 * (from + to) * along, to - from};
}

}  // namespace volcontact
