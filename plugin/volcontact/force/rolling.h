// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "volcontact/base/types.h"

namespace volcontact {

/// Rolling resistance of a damped Winkler foundation: the local pressure k_v h a v_n(x) of a patch
/// that turns with w about an axis in its plane has the torque -k_v a K w, where
/// K = int (r x n)(r x n)^T dV are the second moments of the volume projected on the contact plane.
/// docs/theory.md, "Rolling resistance".
struct RollingInput {
  double rolling_damping = 0.0;          ///< k_v a [N s/m^4]
  double normal_force = 0.0;             ///< f_n [N]
  double volume = 0.0;                   ///< V [m^3]
  Vec3 normal = Vec3::UnitZ();           ///< unit
  Mat3 second_moment = Mat3::Zero();     ///< int r r^T dV about the centroid [m^5]
  Vec3 angular_velocity = Vec3::Zero();  ///< of A against B [rad/s]
};

/// Torque on A [N m], in the contact plane. Its lever arm |torque| / f_n is limited so that the
/// centre of pressure stays inside the patch: to sqrt(2) standard deviations of the volume in the
/// direction of the arm, the distance from the centroid to the loaded edge of a wedge-shaped patch.
inline Vec3 rolling_torque(const RollingInput& in) {
  if (!(in.rolling_damping > 0.0) || !(in.volume > 0.0)) return Vec3::Zero();
  const Vec3& n = in.normal;
  const Vec3 torque =
      -in.rolling_damping * n.cross(in.second_moment * in.angular_velocity.cross(n));
  const double square = torque.squaredNorm();
  if (!(square > 0.0)) return Vec3::Zero();
  // Variance of the patch along the arm, which is perpendicular to the torque.
  const Vec3 arm = torque.cross(n);
  const double variance = std::max(0.0, arm.dot(in.second_moment * arm)) / (square * in.volume);
  const double limit = in.normal_force * std::sqrt(2.0 * variance), size = std::sqrt(square);
  return size > limit ? Vec3((limit / size) * torque) : torque;
}

}  // namespace volcontact
