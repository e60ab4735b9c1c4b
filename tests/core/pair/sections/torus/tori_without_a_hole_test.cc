// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "core/reference/implicit_solid.h"
#include "core/support/evaluated.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"
#include "volcontact/pair/quadrature/gauss.h"

namespace volcontact::tori_without_a_hole_test {
namespace {

using test::evaluated, test::ImplicitSolid;

// R by r: no hole, one that is rounding, and small ones.
constexpr double kBy[] = {1.0, 1.0 + 1e-15, 1.0 + 1e-12, 1.0 + 1e-9, 1.0 + 1e-4};

// A frame with its z axis in the plane of the face z = 0 of a body, but for `lean`.
Mat3 lying(double turn, double spin, double lean) {
  Mat3 upright;
  upright << Vec3::UnitX(), Vec3::UnitZ(), -Vec3::UnitY();
  return test::turn(Vec3::UnitZ(), turn) * test::turn(Vec3::UnitX(), lean) * upright *
         test::turn(Vec3::UnitZ(), spin);
}

// A face through the middle halves the ring, whichever way it leans.
TEST(ToriWithoutAHole, AWideFaceThroughTheMiddleHalvesThem) {
  const double r = 0.1;
  const Shape block = Cylinder({.radius = 0.5, .half_length = 0.3});
  for (const double by : kBy) {
    const double R = by * r;
    const Shape ring = Torus({.major_radius = R, .minor_radius = r});
    for (const double lean : {0.0, 1e-13, 1e-9, 1e-5, 1e-3, 0.01, 0.1}) {
      for (const double turn : {0.0, 0.7, 4.0}) {
        const Pose X{lying(turn, 1.1, lean), {0.02, -0.01, 0.3}};
        for (const VolumeMetrics& m :
             {evaluated(block, ring, X).total, evaluated(ring, block, X.inverse()).total}) {
          EXPECT_NEAR(m.volume, kPi * kPi * R * r * r, m.volume_error + 1e-6 * m.volume)
              << by << " " << lean << " " << turn;
        }
      }
    }
  }
}

// Lines along y of the body's frame, in planes z = const: nothing of it is of the engines.
double volume_of_lines(const ImplicitSolid& body, const ImplicitSolid& ring, double half_x,
                       double half_z, int lines, int parts) {
  test::SolidLines of_body(body, Vec3::UnitY()), of_ring(ring, Vec3::UnitY());
  test::LineParts in_body, in_ring;
  const double low = std::max(-half_x, ring.middle.x() - ring.radius);
  const double high = std::min(half_x, ring.middle.x() + ring.radius);
  const double bottom = std::max(-half_z, ring.middle.z() - ring.radius);
  const double top = std::min(half_z, ring.middle.z() + ring.radius);
  double sum = 0.0;
  for (int layer = 0; layer < 8 * parts; ++layer) {
    const double share = (layer / 8 + GaussRule<8>::kNodes[layer % 8]) / parts;
    const double z = bottom + (top - bottom) * share;
    for (int i = 0; i < lines; ++i) {
      const double t = kPi * (i + 0.5) / lines;
      const double x = 0.5 * (low + high) - 0.5 * (high - low) * std::cos(t);
      of_ring.parts({x, 0.0, z}, 2.0, in_ring);
      of_body.parts({x, 0.0, z}, 2.0, in_body);
      double length = 0.0;
      for (const auto& a : in_ring) {
        for (const auto& b : in_body) {
          length += std::max(0.0, std::min(a.leave, b.leave) - std::max(a.enter, b.enter));
        }
      }
      sum += length * std::sin(t) * GaussRule<8>::kWeights[layer % 8];
    }
  }
  return sum * (top - bottom) / parts * 0.5 * (high - low) * kPi / lines;
}

// Discs and cones with an end that holds the axis, or nearly: in half-planes beside that end they
// fill all of the disc, and next to nothing beyond it. Some of their rims leave the ring and come
// back at once, and some of their ends do not reach it.
TEST(ToriWithoutAHole, AnEndOfAPlateHoldsTheAxis) {
  test::Random random(41);
  int seen = 0;
  for (int i = 0; i < test::cases(400, 40); ++i) {
    const double r = random.uniform(0.05, 0.15), R = r * kBy[i % 5];
    const double half = random.log_uniform(1e-4, 0.3), radius = random.uniform(0.3, 2.5) * r;
    const double other = i % 2 == 0 ? radius : radius * random.uniform();
    const double lean = i % 3 == 0 ? 0.0 : random.log_uniform(1e-13, 1e-2);
    const double off = i % 4 == 0 ? 0.0 : random.log_uniform(1e-15, 1e-2) * (i % 8 < 4 ? 1 : -1);
    const double side = i % 16 < 8 ? 1.0 : -1.0;
    const Pose X{lying(random.uniform(0.0, 2.0 * kPi), random.uniform(0.0, 2.0 * kPi), lean),
                 {random.uniform(-1.3, 1.3) * r, random.uniform(-1.3, 1.3) * r, side * half + off}};
    const ImplicitSolid of_ring = ImplicitSolid::torus(R, r).posed(X);
    const ImplicitSolid of_body = ImplicitSolid::frustum(radius, other, half);
    const double expected = volume_of_lines(of_body, of_ring, radius, half, 1000, 3);
    const double again = volume_of_lines(of_body, of_ring, radius, half, 700, 2);
    if (!(expected > 0.0)) continue;
    ++seen;
    const double doubt = 3.0 * std::abs(expected - again) + 3e-4 * expected;
    const Shape ring = Torus({.major_radius = R, .minor_radius = r});
    const Shape body = Frustum({.bottom_radius = radius, .top_radius = other, .half_length = half});
    for (const VolumeMetrics& m :
         {evaluated(body, ring, X).total, evaluated(ring, body, X.inverse()).total}) {
      EXPECT_NEAR(m.volume, expected, m.volume_error + doubt)
          << i << ": " << R / r - 1.0 << " " << half << " " << radius << " " << other << " " << lean
          << " " << off;
    }
  }
  EXPECT_GE(seen, test::cases(350, 30));
}

}  // namespace
}  // namespace volcontact::tori_without_a_hole_test
