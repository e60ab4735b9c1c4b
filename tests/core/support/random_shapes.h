// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/support/random.h"
#include "volcontact/shape/box.h"
#include "volcontact/shape/polytope/convex_polytope.h"

namespace volcontact::test {

/// Half sizes from 0.2 to 1 m.
inline Box random_box(Random& random) {
  const double x = random.uniform(0.2, 1.0), y = random.uniform(0.2, 1.0);
  return Box({.half_sizes = Vec3(x, y, random.uniform(0.2, 1.0))});
}

/// Hull of points near the unit sphere, its frame off its middle.
inline ConvexPolytope random_polytope(int points, Random& random) {
  const Vec3 middle = random.in_box(0.3);
  std::vector<Vec3> all;
  for (int i = 0; i < points; ++i) {
    const Vec3 e = random.direction();
    all.push_back(middle + random.uniform(0.6, 1.0) * e);
  }
  return ConvexPolytope(all);
}

/// The same solid as a polytope.
inline ConvexPolytope polytope_of(const Box& box) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    const Vec3 sign(i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0);
    corners.push_back(sign.cwiseProduct(box.half_sizes()));
  }
  return ConvexPolytope(corners);
}

}  // namespace volcontact::test
