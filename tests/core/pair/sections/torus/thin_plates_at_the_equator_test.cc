// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "core/reference/implicit_solid.h"
#include "core/support/evaluated.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"

namespace volcontact::thin_plates_at_the_equator_test {
namespace {

using test::evaluated, test::ImplicitSolid;

// The plate lies across x, and the ring's center at -`distance`. Lines along x, in the window of
// half sizes y and z of the plate's frame that the overlap is in.
double volume_of_lines(const ImplicitSolid& plate, const ImplicitSolid& ring, double y, double z,
                       int lines) {
  test::SolidLines of_plate(plate, Vec3::UnitX()), of_ring(ring, Vec3::UnitX());
  test::LineParts in_plate, in_ring;
  double sum = 0.0;
  for (int i = 0; i < lines; ++i) {
    for (int k = 0; k < lines; ++k) {
      const Vec3 o(0.0, y * (2.0 * (i + 0.5) / lines - 1.0), z * (2.0 * (k + 0.5) / lines - 1.0));
      of_ring.parts(o, 2.0, in_ring);
      if (in_ring.count == 0) continue;
      of_plate.parts(o, 2.0, in_plate);
      sum += test::common_length(in_ring, in_plate);
    }
  }
  return sum * 4.0 * y * z / lines / lines;
}

// An ellipsoid as thin as a sheet on the outer equator of a ring, about as deep as it is thick: in
// the middle of the range of half-planes it leaves the disc or not, and the sections, which are
// symmetric, show that in few of them.
TEST(ThinPlatesAtTheEquator, VolumeIsAsGoodAsItClaims) {
  test::Random random(51);
  for (int i = 0; i < test::cases(60, 10, 4); ++i) {
    const double r = random.uniform(0.03, 0.1), R = i % 2 == 0 ? r : r * random.uniform(1.0, 3.0);
    const double half = random.log_uniform(1e-4, 3e-3),
                 depth = 2.0 * half * random.uniform(0.7, 1.3);
    const Vec3 axes(half, random.uniform(0.1, 0.4), random.uniform(0.1, 0.4));
    const double tilt = i % 3 == 0 ? random.uniform(-1e-3, 1e-3) : 0.0;
    const Pose X{test::turn(Vec3::UnitZ(), tilt), {depth - half - R - r, 0.0, 0.0}};
    const ImplicitSolid plate = ImplicitSolid::ellipsoid(axes);
    const ImplicitSolid of_ring = ImplicitSolid::torus(R, r).posed(X);
    const double y = 1.1 * std::sqrt(2.0 * (R + r) * depth), z = 1.1 * std::sqrt(2.0 * r * depth);
    const double expected = volume_of_lines(plate, of_ring, y, z, 250);
    const double again = volume_of_lines(plate, of_ring, y, z, 177);
    const double doubt = 2.0 * std::abs(expected - again) + 2e-5 * expected;
    const Shape ring = Torus({.major_radius = R, .minor_radius = r});
    const Shape body = Ellipsoid({.semi_axes = axes});
    for (const VolumeMetrics& m :
         {evaluated(body, ring, X).total, evaluated(ring, body, X.inverse()).total}) {
      EXPECT_NEAR(m.volume, expected, m.volume_error + doubt)
          << i << ": " << R << " " << r << " " << axes << " " << depth << " " << tilt;
    }
  }
}

}  // namespace
}  // namespace volcontact::thin_plates_at_the_equator_test
