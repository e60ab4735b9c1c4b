// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/closed_form/half_ball.h"
#include "volcontact/pair/closed_form/half_space_frustum.h"
#include "volcontact/shape/capsule.h"

namespace volcontact {

/// Capsule B in half-space A, in A: a cylinder and two half balls. Fully immersed as with the ball.
inline VolumeMetrics closed_form(const HalfSpace&, const Capsule& b, const Pose& X_AB) noexcept {
  const double r = b.radius(), half_length = b.half_length();
  const Vec3 &center = X_AB.translation, axis = X_AB.rotation.col(2), offset = half_length * axis;
  const double reach = r + std::abs(offset.z());
  if (!(center.z() < reach) || !(r > 0.0)) return VolumeMetrics{};
  if (!(center.z() > -reach)) {
    return immersed_solid(b.own_metrics(), X_AB, 4.0 * kPi * r * (r + half_length), 2.0 * reach);
  }
  VolumeMetrics m = HalfBall(r, center + offset, Tilt(axis)).below() +
                    HalfBall(r, center - offset, Tilt(-axis)).below();
  if (half_length > 0.0) {
    m = m + frustum_below(center, axis, r, r, half_length, false);
  }
  m.depth = reach - center.z();
  return m;
}

}  // namespace volcontact
