// SPDX-License-Identifier: Apache-2.0
// Overlaps of a rounded box: against closed forms, and against lines of other code.
#include <gtest/gtest.h>

#include "core/reference/line_lattice.h"
#include "core/support/sanitized.h"
#include "volcontact/pair/interference.h"

namespace volcontact::rounded_box_pairs_test {
namespace {

const Vec3 kHalf(0.15, 0.1, 0.12);
constexpr double kRadius = 0.04;
const RoundedBox kSolid({.half_sizes = kHalf, .radius = kRadius});

Interference overlap(const Shape& a, const Shape& b, const Pose& X_AB,
                     Engine engine = Engine::kAuto) {
  InterferenceWorkspace workspace;
  Interference out;
  interference(a, b, X_AB, {.engine = engine}, workspace, out);
  return out;
}

Csg cut(const Shape& from, const Shape& hole) {
  return Csg(Csg::Operation::kDifference, composed(from), composed(hole));
}

// Sections of the flat side: a rectangle with corners of rho^2 = r^2 - (r - z)^2 at the depth z.
double cap(double depth) {
  const double a = kHalf.x() - kRadius, b = kHalf.y() - kRadius, r = kRadius, u = r - depth;
  const double segment = 0.5 * (r * r * std::acos(u / r) - u * std::sqrt(r * r - u * u));
  const double squares = r * r * depth - (r * r * r - u * u * u) / 3.0;
  return 4.0 * a * b * depth + 4.0 * (a + b) * segment + kPi * squares;
}

// Which engine is taken by itself; what each is off by, against its own bound.
TEST(RoundedBoxPairs, OnAPlaneItIsTheCap) {
  for (const double depth : {1e-5, 1e-3, 0.02, 0.0399}) {
    const Pose X_AB{Mat3::Identity(), Vec3(0.02, 0.01, kHalf.z() - depth)};
    const Interference out = overlap(HalfSpace(), kSolid, X_AB);
    EXPECT_EQ(out.engine, Engine::kOctree) << depth;
    EXPECT_NEAR(out.total.volume, cap(depth), out.total.volume_error) << depth;
    EXPECT_LE(out.total.volume_error, 1e-3 * cap(depth)) << depth;
    // What is too much or missing lies within the solid.
    const double share = out.total.volume_error / out.total.volume;
    EXPECT_NEAR(out.total.centroid.x(), 0.02, share * kHalf.x()) << depth;
    EXPECT_NEAR(out.total.area_vector.x(), 0.0, 1e-5) << depth;
    if (depth < 1e-4) continue;
    const Interference swept = overlap(HalfSpace(), kSolid, X_AB, Engine::kSurfaceSweep);
    EXPECT_EQ(swept.engine, Engine::kSurfaceSweep) << depth;
    EXPECT_NEAR(swept.total.volume / cap(depth), 1.0, 1e-5) << depth;
  }
}

TEST(RoundedBoxPairs, OnABoxThatIsWiderItIsTheCapAgain) {
  const Box table({.half_sizes = Vec3(0.5, 0.5, 0.1)});
  const Pose X_AB{Mat3::Identity(), Vec3(0.02, 0.01, 0.1 + kHalf.z() - 2e-3)};
  const Interference out = overlap(table, kSolid, X_AB);
  EXPECT_NEAR(out.total.volume, cap(2e-3), out.total.volume_error);
  EXPECT_NEAR(overlap(table, kSolid, X_AB, Engine::kSurfaceSweep).total.volume / cap(2e-3), 1.0,
              1e-6);
}

// Corners and edges are parts of balls and tubes.
TEST(RoundedBoxPairs, CornerFirstItIsTheCapOfABall) {
  const Vec3 corner = Vec3::Ones().normalized();
  const Mat3 R = Vec3(1.0, -1.0, -1.0).asDiagonal() * basis_with_z(corner).transpose();
  const double depth = 5e-3, r = kRadius;
  const double height = kSolid.support_height(corner);
  const Interference out = overlap(HalfSpace(), kSolid, {R, Vec3(0.0, 0.0, height - depth)});
  const double ball_cap = kPi * depth * depth * (r - depth / 3.0);
  EXPECT_NEAR(out.total.volume, ball_cap, out.total.volume_error);
  const Interference swept =
      overlap(HalfSpace(), kSolid, {R, Vec3(0.0, 0.0, height - depth)}, Engine::kSurfaceSweep);
  EXPECT_NEAR(swept.total.volume / ball_cap, 1.0, 1e-6);
}

TEST(RoundedBoxPairs, AgreesWithLinesOfOtherCode) {
  const Shape others[] = {Box({.half_sizes = Vec3(0.12, 0.09, 0.1)}),
                          Cylinder({.radius = 0.1, .half_length = 0.12}),
                          Sphere({.radius = 0.13}),
                          Frustum({.bottom_radius = 0.12, .top_radius = 0.05, .half_length = 0.1}),
                          Torus({.major_radius = 0.15, .minor_radius = 0.05}),
                          kSolid,
                          cut(Box({.half_sizes = Vec3(0.15, 0.15, 0.1)}),
                              Cylinder({.radius = 0.07, .half_length = 0.2}))};
  test::Random random(19);
  int by_sweep = 0, all = 0;
  for (const Shape& other : others) {
    for (int i = 0; i < test::cases(6, 2, 2); ++i) {
      const Vec3 at = random.in_box(0.15);
      const Pose X_AB{random.rotation(), at};
      const Interference out = overlap(kSolid, other, X_AB, Engine::kSurfaceSweep);
      const Interference cells = overlap(kSolid, other, X_AB, Engine::kOctree);
      const test::LatticeVolume lines =
          test::lattice_volume(test::reference_solid(kSolid), test::reference_solid(other), X_AB,
                               kSolid.bounds(), 4000, random);
      ++all;
      by_sweep += out.engine == Engine::kSurfaceSweep;
      EXPECT_NEAR(out.total.volume, lines.volume, lines.error + out.total.volume_error + 1e-9)
          << name_of(other) << " " << i << " by " << to_string(out.engine);
      EXPECT_NEAR(cells.total.volume, lines.volume, lines.error + cells.total.volume_error + 1e-9)
          << name_of(other) << " " << i;
    }
  }
  EXPECT_GT(by_sweep, all * 3 / 4);
}

// What is cut out of a rounded box, and rounded boxes cut out of others.
TEST(RoundedBoxPairs, IsAMemberOfComposedSolids) {
  const Csg bored = cut(kSolid, Cylinder({.radius = 0.03, .half_length = 0.2}));
  // Of the bore, which leaves by the flat sides, only a tube is gone.
  const double gone = kPi * 0.03 * 0.03 * 2.0 * kHalf.z();
  EXPECT_NEAR(bored.own_metrics().volume, kSolid.own_metrics().volume - gone, 2e-3 * gone);
  const Sphere ball({.radius = 0.05});
  const Csg pocket = cut(Box({.half_sizes = Vec3(0.3, 0.3, 0.2)}), kSolid);
  test::Random random(23);
  for (const Csg& solid : {bored, pocket}) {
    for (int i = 0; i < 4; ++i) {
      const Pose X_AB{Mat3::Identity(), random.in_box(0.12)};
      const Interference out = overlap(solid, ball, X_AB);
      const test::LatticeVolume lines = test::lattice_volume(
          test::reference_solid(solid), test::reference_solid(ball), X_AB,
          {X_AB.translation - Vec3::Constant(0.05), X_AB.translation + Vec3::Constant(0.05)}, 4000,
          random);
      EXPECT_NEAR(out.total.volume, lines.volume, lines.error + out.total.volume_error + 1e-9) << i;
    }
  }
}

}  // namespace
}  // namespace volcontact::rounded_box_pairs_test
