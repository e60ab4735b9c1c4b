// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/surface_sweep/curve_family.h"

#include <gtest/gtest.h>

#include "core/support/random.h"

namespace volcontact::curve_family_test {
namespace {

std::vector<Shape> solids() {
  return {Sphere({.radius = 0.3}),
          Ellipsoid({.semi_axes = {0.4, 0.3, 0.2}}),
          Box({.half_sizes = {0.2, 0.3, 0.1}}),
          Cylinder({.radius = 0.2, .half_length = 0.3}),
          Frustum({.bottom_radius = 0.3, .top_radius = 0.1, .half_length = 0.2}),
          Frustum({.bottom_radius = 0.1, .top_radius = 0.3, .half_length = 0.2}),
          Torus({.major_radius = 0.3, .minor_radius = 0.1})};
}

// Curves lie in their face, their element is the product of the two tangents and looks out, and
// every place is on the curve that it is said to be on.
TEST(CurveFamily, CurvesMakeUpTheFace) {
  test::Random random(3);
  for (const Shape& shape : solids()) {
    for (int round = 0; round < 4; ++round) {
      const Pose X{random.rotation(), random.in_box(0.3)};
      SweepSolids s;
      ASSERT_TRUE(s.read(shape, X, HalfSpace(), {}, Vec3::Constant(0.25)));
      for (const SweepFace& face : s.faces) {
        const CurveFamily family(face, s.half);
        if (family.empty()) continue;
        for (int i = 0; i < 10; ++i) {
          const double u = family.low() + (family.high() - family.low()) * random.uniform(0.1, 0.9);
          const double t = face.kind == SweepFace::Kind::kCone ? random.uniform(0.05, 0.3)
                                                               : random.uniform(0.1, 3.0);
          const Vec3 x = family.curve(u).at(t);
          const double size = 1.0 + x.squaredNorm();
          EXPECT_NEAR(face.value(x), 0.0, 1e-11 * size) << name_of(shape);
          const double h = 1e-6;
          const Vec3 x_u = (family.curve(u + h).at(t) - family.curve(u - h).at(t)) / (2.0 * h);
          const Vec3 x_t = (family.curve(u).at(t + h) - family.curve(u).at(t - h)) / (2.0 * h);
          const Vec3 n = family.element(u, t, x);
          EXPECT_NEAR(n.norm(), x_u.cross(x_t).norm(), 1e-7 * size) << name_of(shape);
          EXPECT_LE(std::abs(n.dot(x_u)) + std::abs(n.dot(x_t)), 1e-7 * size);
          EXPECT_GT(face.value(x + 1e-4 * n.normalized()), 0.0) << name_of(shape);
          double u_found, t_found;
          family.locate(x, u_found, t_found);
          EXPECT_LE((family.curve(u_found).at(t_found) - x).norm(), 1e-12 * size);
          EXPECT_NEAR(u_found, u, 1e-9 * size);
        }
      }
    }
  }
}

// No place of the face within the box is on a curve out of the range.
TEST(CurveFamily, TheRangeHoldsTheBox) {
  test::Random random(8);
  const Vec3 half(0.2, 0.1, 0.05);
  int inside = 0;
  for (const Shape& shape : solids()) {
    for (int round = 0; round < 6; ++round) {
      const Pose X{random.rotation(), random.in_box(0.3)};
      SweepSolids s;
      ASSERT_TRUE(s.read(shape, X, HalfSpace(), {}, half));
      for (const SweepFace& face : s.faces) {
        const CurveFamily family(face, half), all(face, Vec3::Constant(3.0));
        for (int i = 0; i < 2000; ++i) {
          const double u = all.low() + (all.high() - all.low()) * random.uniform();
          const Vec3 x = all.curve(u).at(random.uniform(-1.0, 6.0));
          if (x.cwiseAbs().exceeds(half)) continue;
          ++inside;
          double u_here, t_here;
          family.locate(x, u_here, t_here);
          EXPECT_GE(u_here, family.low() - 1e-9) << name_of(shape);
          EXPECT_LE(u_here, family.high() + 1e-9) << name_of(shape);
        }
      }
    }
  }
  EXPECT_GT(inside, 100);
}

}  // namespace
}  // namespace volcontact::curve_family_test
