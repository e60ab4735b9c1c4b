// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>

#include "volcontact/pair/closed_form/spherical_cap.h"
#include "volcontact/shape/half_space.h"
#include "volcontact/shape/sphere.h"

namespace volcontact {

/// Ball B in half-space A, in A. Fully immersed: status kContained, S and T vanish, and
/// depth_moment stays the potential of the buoyancy V. docs/theory.md, "Spherical cap".
inline VolumeMetrics closed_form(const HalfSpace&, const Sphere& b, const Pose& X_AB) noexcept {
  const double r = b.radius();
  const Vec3& center = X_AB.translation;
  const double h = std::min(r - center.z(), 2.0 * r);  // height of the cap [m]
  VolumeMetrics m;
  if (!(h > 0.0)) return m;
  const SphericalCap cap = spherical_cap(r, h);
  if (!(cap.volume > 0.0)) return m;

  const bool immersed = !(h < 2.0 * r);
  m.volume = cap.volume;
  m.centroid = Vec3(center.x(), center.y(), immersed ? center.z() : -cap.centroid_depth);
  m.inertia = Vec3(cap.axial_second + cap.lateral_second, cap.axial_second + cap.lateral_second,
                   2.0 * cap.lateral_second)
                  .asDiagonal();
  m.area = cap.cut_area;
  m.counter_area = cap.lateral_area;
  m.area_vector.z() = cap.cut_area;
  m.area_moment = Vec3(center.y() * cap.cut_area, -center.x() * cap.cut_area, 0.0);
  m.depth_moment = immersed ? -center.z() * cap.volume : cap.depth_moment;
  m.depth = h;
  m.volume_error = 8.0 * std::numeric_limits<double>::epsilon() * cap.volume;
  m.status = immersed ? Status::kContained : Status::kOk;
  return m;
}

/// The same with the ball as A, in its frame: less work than the mirror image.
inline VolumeMetrics closed_form(const Sphere& a, const HalfSpace&, const Pose& X_AB) noexcept {
  const double r = a.radius();
  const Vec3 up = X_AB.rotation.col(2);
  const double height = -up.dot(X_AB.translation);  // of the centre over the plane [m]
  const double h = std::min(r - height, 2.0 * r);
  VolumeMetrics m;
  if (!(h > 0.0)) return m;
  const SphericalCap cap = spherical_cap(r, h);
  if (!(cap.volume > 0.0)) return m;

  const bool immersed = !(h < 2.0 * r);
  m.volume = cap.volume;
  if (!immersed) m.centroid = -(height + cap.centroid_depth) * up;
  m.inertia = inertia_of_revolution(cap.axial_second, cap.lateral_second, up);
  m.area = cap.lateral_area;
  m.counter_area = cap.cut_area;
  m.area_vector = -cap.cut_area * up;
  m.depth_moment = immersed ? -height * cap.volume : cap.depth_moment;
  m.depth = h;
  m.volume_error = 8.0 * std::numeric_limits<double>::epsilon() * cap.volume;
  m.status = immersed ? Status::kContained : Status::kOk;
  return m;
}

}  // namespace volcontact
