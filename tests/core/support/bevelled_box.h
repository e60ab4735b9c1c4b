// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/shape/polytope/convex_polytope.h"

namespace volcontact::test {

/// A box with its edges and corners cut off: of each face, what is `cut` from its edges is left.
inline ConvexPolytope bevelled_box(const Vec3& half_sizes, double cut) {
  std::vector<Vec3> corners;
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      for (const double z : {-1.0, 1.0}) {
        const Vec3 sign(x, y, z);
        for (int face = 0; face < 3; ++face) {
          Vec3 corner = half_sizes - Vec3::Constant(cut);
          corner[face] = half_sizes[face];
          corners.push_back(sign.cwiseProduct(corner));
        }
      }
    }
  }
  return ConvexPolytope({.vertices = corners});
}

}  // namespace volcontact::test
