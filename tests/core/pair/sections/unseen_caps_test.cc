// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "core/support/evaluated.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"

namespace volcontact::unseen_caps_test {
namespace {

using test::evaluated;

// Of a body x^T M x <= 1 about the origin within a cylinder about z, from its end at `low` on:
// columns along z over rings and angles, nothing of it of the engines.
double volume_of_columns(const Mat3& M, double radius, double low) {
  constexpr int kRings = 700, kAngles = 700;
  double sum = 0.0;
  for (int i = 0; i < kRings; ++i) {
    const double r = radius * std::sqrt((i + 0.5) / kRings);
    for (int k = 0; k < kAngles; ++k) {
      const double angle = 2.0 * kPi * (k + 0.5) / kAngles;
      const Vec3 x(r * std::cos(angle), r * std::sin(angle), 0.0);
      const double a = M(2, 2), b = M.row(2).dot(x), c = x.dot(M * x) - 1.0;
      const double square = b * b - a * c;
      if (!(square > 0.0)) continue;
      const double root = std::sqrt(square);
      sum += std::max(0.0, (root - b) / a - std::max(low, (-root - b) / a));
    }
  }
  return sum * kPi * radius * radius / (kRings * kAngles);
}

// An ellipsoid about the axis of a cylinder that stands out of its wall by a hair, on both sides
// alike: half-planes pass beside the two caps, and what they see of the surface is closed.
TEST(UnseenCaps, OfEllipsoidsInCylinders) {
  test::Random random(61);
  for (int i = 0; i < test::cases(150, 50, 5); ++i) {
    const Vec3 axes(random.uniform(0.15, 0.4), random.uniform(0.05, 0.4),
                    random.uniform(0.05, 0.2));
    const Mat3 R = random.rotation();
    const Mat3 shape = R * axes.cwiseAbs2().asDiagonal() * R.transpose();
    // Its shadow along z is an ellipse.
    const double mean = 0.5 * (shape(0, 0) + shape(1, 1));
    const double reach =
        std::sqrt(mean + std::hypot(0.5 * (shape(0, 0) - shape(1, 1)), shape(0, 1)));
    const double radius = reach * (1.0 - random.log_uniform(1e-5, 1e-2));
    const double low = random.uniform(-0.5, 0.2) * std::sqrt(shape(2, 2)), half = 1.0;
    const double expected = volume_of_columns(shape.inverse(), radius, low);
    const Shape ball = Ellipsoid({.semi_axes = axes});
    const Shape tube = Cylinder({.radius = radius, .half_length = half});
    const Pose X{R.transpose(), R.transpose() * Vec3(0.0, 0.0, low + half)};
    for (const VolumeMetrics& m :
         {evaluated(ball, tube, X).total, evaluated(tube, ball, X.inverse()).total}) {
      EXPECT_NEAR(m.volume, expected, m.volume_error + 3e-5 * expected) << i;
    }
  }
}

}  // namespace
}  // namespace volcontact::unseen_caps_test
