// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/torus_pair/circle_arcs.h"

#include <gtest/gtest.h>

#include "core/support/random.h"

namespace volcontact::circle_arcs_test {
namespace {

constexpr TorusSize kRing{0.3, 0.1};

Circle flat_circle(const Vec3& center, double radius) {
  return {center, Vec3::UnitX(), Vec3::UnitY(), radius};
}
CircleArcs arcs_of(const Circle& circle, const TorusSize& ring = kRing,
                   ArcSearch search = ArcSearch::kArcs) {
  CircleArcs arcs;
  find_arcs(circle, ring, search, false, arcs);
  return arcs;
}

TEST(CircleArcs, ACoaxialCircleIsInsideOrOutsideAllRound) {
  EXPECT_TRUE(arcs_of(flat_circle(Vec3::Zero(), 0.35)).whole);
  EXPECT_TRUE(arcs_of(flat_circle(Vec3::Zero(), 0.45)).none());
  EXPECT_TRUE(arcs_of(flat_circle({0.0, 0.0, 0.05}, 0.25)).whole);
  EXPECT_TRUE(arcs_of(flat_circle({0.0, 0.0, 0.11}, 0.3)).none());
}

// On the surface all round: neither an arc nor a gap.
TEST(CircleArcs, ACircleOnTheSurfaceHasNoArc) {
  EXPECT_TRUE(arcs_of(flat_circle(Vec3::Zero(), 0.4)).none());
  EXPECT_TRUE(arcs_of(flat_circle({0.0, 0.0, 0.1}, 0.3)).none());
}

// Within the plane z = 0 the ring lies between circles of radius 0.2 and 0.4.
TEST(CircleArcs, AFlatCircleCrossesWhereTwoCirclesDo) {
  const double d = 0.35, r = 0.15;
  const CircleArcs arcs = arcs_of(flat_circle({d, 0.0, 0.0}, r));
  ASSERT_EQ(arcs.count, 1);
  const double outer = std::acos((0.4 * 0.4 - d * d - r * r) / (2.0 * d * r));
  EXPECT_NEAR(arcs.low[0], outer, 1e-12);
  EXPECT_NEAR(arcs.high[0], 2.0 * kPi - outer, 1e-12);
}

TEST(CircleArcs, AnUprightCircleHasTwoArcs) {
  const Circle wide{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitZ(), 0.35};
  const CircleArcs two = arcs_of(wide);
  ASSERT_EQ(two.count, 2);
  // rho = 0.35 cos, z = 0.35 sin and (rho - 0.3)^2 + z^2 = 0.1^2.
  const double end = std::acos((0.35 * 0.35 + 0.3 * 0.3 - 0.1 * 0.1) / (2.0 * 0.35 * 0.3));
  EXPECT_NEAR(two.high[0] - two.low[0], 2.0 * end, 1e-12);
  EXPECT_NEAR(two.high[1] - two.low[1], 2.0 * end, 1e-12);
}

TEST(CircleArcs, ATouchIsFoundBetweenThePlacesLookedAt) {
  for (double depth : {1e-3, 1e-6, 1e-9, 1e-12}) {
    for (double turn : {0.0, 0.05, 0.13, 1.0}) {
      const double r = 0.07;
      const Vec3 u(std::cos(turn), std::sin(turn), 0.0), v(-u.y(), u.x(), 0.0);
      const Circle circle{{0.4 + r - depth, 0.0, 0.0}, u, v, r};
      const CircleArcs arcs = arcs_of(circle);
      ASSERT_EQ(arcs.count, 1) << depth << ' ' << turn;
      // Two circles that touch from outside: (1/r + 1/R) (r w)^2 / 2 = depth.
      const double half = std::sqrt(2.0 * depth / (1.0 / r + 1.0 / 0.4)) / r;
      EXPECT_NEAR(arcs.high[0] - arcs.low[0], 2.0 * half, 0.02 * half);
      EXPECT_EQ(arcs_of(circle, kRing, ArcSearch::kCount).count, 1);
      const CircleArcs apart = arcs_of({{0.4 + r + depth, 0.0, 0.0}, u, v, r});
      EXPECT_TRUE(apart.none());
    }
  }
}

// Against the signs at many places.
TEST(CircleArcs, ArcsAreWhereValuesAreNegative) {
  test::Random random(1);
  constexpr int kPlaces = 500;
  int most = 0;
  for (int i = 0; i < 1000; ++i) {
    const Mat3 R = random.rotation();
    const TorusSize ring{random.uniform(0.1, 0.5), random.uniform(0.01, 0.1)};
    const Circle circle{random.in_box(0.2), R.col(0), R.col(1), random.uniform(0.05, 0.6)};
    const CircleArcs arcs = arcs_of(circle, ring);
    most = std::max(most, arcs.count);
    for (int k = 0; k < kPlaces; ++k) {
      const double angle = 2.0 * kPi * k / kPlaces, value = torus_value(ring, circle.at(angle));
      if (std::abs(value) < 1e-3 * ring.minor) continue;
      bool inside = arcs.whole;
      for (int j = 0; j < arcs.count; ++j) {
        const double from = arcs.low[j], to = arcs.high[j];
        inside = inside || (angle >= from && angle <= to) || angle + 2.0 * kPi <= to;
      }
      ASSERT_EQ(inside, value < 0.0) << i << ' ' << angle;
    }
  }
  EXPECT_GE(most, 2);
}

TEST(CircleArcs, MinimaAreWhereTheMiddleOfTheTubeIsNearest) {
  const CircleArcs arcs = arcs_of({{0.3, 0.0, 0.05}, Vec3::UnitY(), Vec3::UnitZ(), 0.06}, kRing,
                                  ArcSearch::kWithMinima);
  ASSERT_GE(arcs.minima, 1);
  bool found = false;
  for (int i = 0; i < arcs.minima; ++i)
    found = found || std::abs(arcs.nearest[i] - 1.5 * kPi) < 1.0;
  EXPECT_TRUE(found);
}

}  // namespace
}  // namespace volcontact::circle_arcs_test
