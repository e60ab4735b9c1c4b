// SPDX-License-Identifier: Apache-2.0
#include "volcontact/force/rolling.h"

#include <gtest/gtest.h>

namespace volcontact::rolling_test {
namespace {

// A slab of half sizes (0.3, 0.2, 0.01) pressed along z: int y^2 dV = V 0.04 / 3.
RollingInput slab() {
  RollingInput in;
  in.volume = 8.0 * 0.3 * 0.2 * 0.01;
  in.second_moment = (in.volume / 3.0 * Vec3(0.09, 0.04, 1e-4)).asDiagonal();
  in.rolling_damping = 1e3;
  in.normal_force = 1e9;  // far from the limit
  return in;
}

TEST(Rolling, IsTheMomentOfTheLocalDampingPressure) {
  RollingInput in = slab();
  in.angular_velocity = {2.0, 0.0, 0.0};
  const Vec3 torque = rolling_torque(in);
  EXPECT_DOUBLE_EQ(torque.x(), -1e3 * 2.0 * in.volume * 0.04 / 3.0);
  EXPECT_EQ(torque.y(), 0.0);
  in.angular_velocity = {0.0, 2.0, 0.0};
  EXPECT_DOUBLE_EQ(rolling_torque(in).y(), -1e3 * 2.0 * in.volume * 0.09 / 3.0);
}

TEST(Rolling, DoesNotResistSpin) {
  RollingInput in = slab();
  in.angular_velocity = {0.0, 0.0, 5.0};
  EXPECT_EQ(rolling_torque(in).norm(), 0.0);
}

TEST(Rolling, KeepsTheCentreOfPressureInsideThePatch) {
  RollingInput in = slab();
  in.normal_force = 10.0;
  in.angular_velocity = {1e6, 0.0, 0.0};
  const double arm = rolling_torque(in).norm() / in.normal_force;
  EXPECT_NEAR(arm, std::sqrt(2.0 * 0.04 / 3.0), 1e-12);  // sqrt(2) standard deviations
  EXPECT_LT(arm, 0.2);
}

TEST(Rolling, IsZeroWithoutDampingOrVolume) {
  RollingInput in = slab();
  in.angular_velocity = {1.0, 1.0, 0.0};
  in.rolling_damping = 0.0;
  EXPECT_EQ(rolling_torque(in).norm(), 0.0);
  EXPECT_EQ(rolling_torque({.rolling_damping = 1.0, .angular_velocity = {1.0, 0.0, 0.0}}).norm(),
            0.0);
}

}  // namespace
}  // namespace volcontact::rolling_test
