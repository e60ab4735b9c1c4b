// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "volcontact/base/types.h"

namespace volcontact {

/// Whether two boxes are certainly apart, by the separating axis test on all 15 axes. `half_a` and
/// `half_b` are half edge lengths, R_AB turns B's axes to A's, p_AB leads from A's centre to B's.
/// Conservative: rounding never separates boxes that overlap.
inline bool boxes_apart(const Vec3& half_a, const Vec3& half_b, const Mat3& R_AB,
                        const Vec3& p_AB) {
  const Mat3 turn = R_AB.cwiseAbs();
  const Vec3 gap_a = p_AB.cwiseAbs() - half_a - turn * half_b;
  const Vec3 gap_b = (R_AB.transpose() * p_AB).cwiseAbs() - half_b - turn.transpose() * half_a;
  const double slack =
      8.0 * std::numeric_limits<double>::epsilon() * (p_AB.cwiseAbs() + half_a + half_b).sum();
  if (gap_a.maxCoeff() > slack || gap_b.maxCoeff() > slack) return true;
  // Edge against edge. The slack also covers parallel edges, whose cross product is noise.
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const double distance = std::abs(p_AB[i2] * R_AB(i1, j) - p_AB[i1] * R_AB(i2, j));
      const double reach = half_a[i1] * turn(i2, j) + half_a[i2] * turn(i1, j) +
                           half_b[j1] * turn(i, j2) + half_b[j2] * turn(i, j1);
      if (distance > reach + slack) return true;
    }
  }
  return false;
}

/// Whether two capsules are certainly apart: by the nearest points of their axes, each the z axis
/// of its solid from -half to half. Conservative as above. Ericson, "Real-Time Collision
/// Detection", 5.1.9.
inline bool capsules_apart(double half_a, double radius_a, double half_b, double radius_b,
                           const Pose& X_AB) {
  const Vec3 axis = X_AB.rotation.col(2), &p = X_AB.translation;
  const double cosine = axis.z(), along_b = axis.dot(p);
  const double square_of_sine = axis.x() * axis.x() + axis.y() * axis.y();
  double s = 0.0;  // along A's axis, and t along B's
  if (square_of_sine > 0.0) {
    s = std::clamp((p.z() - cosine * along_b) / square_of_sine, -half_a, half_a);
  }
  const double t = std::clamp(cosine * s - along_b, -half_b, half_b);
  s = std::clamp(p.z() + cosine * t, -half_a, half_a);
  const double reach = radius_a + radius_b;
  const double size = reach + half_a + half_b + p.cwiseAbs().sum();
  const double slack = 16.0 * std::numeric_limits<double>::epsilon() * size * size;
  return (p + t * axis - s * Vec3::UnitZ()).squaredNorm() > reach * reach + slack;
}

}  // namespace volcontact
