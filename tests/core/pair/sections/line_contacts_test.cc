// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/support/evaluated.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"

namespace volcontact::line_contacts_test {
namespace {

// The edge of a box along the wall of a cylinder, or along a face, by 1e-9 to 1e-4 of its size: a
// prism, of two right triangles. From a place at its end it seemed as short as deep.
TEST(LineContacts, OfAnEdgeAreAPrism) {
  test::Random random(3);
  for (int i = 0; i < test::cases(600, 100); ++i) {
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
    const Pose X{rotation_about(Vec3::UnitZ(), back),
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
      if (i % 3 == 0) continue;  // clipped: the extent along S, which the end of a box may lean
      EXPECT_NEAR(out.total.depth, depth, (0.1 + 1e-15 / depth) * depth) << "case " << i;
    }
  }
}

// Across their axes: the area common to two discs.
double common_area(double r1, double r2, double depth) {
  const double D = r1 + r2 - depth, s1 = depth * (2.0 * r2 - depth) / (2.0 * D);
  const double half = std::sqrt(s1 * (2.0 * r1 - s1));
  constexpr int kSteps = 400;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double y = half * ((i + 0.5) / kSteps), y2 = y * y;
    sum += depth - y2 / (r1 + std::sqrt(r1 * r1 - y2)) - y2 / (r2 + std::sqrt(r2 * r2 - y2));
  }
  return 2.0 * half / kSteps * sum;
}

// Columns leaned along the cylinders by some 1e-5: the overlap of steel is that much longer than
// deep, so that its depth was up to 1.8 times too large, and its ends were steep faces, of which
// the surface seemed open: most such pairs were left to engines that take ten times as long.
TEST(LineContacts, OfCylindersAreAsDeepAsTheyAre) {
  test::Random random(4);
  for (int i = 0; i < test::cases(300, 50); ++i) {
    const double r1 = random.uniform(0.02, 0.1), r2 = random.uniform(0.02, 0.06),
                 h = random.uniform(0.02, 0.06), depth = 0.1 * random.log_uniform(1e-8, 1e-4);
    const double turn = random.uniform(0.0, 6.0), reach = r1 + r2 - depth;
    const Pose X{rotation_about(Vec3::UnitZ(), random.uniform(0.0, 6.0)),
                 {reach * std::cos(turn), reach * std::sin(turn), random.uniform(-0.01, 0.01)}};
    const Interference out = test::evaluated(Cylinder({.radius = r1, .half_length = 0.2}),
                                             Cylinder({.radius = r2, .half_length = h}), X);
    const double expected = 2.0 * h * common_area(r1, r2, depth), rounding = 1e-15 / depth;
    EXPECT_NEAR(out.total.volume, expected, (1e-5 + rounding) * expected + out.total.volume_error);
    EXPECT_NEAR(out.total.depth, depth, (0.02 + rounding) * depth) << "case " << i;
    EXPECT_EQ(out.engine, Engine::kLines) << "case " << i << " depth " << depth;
  }
}

}  // namespace
}  // namespace volcontact::line_contacts_test
