// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/shape/box.h"
#include "volcontact/shape/polytope_graph.h"

namespace volcontact {

/// Corners of a box turned by `rotation` about its centre, numbered as in kBoxLoops.
inline void place_corners(const Vec3& half, const Mat3& rotation, const Vec3& center,
                          Vec3* corners) {
  const Vec3 x = half.x() * rotation.col(0), y = half.y() * rotation.col(1),
             z = half.z() * rotation.col(2);
  for (int i = 0; i < 8; ++i) {
    corners[i] =
        center + ((i & 1 ? x : Vec3(-x)) + (i & 2 ? y : Vec3(-y)) + (i & 4 ? z : Vec3(-z)));
  }
}

/// Outward normal of a face, as in kBoxLoops, of a box turned by `rotation`.
inline Vec3 box_normal(int face, const Mat3& rotation) {
  return face & 1 ? Vec3(rotation.col(face >> 1)) : Vec3(-rotation.col(face >> 1));
}

inline double surface_of(const Box& box) {
  const Vec3& h = box.half_sizes();
  return 8.0 * (h.x() * h.y() + h.y() * h.z() + h.z() * h.x());
}

}  // namespace volcontact
