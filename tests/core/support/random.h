// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "volcontact/base/types.h"

namespace volcontact::test {

/// Seeded random numbers, the same on every machine (splitmix64; the standard distributions are
/// not).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// From [low, high).
  double uniform(double low = 0.0, double high = 1.0) {
    return low + (high - low) * static_cast<double>(next() >> 11) * 0x1p-53;
  }
  /// From [low, high), evenly in the logarithm.
  double log_uniform(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  Vec3 in_box(double half) {
    const double x = uniform(-half, half), y = uniform(-half, half), z = uniform(-half, half);
    return {x, y, z};
  }
  Vec3 direction() {
    for (;;) {
      const Vec3 p = in_box(1.0);
      const double length = p.norm();
      if (length > 0.1 && length < 1.0) return p / length;
    }
  }
  Mat3 rotation() {
    for (;;) {
      Vector<4> q;
      for (int i = 4; i-- > 0;) q[i] = uniform(-1.0, 1.0);
      const double length = q.norm();
      if (length > 0.1 && length < 1.0) {
        q /= length;
        return rotation_of(q[0], q[1], q[2], q[3]);
      }
    }
  }
  Pose pose(double half_range) {
    const Mat3 r = rotation();
    return {r, in_box(half_range)};
  }

 private:
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

inline Mat3 turn(const Vec3& axis, double angle) {
  return rotation_about(axis.normalized(), angle);
}

/// The pose after a small motion of its frame, seen from outside: turned by `angle` about the
/// outside origin, then shifted.
inline Pose moved(const Pose& X, const Vec3& shift, const Vec3& angle) {
  const double size = angle.norm();
  const Mat3 r = size > 0.0 ? turn(angle, size) : Mat3(Mat3::Identity());
  return Pose{r, shift} * X;
}

/// The pose after a motion whose twist about the outside origin is (shift, angle) from its
/// beginning to its end: two halves of it in turn are all of it.
inline Pose screwed(const Pose& X, const Vec3& shift, const Vec3& angle) {
  const double size = angle.norm();
  if (!(size > 0.0)) return Pose{Mat3::Identity(), shift} * X;
  const double half_sine = std::sin(0.5 * size) / size;
  const double third = size > 1e-2 ? (size - std::sin(size)) / (size * size * size)
                                   : (1.0 - size * size / 20.0) / 6.0;
  const Vec3 across = angle.cross(shift);
  return Pose{turn(angle, size),
              shift + 2.0 * half_sine * half_sine * across + third * angle.cross(across)} *
         X;
}

}  // namespace volcontact::test
