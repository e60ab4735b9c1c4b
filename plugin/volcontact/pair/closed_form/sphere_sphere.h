// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "volcontact/pair/closed_form/spherical_cap.h"
#include "volcontact/shape/sphere.h"

namespace volcontact {

/// 1 / k.
inline constexpr std::array<double, 56> kReciprocals = [] {
  std::array<double, 56> r{};
  for (int k = 1; k < 56; ++k) r[k] = 1.0 / k;
  return r;
}();

/// sum of x^k / k from k = 4 on = -log(1 - x) - x - x^2/2 - x^3/3, for 0 <= x <= 1, to full
/// relative accuracy.
inline double log_tail(double x) {
  constexpr double kSeriesEnd = 0.5;
  if (x > kSeriesEnd) {
    // Balls of one size that meet centre on centre have x = 1, where the logarithm ends.
    return -std::log1p(-std::min(x, 1.0 - 1e-16)) - x * (1.0 + x * (0.5 + x / 3.0));
  }
  // Terms until they fall below rounding: 12 for x < 1/32 (a shallow contact), else 52; even and
  // odd ones apart, so that the processor can do them at once.
  const double square = x * x;
  double even = 0.0, odd = 0.0;
  for (int k = x < 0.03125 ? 14 : 54; k >= 4; k -= 2) {
    even = even * square + kReciprocals[k];
    odd = odd * square + kReciprocals[k + 1];
  }
  return (even + x * odd) * square * square;
}

/// int V over the approach of two balls from first touch until they overlap by `overlap` along the
/// line of centres: the potential of V. docs/theory.md, "Lens".
inline double lens_depth_moment(double radius_a, double radius_b, double overlap) {
  const double sum = radius_a + radius_b, per_sum = 1.0 / sum;
  const double x = overlap * per_sum;
  const double q = (radius_a - radius_b) * per_sum;
  const double product = 4.0 * (radius_a * per_sum) * (radius_b * per_sum);
  const double tail = q != 0.0 ? 3.0 * q * q * log_tail(x) : 0.0;
  const double square = sum * sum;
  return kPi / 12.0 * square * square * (x * x * x * (product - 0.25 * x) - tail);
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
  const double per_distance = 1.0 / distance;
  const double h_a = 0.5 * overlap * (distance - (r_a - r_b)) * per_distance;
  const double h_b = 0.5 * overlap * (distance + (r_a - r_b)) * per_distance;
  const SphericalCap cap_a = spherical_cap(r_a, h_a), cap_b = spherical_cap(r_b, h_b);
  VolumeMetrics m;
  m.volume = cap_a.volume + cap_b.volume;
  if (!(m.volume > 0.0)) return VolumeMetrics{};

  const Vec3 axis = p_AB * per_distance;  // from A to B: A's cap lies beyond the plane
  const double share_a = cap_a.volume / m.volume, share_b = cap_b.volume / m.volume;
  const double offset = share_a * cap_a.centroid_depth - share_b * cap_b.centroid_depth;
  m.centroid = (r_a - h_a + offset) * axis;
  const double apart = cap_a.centroid_depth + cap_b.centroid_depth;
  const double axial =
      cap_a.axial_second + cap_b.axial_second + cap_a.volume * share_b * apart * apart;
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
