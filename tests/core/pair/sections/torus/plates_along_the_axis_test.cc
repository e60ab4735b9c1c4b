// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "core/reference/implicit_solid.h"
#include "core/support/evaluated.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"

namespace volcontact::plates_along_the_axis_test {
namespace {

using test::evaluated, test::ImplicitSolid;

// Lines across the plate, which lies across z.
double volume_of_lines(const ImplicitSolid& plate, const ImplicitSolid& ring, double radius,
                       int lines) {
  test::SolidLines of_plate(plate, Vec3::UnitZ()), of_ring(ring, Vec3::UnitZ());
  test::LineParts in_plate, in_ring;
  double sum = 0.0;
  for (int i = 0; i < lines; ++i) {
    for (int k = 0; k < lines; ++k) {
      const Vec3 o(radius * (2.0 * (i + 0.5) / lines - 1.0),
                   radius * (2.0 * (k + 0.5) / lines - 1.0), 0.0);
      of_plate.parts(o, 1.0, in_plate);
      if (in_plate.count == 0) continue;
      of_ring.parts(o, 1.0, in_ring);
      sum += test::common_length(in_ring, in_plate);
    }
  }
  return sum * 4.0 * radius * radius / lines / lines;
}

// A thin plate that lies in the tube of a ring, with a face that holds the axis: in half-planes
// all about that face there is none of it, nor in those that hold the face, and it fills a
// thousandth of the angle between two that are tried.
TEST(PlatesAlongTheAxis, NoneIsMissed) {
  test::Random random(7);
  int seen = 0;
  for (int i = 0; i < test::cases(6000, 2000, 300); ++i) {
    const double r = random.uniform(0.05, 0.15), R = i % 3 == 0 ? r : r * random.uniform(1.0, 1.6);
    const double half = random.log_uniform(1e-5, 3e-3), radius = random.uniform(0.2, 0.7) * r;
    const double other = radius * random.uniform(0.5, 1.0), side = i % 4 < 2 ? 1.0 : -1.0;
    const double lean = i % 5 == 0 ? 0.0 : random.log_uniform(1e-13, 1e-8) * side;
    const double off = i % 7 < 4 ? 0.0 : random.log_uniform(1e-16, 1e-12) * (i % 7 == 4 ? 1 : -1);
    Mat3 upright = Mat3::with_columns(Vec3::UnitX(), Vec3::UnitZ(), -Vec3::UnitY());
    const Mat3 lying = test::turn(Vec3::UnitZ(), random.uniform(0.0, 2.0 * kPi)) *
                       test::turn(Vec3::UnitX(), lean) * upright *
                       test::turn(Vec3::UnitZ(), random.uniform(0.0, 2.0 * kPi));
    const Vec3 aside(random.uniform(-1.0, 1.0) * (R + r), random.uniform(-1.0, 1.0) * (R + r), 0.0);
    const Pose X{lying, aside + Vec3(0.0, 0.0, side * half + off)};
    const ImplicitSolid plate = ImplicitSolid::frustum(radius, other, half);
    const ImplicitSolid of_ring = ImplicitSolid::torus(R, r).posed(X);
    const double expected = volume_of_lines(plate, of_ring, radius, 40);
    if (!(expected > 0.1 * plate.most_volume)) continue;
    ++seen;
    const Shape ring = Torus({.major_radius = R, .minor_radius = r});
    const Shape body = Frustum({.bottom_radius = radius, .top_radius = other, .half_length = half});
    for (const VolumeMetrics& m :
         {evaluated(body, ring, X).total, evaluated(ring, body, X.inverse()).total}) {
      EXPECT_NEAR(m.volume, expected, m.volume_error + 0.05 * expected)
          << i << ": " << R << " " << r << " " << half << " " << radius << " " << lean << " "
          << off;
    }
  }
  EXPECT_GE(seen, test::cases(2000, 600, 80));
}

}  // namespace
}  // namespace volcontact::plates_along_the_axis_test
