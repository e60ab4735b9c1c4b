// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "core/support/evaluated.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"

namespace volcontact::rods_across_test {
namespace {

using test::evaluated;

// A cone along -y of the ring, its axis in the ring's plane, from its tip at y = `tip` outwards.
struct Cone {
  double tip_radius, base_radius, half_length, tip;

  double radius_at(double y) const {
    const double share = (tip - y) / (2.0 * half_length);
    if (share < 0.0 || share > 1.0) return 0.0;
    return tip_radius + share * (base_radius - tip_radius);
  }
  Pose pose() const {
    Mat3 R = {1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0};
    return {R, Vec3(0.0, tip - half_length, 0.0)};
  }
};

// Sums over half-planes and columns, two million of them: nothing of it is of the engines.
double volume_of_columns(double major, double minor, const Cone& cone) {
  constexpr int kAngles = 2000, kColumns = 1000;
  double widest = 0.0, sum = 0.0;
  for (int k = 0; k <= kColumns; ++k) {
    const double rho = major + minor * (2.0 * k / kColumns - 1.0);
    widest = std::max(widest, std::asin(std::min(1.0, cone.radius_at(-rho) / rho)));
  }
  for (int i = 0; i < kAngles; ++i) {
    // Dense at the end of the range.
    const double x = (i + 0.5) / kAngles, angle = widest * (1.0 - x * x);
    for (int k = 0; k < kColumns; ++k) {
      const double theta = kPi * (k + 0.5) / kColumns, rho = major - minor * std::cos(theta);
      const double radius = cone.radius_at(-rho * std::cos(angle)), across = rho * std::sin(angle);
      const double cut = radius * radius - across * across;
      if (!(cut > 0.0)) continue;
      const double half = std::min(std::sqrt(cut), minor * std::sin(theta));
      sum += 4.0 * half * rho * minor * std::sin(theta) * 2.0 * widest * x;
    }
  }
  return sum / kAngles * (kPi / kColumns);
}

// A pointed rod that reaches through a ring to its axis fills nearly all half-planes of its range
// and leaves the ring within the last twentieth: few half-planes see that, and on both sides
// alike. The small end near the axis lies in the hole and is no reason to look at less.
TEST(RodsAcross, PointedOnesThatEndAtTheAxis) {
  test::Random random(31);
  for (int i = 0; i < test::cases(60, 20, 4); ++i) {
    const double major = random.uniform(0.15, 0.4), minor = major * random.uniform(0.2, 0.6);
    const double base = random.uniform(0.02, 0.12);
    const Cone cone{base * random.log_uniform(1e-3, 0.1), base,
                    random.uniform(0.55, 0.9) * (major + minor),
                    major * random.uniform(-0.02, 0.02)};
    const Shape ring = Torus({.major_radius = major, .minor_radius = minor});
    const Shape rod = Frustum({.bottom_radius = cone.tip_radius,
                               .top_radius = cone.base_radius,
                               .half_length = cone.half_length});
    const double expected = volume_of_columns(major, minor, cone);
    const VolumeMetrics m = evaluated(ring, rod, cone.pose()).total;
    const VolumeMetrics n = evaluated(rod, ring, cone.pose().inverse()).total;
    EXPECT_NEAR(m.volume, expected, m.volume_error + 1e-5 * expected) << i;
    EXPECT_NEAR(n.volume, expected, n.volume_error + 1e-5 * expected) << i;
  }
}

}  // namespace
}  // namespace volcontact::rods_across_test
