// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>

#include "volcontact/pair/closed_form/spherical_cap.h"
#include "volcontact/shape/sphere.h"

namespace volcontact {

/// sum of x^k / k from k = 4 on = -log(1 - x) - x - x^2/2 - x^3/3, for 0 <= x <= 1, to full relative
/// accuracy.
inline double log_tail(double x) {
  constexpr double kSeriesEnd = 0.5;
  if (x > kSeriesEnd) {
    // Balls of one size that meet centre on centre have x = 1, where the logarithm ends.
    return -std::log1p(-std::min(x, 1.0 - 1e-16)) - x * (1.0 + x * (0.5 + x / 3.0));
  }
  // Terms until they fall below rounding: 12 for x < 1/32 (a shallow contact), else 52.
  const int last = x < 0.03125 ? 15 : 55;
  double sum = 0.0;
  for (int k = last; k >= 4; --k) sum = sum * x + 1.0 / k;
  return sum * x * x * x * x;
}

/// int V over the approach of two balls from first touch until they overlap by `overlap` along the
/// line of centres: the potential of V. docs/theory.md, "Lens".
inline double lens_depth_moment(double radius_a, double radius_b, double overlap) {
  const double sum = radius_a + radius_b;
  const double x = overlap / sum;
  const double q = (radius_a - radius_b) / sum;
  const double product = 4.0 * (radius_a / sum) * (radius_b / sum);
  const double tail = 3.0 * q * q * log_tail(x);
  return kPi / 12.0 * sum * sum * sum * sum * (x * x * x * (product - 0.25 * x) - tail);
}

/// The smaller of two balls, inside the other: no direction, S = 0. depth and depth_moment continue
/// those of the lens.
inline VolumeMetrics contained_ball(const Sphere& a, const Sphere& b, const Vec3& p_AB,
                                    double distance) {
  const bool a_inside = a.radius() <= b.radius();
  const Sphere& inner = a_inside ? a : b;
  VolumeMetrics m = inner.own_metrics();
  if (!(m.volume > 0.0)) return VolumeMetrics{};
  m.centroid = a_inside ? Vec3(Vec3::Zero()) : p_AB;
  const double surface = 4.0 * kPi * inner.radius() * inner.radius();
  (a_inside ? m.area : m.counter_area) = surface;
  m.depth = 2.0 * inner.radius();
  m.depth_moment = lens_depth_moment(a.radius(), b.radius(), m.depth) +
                   m.volume * (std::abs(a.radius() - b.radius()) - distance);
  m.volume_error = 8.0 * std::numeric_limits<double>::epsilon() * m.volume;
  m.status = Status::kContained;
  return m;
}

/// Lens of two balls, in A: two caps on the plane through the circle where the spheres meet.
/// docs/theory.md, "Lens".
inline VolumeMetrics closed_form(const Sphere& a, const Sphere& b, const Pose& X_AB) noexcept {
  const Vec3& p_AB = X_AB.translation;
  const double r_a = a.radius(), r_b = b.radius();
  const double distance = p_AB.norm();
  const double overlap = r_a + r_b - distance;
  if (!(overlap > 0.0)) return VolumeMetrics{};
  if (distance <= std::abs(r_a - r_b)) return contained_ball(a, b, p_AB, distance);

  // Heights of A's cap (in B) and of B's cap (in A); they add up to the overlap.
  const double h_a = overlap * (distance - (r_a - r_b)) / (2.0 * distance);
  const double h_b = overlap * (distance + (r_a - r_b)) / (2.0 * distance);
  const SphericalCap cap_a = spherical_cap(r_a, h_a), cap_b = spherical_cap(r_b, h_b);
  VolumeMetrics m;
  m.volume = cap_a.volume + cap_b.volume;
  if (!(m.volume > 0.0)) return VolumeMetrics{};

  const Vec3 axis = p_AB / distance;  // from A to B: A's cap lies beyond the plane
  const double offset =
      (cap_a.volume * cap_a.centroid_depth - cap_b.volume * cap_b.centroid_depth) / m.volume;
  m.centroid = (r_a - h_a + offset) * axis;
  const double apart = cap_a.centroid_depth + cap_b.centroid_depth;
  const double axial = cap_a.axial_second + cap_b.axial_second +
                       cap_a.volume * (cap_b.volume / m.volume) * apart * apart;
  m.inertia = inertia_of_revolution(axial, cap_a.lateral_second + cap_b.lateral_second, axis);
  m.area_vector = cap_a.cut_area * axis;
  m.area = cap_a.lateral_area;
  m.counter_area = cap_b.lateral_area;
  m.depth_moment = lens_depth_moment(r_a, r_b, overlap);
  m.depth = overlap;
  m.volume_error = std::numeric_limits<double>::epsilon() *
                   (8.0 * m.volume + 4.0 * cap_a.cut_area * (r_a + r_b + distance));
  return m;
}

}  // namespace volcontact
