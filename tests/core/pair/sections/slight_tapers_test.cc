// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/support/evaluated.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"

namespace volcontact::slight_tapers_test {
namespace {

using test::evaluated;

// A flat face cuts off a little of a rod along all its length. The plate is turned in its own
// frame, so that the way to the apex, however far away, has no round numbers.
TEST(SlightTapers, OfARodAlongAFace) {
  test::Random random(9);
  for (int i = 0; i < test::cases(2000, 150); ++i) {
    const double taper = random.log_uniform(1e-16, 1e-5) * (i % 2 ? 1.0 : -1.0);
    const double radius = random.uniform(0.02, 0.1), half = random.uniform(0.05, 0.3);
    const double depth = random.log_uniform(1e-2, 1.0) * radius;
    const Mat3 R = random.rotation();
    std::vector<Vec3> corners;
    for (int k = 0; k < 8; ++k) {
      corners.push_back(R * Vec3(k & 1 ? 1.0 : -1.0, k & 2 ? half : -half, k & 4 ? 0.2 : -0.2));
    }
    const Shape plate = ConvexPolytope(corners);
    const Shape rod = Frustum({.bottom_radius = radius * (1.0 - taper),
                               .top_radius = radius * (1.0 + taper),
                               .half_length = 2.0 * half});
    const Pose X = Pose{R, Vec3::Zero()} *
                   Pose{test::turn(Vec3::UnitX(), 0.5 * kPi), Vec3(0.0, 0.0, 0.2 + radius - depth)};
    const auto cut = [&](double r) {
      const double angle = std::acos((radius - depth) / r);
      return 2.0 * half * r * r * (angle - 0.5 * std::sin(2.0 * angle));
    };
    const double expected = cut(radius);
    const double slack = cut(radius * (1.0 + std::abs(taper))) - expected + 1e-9 * expected;
    for (const VolumeMetrics& m : {evaluated(plate, rod, X, Engine::kLines).total,
                                   evaluated(rod, plate, X.inverse(), Engine::kLines).total}) {
      EXPECT_NEAR(m.volume, expected, m.volume_error + slack)
          << i << ": taper " << taper << ", depth " << depth;
      EXPECT_NEAR(m.volume, expected, 1e-4 * expected + slack) << i << ": taper " << taper;
    }
  }
}

}  // namespace
}  // namespace volcontact::slight_tapers_test
