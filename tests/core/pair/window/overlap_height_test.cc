// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/support/random.h"
#include "volcontact/pair/window/overlap_window.h"

namespace volcontact::overlap_height_test {
namespace {

// The heights of an overlap over a place within both, in A's frame, forwards and back along e.
double extent(const Shape& a, const Shape& b, const Pose& X_AB, const Vec3& inside_A,
              const Vec3& e_A) {
  const SolidView view_a = view_of(a), view_b = view_of(b);
  CutPolytope hull, scratch;
  const OverlapWindow window = find_window(view_a, view_b, X_AB, hull, scratch);
  EXPECT_FALSE(window.apart);
  const Vec3 inside = window.X_AW.inverse() * inside_A;
  const Vec3 e = window.X_AW.rotation.transpose() * e_A;
  return overlap_height(view_a, view_b, window, hull, inside, e, scratch) +
         overlap_height(view_a, view_b, window, hull, inside, -e, scratch);
}

TEST(OverlapHeight, ALensIsAsHighAsItsCapsAndAsWideAsItsRim) {
  const double r = 0.04, s = 0.05, d = 0.07;
  const Shape a = Sphere({.radius = r}), b = Sphere({.radius = s});
  const Pose X_AB{Mat3::Identity(), Vec3(0.0, 0.0, d)};
  const double rim = (d * d + r * r - s * s) / (2.0 * d);  // its plane
  const Vec3 inside(0.0, 0.0, rim);
  EXPECT_NEAR(extent(a, b, X_AB, inside, Vec3::UnitZ()), r + s - d, 1e-5 * (r + s - d));
  const double wide = 2.0 * std::sqrt(r * r - rim * rim);
  EXPECT_NEAR(extent(a, b, X_AB, inside, Vec3::UnitX()), wide, 1e-5 * wide);
}

TEST(OverlapHeight, ACornerOfABoxInAnotherIsExact) {
  const Shape a = Box({.half_sizes = Vec3(0.03, 0.04, 0.05)}),
              b = Box({.half_sizes = Vec3(0.02, 0.02, 0.02)});
  const Pose X_AB{Mat3::Identity(), Vec3(0.04, 0.05, 0.06)};
  const Vec3 e = Vec3(1.0, 2.0, 2.0) / 3.0;
  EXPECT_NEAR(extent(a, b, X_AB, Vec3(0.025, 0.035, 0.045), e), 0.01 / 3.0 * 5.0, 1e-15);
}

// The rim of a cone, at which its normal is not unique: a corner of the hull on the plane of its
// end is cut off by the wall.
TEST(OverlapHeight, OfARimIsFoundByBothOfItsFaces) {
  test::Random random(7);
  for (int i = 0; i < 100; ++i) {
    const double bottom = random.uniform(0.02, 0.06), top = random.uniform(0.02, 0.06);
    const double half = random.uniform(0.02, 0.06);
    const Shape a = Frustum({.bottom_radius = bottom, .top_radius = top, .half_length = half}),
                b = Sphere({.radius = 0.05});
    // The ball's center above the rim of the upper end, which it holds in part.
    const double angle = random.uniform(0.0, 2.0 * kPi);
    const Vec3 rim(top * std::cos(angle), top * std::sin(angle), half);
    const Pose X_AB{random.rotation(), rim + Vec3(0.0, 0.0, 0.03)};
    const Vec3 inside = rim - 1e-3 * Vec3(std::cos(angle), std::sin(angle), 1.0);
    const Vec3 e = (rim - X_AB.translation + random.direction() * 0.01).normalized();
    // Against places of both, on lines through `inside`, nearer and nearer to the farthest one.
    const SolidView view_a = view_of(a), view_b = view_of(b);
    const auto climb = [&](const Vec3& up) {
      Vec3 best = up;
      double height = 0.0, step = 1.0;
      for (int k = 0; k < 6000; ++k) {
        const Vec3 way = (best + step * random.direction()).normalized();
        const RayInterval in_a = view_a.ray(view_a.solid, inside, way);
        const RayInterval in_b =
            view_b.ray(view_b.solid, X_AB.inverse() * inside, X_AB.rotation.transpose() * way);
        const double reached = std::min(in_a.leave, in_b.leave) * up.dot(way);
        if (reached > height) {
          height = reached;
          best = way;
        } else {
          step *= 0.998;
        }
      }
      return height;
    };
    const double known = climb(e) + climb(-e);
    const double found = extent(a, b, X_AB, inside, e);
    EXPECT_GE(found, (1.0 - 2e-5) * known) << i;
    EXPECT_LE(found, 1.001 * known) << i;  // the climb stops a little below
  }
}

}  // namespace
}  // namespace volcontact::overlap_height_test
