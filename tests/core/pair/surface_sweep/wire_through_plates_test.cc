// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "core/support/evaluated.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"

namespace volcontact::wire_through_plates_test {
namespace {

// A ring of wire goes twice through a plate, each time over a few thousandths of its turn. There it
// is straight: pi r^2 times its way through the plate.
constexpr double kMajor = 0.25, kWide = 0.3;

struct Case {
  double wire, thick;  // radius, half thickness
  bool round;          // an ellipsoid
  Pose X;              // of the plate, its normal along y

  double expected() const {
    const Vec3 n = X.rotation.col(1);
    const double across = std::hypot(n.x(), n.y()), at = n.dot(X.translation) / (kMajor * across);
    double sum = 0.0;
    for (const double side : {-1.0, 1.0}) {
      const double angle = std::atan2(n.y(), n.x()) + side * std::acos(at);
      const Vec3 x(kMajor * std::cos(angle), kMajor * std::sin(angle), 0.0);
      const Vec3 along(-std::sin(angle), std::cos(angle), 0.0);
      const Vec3 in_plate = X.rotation.transpose() * (x - X.translation) / kWide;
      const double share =
          round ? std::sqrt(1.0 - in_plate.x() * in_plate.x() - in_plate.z() * in_plate.z()) : 1.0;
      sum += kPi * wire * wire * 2.0 * thick * share / std::abs(n.dot(along));
    }
    return sum;
  }
  Shape plate() const {
    const Vec3 half(kWide, thick, kWide);
    return round ? Shape(Ellipsoid({.semi_axes = half})) : Shape(Box({.half_sizes = half}));
  }
};

Case random_case(test::Random& random) {
  Case c{
      random.log_uniform(2e-5, 1e-3), random.log_uniform(2e-5, 1e-3), random.uniform() < 0.5, {}};
  c.X.rotation = rotation_about(random.direction(), random.log_uniform(1e-5, 0.2));
  c.X.translation = random.log_uniform(1e-6, 0.02) * random.direction();
  return c;
}

void expect_right(const Case& c, Engine engine, int number) {
  const Torus ring({.major_radius = kMajor, .minor_radius = c.wire});
  const Interference found = test::evaluated(ring, c.plate(), c.X, engine);
  const double expected = c.expected();
  EXPECT_NEAR(found.total.volume, expected, found.total.volume_error + 1e-3 * expected)
      << number << ' ' << to_string(found.engine);
  EXPECT_EQ(found.sites.size(), 2u) << number << ' ' << to_string(found.engine);
}

TEST(WireThroughPlates, IsFoundOnBothSides) {
  test::Random random(61);
  for (int i = 0; i < test::cases(400, 100, 15); ++i) {
    expect_right(random_case(random), Engine::kAuto, i);
  }
}

TEST(WireThroughPlates, BySurfaceSweepToo) {
  test::Random random(62);
  for (int i = 0; i < test::cases(100, 30, 5); ++i) {
    expect_right(random_case(random), Engine::kSurfaceSweep, i);
  }
}

}  // namespace
}  // namespace volcontact::wire_through_plates_test
