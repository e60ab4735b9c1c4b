// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/torus_pair/torus_patch.h"

#include <gtest/gtest.h>

#include "core/support/random.h"
#include "core/support/sanitized.h"

namespace volcontact::torus_patch_test {
namespace {

constexpr TorusSize kRing{0.3, 0.1};
constexpr PatchEffort kEffort{1e-6, false, 8};

// Area of the patch, from its arcs: dS = r (R + r cos) on a circle.
double area_of(const TorusSize& ring, const TorusPatch& patch) {
  double sum = 0.0;
  for (const TorusPatch::Slice& slice : patch.slices) {
    for (int i = slice.first; i < slice.last; ++i) {
      const TorusPatch::Arc& arc = patch.arcs[i];
      sum += slice.weight * ring.minor *
             (ring.major * (arc.high - arc.low) +
              ring.minor * (std::sin(arc.high) - std::sin(arc.low)));
    }
  }
  return sum;
}

TEST(TorusPatch, AllOfARingLiesInAThickerOne) {
  TorusPatchScratch scratch;
  const TorusSize thin{0.3, 0.03};
  find_patch(thin, {test::turn(Vec3::UnitX(), 0.05), {0.0, 0.01, 0.0}}, kRing, kEffort, scratch);
  EXPECT_NEAR(area_of(thin, scratch.patch), 4.0 * kPi * kPi * 0.3 * 0.03, 1e-12);
  EXPECT_EQ(scratch.patch.chains, 1);
}

TEST(TorusPatch, SaysWhenRingsAreApart) {
  TorusPatchScratch scratch;
  find_patch(kRing, {Mat3::Identity(), {0.8 + 1e-9, 0.0, 0.0}}, kRing, kEffort, scratch);
  EXPECT_TRUE(scratch.patch.apart);
  find_patch(kRing, {Mat3::Identity(), {0.8 - 1e-9, 0.0, 0.0}}, kRing, kEffort, scratch);
  EXPECT_FALSE(scratch.patch.apart);
  EXPECT_EQ(scratch.patch.chains, 1);
}

// Against the share of places on a fine grid of the surface.
TEST(TorusPatch, AreaIsThatOfPlacesInside) {
  test::Random random(1);
  TorusPatchScratch scratch;
  constexpr int kSteps = 400;
  for (int i = 0; i < test::cases(20, 4); ++i) {
    const Pose X{random.rotation(), random.in_box(0.4)};
    find_patch(kRing, X, kRing, kEffort, scratch);
    double expected = 0.0;
    for (int k = 0; k < kSteps; ++k) {
      const Circle circle = section_circle(kRing, X, 2.0 * kPi * (k + 0.5) / kSteps);
      for (int j = 0; j < kSteps; ++j) {
        const double angle = 2.0 * kPi * (j + 0.5) / kSteps;
        if (torus_value(kRing, circle.at(angle)) < 0.0) {
          expected += kRing.minor * (kRing.major + kRing.minor * std::cos(angle));
        }
      }
    }
    expected *= 4.0 * kPi * kPi / (kSteps * kSteps);
    EXPECT_NEAR(area_of(kRing, scratch.patch), expected, 2e-3);
  }
}

// The circle of a ring that stands upright in the hole of another one passes through its tube on
// two sides: two chains, each between two events.
TEST(TorusPatch, EventsBoundEveryChain) {
  TorusPatchScratch scratch;
  const TorusSize thin{0.3, 0.02};
  find_patch(thin, {test::turn(Vec3::UnitX(), 0.5 * kPi), Vec3::Zero()}, kRing, kEffort, scratch);
  EXPECT_EQ(scratch.patch.nearest.size(), 2u);
  const double touch = std::acos((2.0 * 0.3 * 0.3 - 0.12 * 0.12) / (2.0 * 0.3 * 0.3));
  for (const TorusPatch::Slice& slice : scratch.patch.slices) {
    // No arc beyond the ball that touches.
    EXPECT_LE(std::abs(std::remainder(slice.angle, kPi)), touch + 1e-9);
  }
}

}  // namespace
}  // namespace volcontact::torus_patch_test
