// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/torus/torus_sites.h"

#include <gtest/gtest.h>

#include "core/support/random.h"

namespace volcontact::torus_sites_test {
namespace {

constexpr double kMajor = 0.3, kMinor = 0.1;

struct Found {
  FaceSet faces;
  std::vector<TorusExit> exits;
  TorusSection sections;
  TorusSites sites;
};

template <typename Body>
std::vector<TorusRange> ranges(const Body& body, const Pose& X) {
  Found found;
  FaceWriter writer(found.faces, X, Owner::kB);
  writer.write(body);
  found.sections.set(found.faces, kMajor, kMinor);
  find_torus_sites(ConvexView(body), X, best_simd_path(), found.exits, found.sections, found.sites);
  return found.sites.ranges;
}

double wrapped(double angle) { return angle - 2.0 * kPi * std::floor(angle / (2.0 * kPi) + 0.5); }

// A ball beside the tube is seen from the axis under the angle of their lens, here in the plane of
// the ring: its corner lies on both circles.
TEST(TorusSites, ABallFromOutsideIsOneRangeOfTheWidthOfTheLens) {
  const double r = 0.2;
  for (double depth : {1e-9, 1e-6, 1e-3, 0.1}) {
    for (double turn : {0.0, 1.0, 3.1}) {
      const double d = kMajor + kMinor + r - depth;
      const Pose X{Mat3::Identity(), {d * std::cos(turn), d * std::sin(turn), 0.0}};
      const std::vector<TorusRange> found = ranges(Sphere({.radius = r}), X);
      ASSERT_EQ(found.size(), 1u) << "depth " << depth;
      const double R = kMajor + kMinor;
      const double half = std::acos((R * R + d * d - r * r) / (2.0 * R * d));
      EXPECT_FALSE(found[0].whole);
      EXPECT_NEAR(wrapped(found[0].low - turn), -half, 3e-4 * half);
      EXPECT_NEAR(wrapped(found[0].high - turn), half, 3e-4 * half);
    }
  }
}

TEST(TorusSites, NothingIsFoundWhereNothingIs) {
  test::Random random(1);
  for (int i = 0; i < 200; ++i) {
    const double angle = random.uniform(0.0, 2.0 * kPi), gap = random.log_uniform(1e-12, 0.1);
    const double d = kMajor + kMinor + 0.2 + gap;
    const Pose X{Mat3::Identity(), {d * std::cos(angle), d * std::sin(angle), 0.0}};
    EXPECT_TRUE(ranges(Sphere({.radius = 0.2}), X).empty());
  }
  EXPECT_TRUE(ranges(Sphere({.radius = 0.19}), Pose{}).empty());  // in the hole
}

TEST(TorusSites, ABallInTheHoleIsAllRound) {
  const std::vector<TorusRange> found = ranges(Sphere({.radius = 0.2 + 1e-6}), Pose{});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].whole);
}

// A bar across the ring, wherever it lies: the ranges are those of its corners at the equator.
TEST(TorusSites, ABarAcrossIsTwoRanges) {
  test::Random random(2);
  for (int i = 0; i < 100; ++i) {
    const double turn = random.uniform(0.0, 2.0 * kPi), w = 0.01;
    const Pose X{test::turn(Vec3::UnitZ(), turn), Vec3::Zero()};
    const std::vector<TorusRange> found = ranges(Box({.half_sizes = {1.0, w, 0.3}}), X);
    ASSERT_EQ(found.size(), 2u);
    const double half = std::asin(w / (kMajor - kMinor));
    for (const TorusRange& range : found) {
      EXPECT_NEAR(range.high - range.low, 2.0 * half, 1e-3 * half);
      EXPECT_NEAR(std::sin(0.5 * (range.high + range.low) - turn), 0.0, 1e-3 * half);
    }
  }
}

}  // namespace
}  // namespace volcontact::torus_sites_test
