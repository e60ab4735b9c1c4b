// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/closed_form/frustum_strips.h"
#include "volcontact/shape/cylinder.h"
#include "volcontact/shape/frustum.h"
#include "volcontact/shape/half_space.h"

namespace volcontact {

/// The wall and, if wanted, the ends of a frustum about the unit vector `axis` of A: the part below
/// z = 0, in A. `radius` at -half_length, `top_radius` at +half_length from the centre.
inline VolumeMetrics frustum_below(const Vec3& center, const Vec3& axis, double radius,
                                   double top_radius, double half_length, bool has_ends) {
  const double sine = std::hypot(axis.x(), axis.y());
  const double rise = axis.z() * half_length;
  const bool upright = center.z() - rise - sine * radius <= center.z() + rise - sine * top_radius;
  const Tilt tilt(upright ? axis : Vec3(-axis));
  const double to_start = upright ? -rise : rise;
  const FrustumStrips::Solid solid{
      upright ? radius : top_radius, upright ? top_radius : radius, 2.0 * half_length,
      center.z() + to_start,         center.z() - to_start,         has_ends};
  if (!(solid.start_height < sine * solid.start_radius)) return VolumeMetrics{};
  const FrustumStrips strips(solid, tilt);
  // The lowest corner: from the middle of the start against p = (-cosine heading, sine).
  const double r = solid.start_radius;
  const Vec3 across(-tilt.cosine * tilt.heading.x(), -tilt.cosine * tilt.heading.y(), tilt.sine);
  const Vec3 start = center + (upright ? -half_length : half_length) * axis;
  const double reach = half_length + std::max(radius, top_radius);
  return strips.sum().metrics(start - r * across, tilt, reach);
}

/// Cone frustum B in half-space A, in A. Fully immersed as with the ball.
inline VolumeMetrics closed_form(const HalfSpace&, const Frustum& b, const Pose& X_AB) noexcept {
  const auto& [bottom, top, half_length] = b.params();
  const Vec3 axis = X_AB.rotation.col(2), down_B = -X_AB.rotation.row(2);
  const double height = X_AB.translation.z();
  const double depth = b.support_height(down_B) - height;
  if (!(depth > 0.0) || !(half_length > 0.0)) return VolumeMetrics{};
  const double top_height = height + b.support_height(-down_B);
  if (!(top_height > 0.0)) {
    const VolumeMetrics own = b.own_metrics();
    if (!(own.volume > 0.0)) return VolumeMetrics{};
    const double wall = kPi * (bottom + top) * std::hypot(bottom - top, 2.0 * half_length);
    return immersed_solid(own, X_AB, wall + kPi * (bottom * bottom + top * top),
                          depth + top_height);
  }
  return frustum_below(X_AB.translation, axis, bottom, top, half_length, true);
}

/// Cylinder B in half-space A, in A. Fully immersed as with the ball.
inline VolumeMetrics closed_form(const HalfSpace&, const Cylinder& b, const Pose& X_AB) noexcept {
  const double r = b.radius(), half_length = b.half_length();
  const Vec3 axis = X_AB.rotation.col(2);
  const double height = X_AB.translation.z();
  const double reach = r * std::hypot(axis.x(), axis.y()) + half_length * std::abs(axis.z());
  if (!(height < reach) || !(r > 0.0) || !(half_length > 0.0)) return VolumeMetrics{};
  if (!(height > -reach)) {
    return immersed_solid(b.own_metrics(), X_AB, 2.0 * kPi * r * (r + 2.0 * half_length),
                          2.0 * reach);
  }
  return frustum_below(X_AB.translation, axis, r, r, half_length, true);
}

}  // namespace volcontact
