// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "core/support/evaluated.h"
#include "core/support/meshes.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"
#include "volcontact/pair/mesh_columns/in_round/round_columns.h"

namespace volcontact::steep_faces_test {
namespace {

using test::box_soup;
using test::evaluated;
using test::mesh_of;

// V of a box below z = 0 and a ball about the origin: columns down from squares of the face.
double below_a_face(double x_half, double y_half, double deepest, double radius) {
  constexpr int kSquares = 3000;
  const double dx = 2.0 * x_half / kSquares, dy = 2.0 * y_half / kSquares;
  double sum = 0.0;
  for (int i = 0; i < kSquares; ++i) {
    const double x = (i + 0.5) * dx - x_half;
    for (int j = 0; j < kSquares; ++j) {
      const double y = (j + 0.5) * dy - y_half;
      const double square = radius * radius - x * x - y * y;
      if (square > 0.0) sum += std::min(std::sqrt(square), deepest);
    }
  }
  return sum * dx * dy;
}

// Few triangles of one shape, over which a rule and a rougher one err by the same: the middle of
// the ball lies on a face of the box, and columns end where the ball is steep.
TEST(SteepFaces, ABallInTheMiddleOfAFace) {
  const Vec3 half(.3, .2, .15);
  for (const int n : {1, 2, 3}) {
    const Mesh box = mesh_of(box_soup(half, n));
    for (const double radius : {.25, .35, .4, .45}) {
      const Sphere ball({.radius = radius});
      const double expected = below_a_face(.3, .2, .3, radius);
      const Pose X{Mat3::Identity(), Vec3(0, 0, .15)};
      for (const bool mesh_first : {true, false}) {
        const VolumeMetrics m =
            mesh_first ? evaluated(box, ball, X).total : evaluated(ball, box, X.inverse()).total;
        EXPECT_NEAR(m.volume, expected, m.volume_error + 1e-5 * expected) << n << " " << radius;
        EXPECT_NEAR(m.volume, expected, 2e-4 * expected) << n << " " << radius;
      }
    }
  }
}

// The face of a flat box lies in the middle of a ball: columns begin at the equator with an upright
// rise. Half of the ball, but for what is beside the box.
TEST(SteepFaces, HalfABallUnderItsEquator) {
  for (const int n : {1, 3}) {
    const Mesh box = mesh_of(box_soup({.3, .3, .2}, n));
    for (const double radius : {.05, .1, .2}) {
      const double expected = 2.0 / 3.0 * kPi * radius * radius * radius;
      const VolumeMetrics m =
          evaluated(box, Sphere({.radius = radius}), {Mat3::Identity(), Vec3(.01, .02, .2)}).total;
      EXPECT_NEAR(m.volume, expected, m.volume_error);
      EXPECT_NEAR(m.volume, expected, 1e-3 * expected);
    }
  }
}

// A capsule from above whose end reaches a box all over its top face: two triangles, alike.
TEST(SteepFaces, ACapsuleOverAllOfAFace) {
  const Vec3 half(.275, .179, .298);
  const Mesh box = mesh_of(box_soup(half));
  const double radius = .365, low = .36 - half.z();  // of the ball's middle over the face
  constexpr int kSquares = 3000;
  double expected = 0.0;
  for (int i = 0; i < kSquares; ++i) {
    const double x = half.x() * ((2.0 * i + 1.0) / kSquares - 1.0);
    for (int j = 0; j < kSquares; ++j) {
      const double y = half.y() * ((2.0 * j + 1.0) / kSquares - 1.0);
      expected += std::sqrt(radius * radius - x * x - y * y) - low;
    }
  }
  expected *= 4.0 * half.x() * half.y() / (kSquares * kSquares);
  const VolumeMetrics m = evaluated(box, Capsule({.radius = radius, .half_length = .15}),
                                    {Mat3::Identity(), Vec3(0, 0, .36 + .15)})
                              .total;
  EXPECT_NEAR(m.volume, expected, m.volume_error);
  EXPECT_NEAR(m.volume, expected, 1e-4 * expected);
}

// Upright in a face, or leaning by next to nothing: V goes with the length of the axis.
TEST(SteepFaces, AlmostUprightWallsAreAsUpright) {
  test::Random random(31);
  for (int i = 0; i < test::cases(300, 40); ++i) {
    const double radius = random.log_uniform(5e-3, 0.05), length = 0.1, deep = 0.12;
    const Mesh box = mesh_of(box_soup({.3, .4, .2}, 1 + i % 4));
    const double lean = random.log_uniform(1e-13, 1e-4), to = random.uniform(0.0, 2.0 * kPi);
    const bool capsule = i % 2 == 0;
    const Shape peg = capsule ? Shape(Capsule({.radius = radius, .half_length = length}))
                              : Shape(Cylinder({.radius = radius, .half_length = length}));
    Pose X;
    X.rotation = test::turn(Vec3(std::cos(to), std::sin(to), 0), lean);
    X.translation = Vec3(random.uniform(-.2, .2), random.uniform(-.3, .3), .2 + length - deep);
    const double section = kPi * radius * radius;
    const double expected = section * (deep + (capsule ? 2.0 / 3.0 * radius : 0.0));
    const VolumeMetrics m = evaluated(box, peg, X).total;
    EXPECT_NEAR(m.volume, expected, 2e-4 * expected) << i << " lean " << lean;
  }
}

}  // namespace
}  // namespace volcontact::steep_faces_test
