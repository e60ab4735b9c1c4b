// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/base/types.h"

namespace volcontact {

/// Integrals over the cap of height h (0 to 2 R) cut from a ball of radius R by a plane. Every one
/// is a product of sums without cancellation, so that thin caps keep full relative accuracy.
/// docs/theory.md, "Spherical cap".
struct SphericalCap {
  double volume;
  double cut_area;        ///< of the flat disc [m^2]
  double lateral_area;    ///< of the curved surface [m^2]
  double centroid_depth;  ///< distance of the centroid from the plane [m]
  double depth_moment;    ///< int (distance from the plane) dV [m^4]
  double axial_second;    ///< int (z - z_c)^2 dV along the axis, about the centroid [m^5]
  double lateral_second;  ///< int x^2 dV across the axis [m^5]
};

inline SphericalCap spherical_cap(double radius, double h) {
  const double r = radius;
  const double area = kPi * h * h;
  const double three_r = 3.0 * r - h, four_r = 4.0 * r - h;
  const double per_three_r = three_r > 0.0 ? 1.0 / three_r : 0.0;
  SphericalCap cap;
  cap.volume = (1.0 / 3.0) * area * three_r;
  cap.cut_area = kPi * h * (2.0 * r - h);
  cap.lateral_area = 2.0 * kPi * r * h;
  cap.centroid_depth = 0.25 * h * four_r * per_three_r;
  cap.depth_moment = (1.0 / 12.0) * area * h * four_r;
  cap.axial_second =
      (1.0 / 240.0) * area * h * h * (r * (40.0 * r - 24.0 * h) + 3.0 * h * h) * per_three_r;
  cap.lateral_second = (1.0 / 60.0) * area * h * (r * (20.0 * r - 15.0 * h) + 3.0 * h * h);
  return cap;
}

/// Inertia about the centroid of a body of revolution about the unit vector `axis`, from its second
/// moments along and across the axis.
inline Mat3 inertia_of_revolution(double axial, double lateral, const Vec3& axis) {
  return (axial + lateral) * Mat3::Identity() + outer((lateral - axial) * axis, axis);
}

}  // namespace volcontact
