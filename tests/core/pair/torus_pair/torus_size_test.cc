// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/torus_pair/torus_size.h"

#include <gtest/gtest.h>

#include "core/support/random.h"

namespace volcontact::torus_size_test {
namespace {

constexpr TorusSize kRing{0.3, 0.1};

TEST(TorusSize, SectionCirclesLieOnTheSurface) {
  test::Random random(1);
  for (int i = 0; i < 50; ++i) {
    const Pose X{random.rotation(), random.in_box(1.0)};
    const Circle circle = section_circle(kRing, X, random.uniform(-4.0, 4.0));
    const Vec3 x = X.inverse() * circle.at(random.uniform(-4.0, 4.0));
    EXPECT_NEAR(torus_value(kRing, x), 0.0, 1e-15);
  }
}

TEST(TorusSize, ValueIsNegativeInside) {
  EXPECT_LT(torus_value(kRing, {0.35, 0.0, 0.0}), 0.0);
  EXPECT_GT(torus_value(kRing, {0.0, 0.0, 0.0}), 0.0);
  EXPECT_DOUBLE_EQ(torus_value(kRing, {0.3, 0.0, 0.0}), -0.01);
}

// Beside each other in one plane, and one tube within the other.
TEST(TorusSize, TouchIsWhatTwoBallsHaveInCommon) {
  const Pose beside{Mat3::Identity(), {0.75, 0.0, 0.0}};
  const TorusTouch touch = touch_of(kRing, beside, kRing, kPi);
  EXPECT_NEAR(touch.depth, 0.05, 1e-15);
  EXPECT_LE((touch.middle - Vec3(0.375, 0.0, 0.0)).norm(), 1e-15);
  EXPECT_NEAR(touch_of({0.3, 0.02}, Pose{}, kRing, 1.0).depth, 0.04, 1e-15);
  EXPECT_LT(touch_of(kRing, beside, kRing, 0.0).depth, 0.0);
}

}  // namespace
}  // namespace volcontact::torus_size_test
