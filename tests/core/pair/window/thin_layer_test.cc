// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "core/support/evaluated.h"
#include "core/support/random.h"
#include "volcontact/pair/window/convex_window.h"

namespace volcontact::thin_layer_test {
namespace {

using test::evaluated;

// The end of a drum, at z = kEnd, and a face of a box or of a drum, nearly in one plane: how far
// the second reaches behind the first is linear, and V a sum over squares of the common footprint.
constexpr double kRadius = 0.3, kEnd = 0.2, kWide = 0.25, kLong = 0.4, kThick = 0.05;

struct Case {
  bool box;
  Pose X;

  double volume() const {
    constexpr int kSquares = 500;
    const double reach_x = box ? kWide : kLong, reach_y = kLong, side_x = 2.0 * reach_x / kSquares,
                 side_y = 2.0 * reach_y / kSquares;
    const Vec3 &u = X.rotation.col(0), &v = X.rotation.col(1), &w = X.rotation.col(2);
    const Vec3 middle = X.translation - kThick * w;
    const double low = middle.z() - kEnd;
    double sum = 0.0;
    for (int i = 0; i < kSquares; ++i) {
      for (int j = 0; j < kSquares; ++j) {
        const double x = (i + 0.5) * side_x - reach_x, y = (j + 0.5) * side_y - reach_y;
        if (!box && x * x + y * y > kLong * kLong) continue;
        const Vec3 flat = middle + x * u + y * v;
        if (flat.head<2>().squaredNorm() > kRadius * kRadius) continue;
        sum += std::max(0.0, -(low + x * u.z() + y * v.z()));
      }
    }
    return sum * side_x * side_y;
  }
};

Case random_case(test::Random& random) {
  const double lean = random.log_uniform(1e-11, 1e-8), depth = lean * random.uniform(0.01, 0.3);
  const double at = random.uniform(0.0, 2.0 * kPi), far = random.uniform(0.2, 0.6);
  const double to = random.uniform(0.0, 2.0 * kPi);
  Case c{random.uniform() < 0.5, {}};
  c.X.rotation = Eigen::AngleAxisd(lean, Vec3(std::cos(to), std::sin(to), 0)).toRotationMatrix() *
                 Eigen::AngleAxisd(random.uniform(0.0, 6.0), Vec3::UnitZ()).toRotationMatrix();
  c.X.translation = Vec3(far * std::cos(at), far * std::sin(at), 0.0);
  c.X.translation.z() = kEnd + kThick - depth;
  return c;
}

TEST(ThinLayer, FacesNearlyInOnePlaneAreNotMissed) {
  test::Random random(11);
  const Cylinder a({.radius = kRadius, .half_length = kEnd});
  int touching = 0;
  for (int i = 0; i < 120; ++i) {
    const Case c = random_case(random);
    const Shape b = c.box ? Shape(Box({.half_sizes = {kWide, kLong, kThick}}))
                          : Shape(Cylinder({.radius = kLong, .half_length = kThick}));
    const double expected = c.volume();
    // To 2 per cent: not to be missed is what is looked for. Faces of which one reaches past the
    // other by less than 1e-12 of their place are one.
    const double slack = 2e-2 * expected + 1e-12 * kRadius * kRadius;
    const double ab = evaluated(a, b, c.X).total.volume,
                 ba = evaluated(b, a, c.X.inverse()).total.volume;
    EXPECT_NEAR(ab, expected, slack) << i;
    EXPECT_NEAR(ba, expected, slack) << i;
    touching += expected > 0.0 ? 1 : 0;
  }
  EXPECT_GT(touching, 80);
}

}  // namespace
}  // namespace volcontact::thin_layer_test
