// SPDX-License-Identifier: Apache-2.0
#include "volcontact/force/volume_spring.h"

#include <gtest/gtest.h>

namespace volcontact::volume_spring_test {
namespace {

TEST(VolumeSpring, DoesNotKnowTheSpeed) {
  const VolumeSpring law({.stiffness = 3e8});
  for (double speed : {-10.0, 0.0, 10.0}) {
    const NormalOutput out =
        law.evaluate({.volume = 1e-7, .depth_moment = 1e-10, .approach_speed = speed}, {});
    EXPECT_DOUBLE_EQ(out.magnitude, 30.0);
    EXPECT_DOUBLE_EQ(out.elastic, 30.0);
    EXPECT_DOUBLE_EQ(out.elastic_energy, 0.03);
    EXPECT_EQ(out.rolling_damping, 0.0);
  }
}

TEST(VolumeSpring, RejectsZeroStiffness) {
  EXPECT_THROW(VolumeSpring({.stiffness = 0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace volcontact::volume_spring_test
