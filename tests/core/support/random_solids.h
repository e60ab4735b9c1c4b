// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/support/random.h"
#include "volcontact/shape/csg/csg.h"

namespace volcontact::test {

/// A simple solid of some tenths of a metre, now and then with a cone's point, or a ring.
inline SimpleShape random_member(Random& random) {
  const auto size = [&random] { return random.uniform(0.1, 0.35); };
  switch (static_cast<int>(random.uniform(0.0, 8.0))) {
    case 0:
      return Sphere({.radius = size()});
    case 1: {
      const double x = size(), y = size();
      return Ellipsoid({.semi_axes = Vec3(x, y, size())});
    }
    case 2: {
      const double radius = size();
      return Capsule({.radius = 0.6 * radius, .half_length = size()});
    }
    case 3: {
      const double bottom = size();
      const double top = random.uniform() < 0.3 ? 0.0 : size();
      return Frustum({.bottom_radius = bottom, .top_radius = top, .half_length = size()});
    }
    case 4:
      if (random.uniform() < 0.3) {
        return Torus({.major_radius = size(), .minor_radius = 0.3 * size()});
      }
      [[fallthrough]];
    case 5: {
      const double radius = size();
      return Cylinder({.radius = radius, .half_length = size()});
    }
    default: {
      const double x = size(), y = size();
      return Box({.half_sizes = Vec3(x, y, size())});
    }
  }
}

/// Members joined one after another by random operations, each at a random pose or, `aligned`, with
/// its axes along those of the others and its middle on a coarse grid, where faces fall together.
inline Csg random_solid(int members, bool aligned, Random& random) {
  const auto member = [&] {
    const SimpleShape shape = random_member(random);
    if (!aligned) return Csg(shape, random.pose(0.2));
    const Vec3 at = random.in_box(0.25);
    const Vec3 on_grid(0.1 * std::round(10.0 * at.x()), 0.1 * std::round(10.0 * at.y()),
                       0.1 * std::round(10.0 * at.z()));
    const int axis = static_cast<int>(random.uniform(0.0, 3.0));
    return Csg(shape, Pose{turn(Vec3::Unit(axis), 0.5 * kPi), on_grid});
  };
  Csg solid = member();
  for (int i = 1; i < members; ++i) {
    constexpr Csg::Operation kOperations[] = {Csg::Operation::kUnion, Csg::Operation::kDifference,
                                              Csg::Operation::kDifference,
                                              Csg::Operation::kIntersection};
    const Csg::Operation operation = kOperations[static_cast<int>(random.uniform(0.0, 4.0))];
    const Csg other = member();
    if (random.uniform() < 0.2) {
      solid = Csg(operation, solid, Csg(Csg::Operation::kUnion, other, member()));
    } else {
      solid = Csg(operation, solid, other);
    }
  }
  return solid;
}

}  // namespace volcontact::test
