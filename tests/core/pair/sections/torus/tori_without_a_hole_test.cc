// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
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
  Mat3 upright = Mat3::with_columns(Vec3::UnitX(), Vec3::UnitZ(), -Vec3::UnitY());
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
      sum +=
          test::common_length(in_ring, in_body) * std::sin(t) * GaussRule<8>::kWeights[layer % 8];
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
  for (int i = 0; i < test::cases(400, 120, 15); ++i) {
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
  EXPECT_GE(seen, test::cases(350, 100, 10));
}

// What a cone that leaves the apex along `axis` and is cut off at `from` has in common with a ring,
// which the base is out of reach of: rays from the apex.
double volume_of_rays(const ImplicitSolid& ring, const Vec3& apex, const Mat3& frame, double slope,
                      double from, int rays, int parts) {
  const double least = 1.0 / std::sqrt(1.0 + slope * slope);
  test::LineParts in_ring;
  double sum = 0.0;
  for (int i = 0; i < 8 * parts; ++i) {
    const double cosine = least + (1.0 - least) * (i / 8 + GaussRule<8>::kNodes[i % 8]) / parts;
    const double sine = std::sqrt(1.0 - cosine * cosine);
    for (int k = 0; k < rays; ++k) {
      const double turn = 2.0 * kPi * (k + 0.5) / rays;
      const Vec3 along = frame * Vec3(sine * std::cos(turn), sine * std::sin(turn), cosine);
      test::SolidLines of_ring(ring, along);
      of_ring.parts(apex, 1.0, in_ring);
      for (const auto& part : in_ring) {
        const double a = std::max(part.enter, from / cosine), b = std::max(part.leave, a);
        sum += (b * b * b - a * a * a) / 3.0 * GaussRule<8>::kWeights[i % 8];
      }
    }
  }
  return sum * (1.0 - least) / parts * 2.0 * kPi / rays;
}

// Cones with their tips, sharp or blunt, on the axis or beside it: next to nothing of them is in
// half-planes behind a plane along the axis that touches the cone, and before it a section grows
// like the root of the angle.
TEST(ToriWithoutAHole, AConeHasItsTipAtTheAxis) {
  test::Random random(43);
  for (int i = 0; i < test::cases(400, 120, 20); ++i) {
    const double r = random.uniform(0.05, 0.15), R = r * kBy[i % 5];
    const double slope = random.log_uniform(0.1, 5.0), half = random.uniform(2.0, 3.0) * r;
    const double beside = i % 4 == 0 ? 0.0 : random.log_uniform(1e-8, 0.03) * r;
    const double tip = i % 3 == 0 ? 0.0 : slope * random.log_uniform(1e-8, 0.1) * r;
    const double wide = tip + 2.0 * half * slope;
    // The middle of the tip is near the origin of the ring, and the body lies towards -a.
    const double lean = i % 2 == 0 ? 0.0 : random.uniform(-1.2, 1.2);
    const Mat3 rotation = test::turn(Vec3::UnitZ(), random.uniform(0.0, 2.0 * kPi)) *
                          test::turn(Vec3::UnitX(), 0.5 * kPi + lean);
    const Vec3 a = rotation.col(2);
    const Vec3 end(beside * random.uniform(-1.0, 1.0), beside * random.uniform(-1.0, 1.0),
                   i % 7 < 3 ? 0.0 : random.uniform(-0.5, 0.5) * r);
    const Pose X{rotation, end - half * a};
    const ImplicitSolid of_ring = ImplicitSolid::torus(R, r);
    const Vec3 apex = end + tip / slope * a;
    const Mat3 frame = rotation * Vec3(1.0, -1.0, -1.0).asDiagonal();
    const double expected = volume_of_rays(of_ring, apex, frame, slope, tip / slope, 120, 6);
    const double again = volume_of_rays(of_ring, apex, frame, slope, tip / slope, 90, 4);
    const double doubt = 2.0 * std::abs(expected - again) + 2e-5 * expected;
    const Shape ring = Torus({.major_radius = R, .minor_radius = r});
    const Shape body = Frustum({.bottom_radius = wide, .top_radius = tip, .half_length = half});
    for (const VolumeMetrics& m :
         {evaluated(ring, body, X).total, evaluated(body, ring, X.inverse()).total}) {
      EXPECT_NEAR(m.volume, expected, m.volume_error + doubt)
          << i << ": " << R / r - 1.0 << " " << slope << " " << beside << " " << tip << " " << lean;
    }
  }
}

}  // namespace
}  // namespace volcontact::tori_without_a_hole_test
