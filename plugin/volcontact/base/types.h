// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "volcontact/base/matrix.h"

namespace volcontact {

// Frame notation, used in every name of the project:
//   X_AB    pose of frame B measured in frame A; inner letters meet: X_WB = X_WA * X_AB
//   R_AB    its rotation matrix: v_A = R_AB v_B
//   p_AB_W  position from A to B, expressed in W (the last letter may be left out when it is A)
//   v_AB, w_AB   linear and angular velocity of B in A
// Letters: W world, A and B the two bodies of a pair, C the centroid of a contact site.
// Units are SI throughout: m, kg, s, N, rad.

// Vec3 is in vector.h, Mat3 in matrix.h.

inline constexpr double kPi = 3.14159265358979323846;

/// Whether all are finite; a number that is not is NaN when it is taken from itself.
inline bool is_finite(const Vec3& v) {
  return ((v.x() - v.x()) + (v.y() - v.y())) + (v.z() - v.z()) == 0.0;
}

/// Rigid transform X_AB: `rotation` R_AB is orthonormal, `translation` p_AB is in metres.
struct Pose {
  Mat3 rotation = Mat3::Identity();
  Vec3 translation = Vec3::Zero();

  /// Maps a point given in B to A.
  Vec3 operator*(const Vec3& p_B) const { return rotation * p_B + translation; }
  Pose operator*(const Pose& X_BC) const {
    return {rotation * X_BC.rotation, rotation * X_BC.translation + translation};
  }
  Pose inverse() const {
    const Mat3 transposed = rotation.transpose();
    return {transposed, -(transposed * translation)};
  }
  bool is_finite() const {
    return volcontact::is_finite(rotation.col(0)) && volcontact::is_finite(rotation.col(1)) &&
           volcontact::is_finite(rotation.col(2)) && volcontact::is_finite(translation);
  }
};

/// Motion of a body frame: angular velocity [rad/s] and velocity of the frame origin [m/s].
struct Twist {
  Vec3 angular = Vec3::Zero();
  Vec3 linear = Vec3::Zero();

  /// Velocity of the body-fixed point at offset `p` from the frame origin [m/s].
  Vec3 at(const Vec3& p) const { return linear + angular.cross(p); }
};

/// Force [N] and torque [N m] about the point that the holder names.
struct Wrench {
  Vec3 torque = Vec3::Zero();
  Vec3 force = Vec3::Zero();

  /// The same load with its torque taken about a point at offset `p` from the present one.
  Wrench about(const Vec3& p) const { return {torque - p.cross(force), force}; }
  Wrench& operator+=(const Wrench& other) {
    torque += other.torque;
    force += other.force;
    return *this;
  }
};

/// Power of a load on a body that moves, both about its frame's origin [W].
inline double power_of(const Wrench& load, const Twist& motion) {
  return load.force.dot(motion.linear) + load.torque.dot(motion.angular);
}

/// Cross-product matrix: skew(a) b = a x b.
inline Mat3 skew(const Vec3& a) {
  return {0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0};
}

/// Rotation matrix of a turn by `angle` [rad] about a unit vector (Rodrigues).
inline Mat3 rotation_about(const Vec3& axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return c * Mat3::Identity() + s * skew(axis) + (1.0 - c) * outer(axis, axis);
}

/// Rotation matrix of the unit quaternion w + x i + y j + z k.
inline Mat3 rotation_of(double w, double x, double y, double z) {
  return {1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z),       2.0 * (x * z + w * y),
          2.0 * (x * y + w * z),       1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x),
          2.0 * (x * z - w * y),       2.0 * (y * z + w * x),       1.0 - 2.0 * (x * x + y * y)};
}

/// Orthonormal basis whose third column is the unit vector `n`; continuous except at n.z = 0.
/// Duff et al., "Building an orthonormal basis, revisited", JCGT 6(1), 2017.
inline Mat3 basis_with_z(const Vec3& n) {
  const double sign = std::copysign(1.0, n.z());
  const double a = -1.0 / (sign + n.z());
  const double b = n.x() * n.y() * a;
  Mat3 r;
  r.col(0) = Vec3(1.0 + sign * n.x() * n.x() * a, sign * b, -sign * n.x());
  r.col(1) = Vec3(b, sign + n.y() * n.y() * a, -n.y());
  r.col(2) = n;
  return r;
}

/// Corner i of the cube of half size 1, by the bits of i.
inline Vec3 corner_signs(int i) {
  return {i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0};
}

}  // namespace volcontact
