// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/shape/box.h"

namespace volcontact {

// Corners and faces of a box. Corner i lies at +half where bit k of i is set, k the axis. Face
// 2 k + 1 looks along +axis k, face 2 k against it; loops go counterclockwise seen from outside.

inline constexpr int kBoxLoops[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

/// Corners of a box turned by `rotation` about its centre.
inline void place_corners(const Vec3& half, const Mat3& rotation, const Vec3& center,
                          Vec3* corners) {
  const Vec3 x = half.x() * rotation.col(0), y = half.y() * rotation.col(1),
             z = half.z() * rotation.col(2);
  for (int i = 0; i < 8; ++i) {
    corners[i] =
        center + ((i & 1 ? x : Vec3(-x)) + (i & 2 ? y : Vec3(-y)) + (i & 4 ? z : Vec3(-z)));
  }
}

/// Outward normal of a face of a box turned by `rotation`.
inline Vec3 box_normal(int face, const Mat3& rotation) {
  return face & 1 ? Vec3(rotation.col(face >> 1)) : Vec3(-rotation.col(face >> 1));
}

inline double surface_of(const Box& box) {
  const Vec3& h = box.half_sizes();
  return 8.0 * (h.x() * h.y() + h.y() * h.z() + h.z() * h.x());
}

}  // namespace volcontact
