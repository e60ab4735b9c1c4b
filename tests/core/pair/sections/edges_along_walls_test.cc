// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/support/evaluated.h"
#include "core/support/random.h"

namespace volcontact::edges_along_walls_test {
namespace {

// The edge of a box along the wall of a cylinder, or along a face, by 1e-9 to 1e-4 of its size: a
// prism, of two right triangles. From a place at its end it seemed as short as deep.
TEST(EdgesAlongWalls, OverlapInAPrism) {
  test::Random random(3);
  for (int i = 0; i < 600; ++i) {
    const double r = random.uniform(0.02, 0.1), p = random.uniform(0.02, 0.06),
                 q = random.uniform(0.02, 0.06);
    const double h = random.uniform(0.02, 0.1), half = random.uniform(0.02, 0.1);
    const double depth = 0.1 * random.log_uniform(1e-9, 1e-4);
    const double turn = random.uniform(0.0, 6.0);
    const double lift = i % 2 == 0 ? 0.0 : random.uniform(-0.01, 0.01);
    const Shape wall = i % 3 == 0 ? Shape(Box({.half_sizes = {r, 0.15, h}}))
                                  : Shape(Cylinder({.radius = r, .half_length = h}));
    const double toward = i % 3 == 0 ? 0.0 : turn, reach = r + std::hypot(p, q) - depth;
    const double back = toward + kPi - std::atan2(q, p);
    const Pose X{Eigen::AngleAxisd(back, Vec3::UnitZ()).toRotationMatrix(),
                 {reach * std::cos(toward), reach * std::sin(toward), lift}};
    const Shape box(Box({.half_sizes = {p, q, half}}));
    const double length = std::min(h, lift + half) - std::max(-h, lift - half);
    const double expected = 0.5 * depth * depth * (p / q + q / p) * length;
    for (const bool mirrored : {false, true}) {
      const Interference out =
          mirrored ? test::evaluated(box, wall, X.inverse()) : test::evaluated(wall, box, X);
      EXPECT_NEAR(out.total.volume, expected,
                  (1e-5 + 30.0 * depth / std::min({r, p, q}) + 1e-15 / depth) * expected +
                      out.total.volume_error)
          << "case " << i << " depth " << depth << " mirrored " << mirrored;
    }
  }
}

}  // namespace
}  // namespace volcontact::edges_along_walls_test
