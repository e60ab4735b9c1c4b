// SPDX-License-Identifier: Apache-2.0
#include "volcontact/step/mechanism.h"

#include <gtest/gtest.h>

#include "core/support/free_bodies.h"
#include "core/support/random.h"

namespace volcontact::mechanism_test {
namespace {

// A body that flies and spins: w x (w x r), and nothing of where it flies to.
TEST(Mechanism, PointOfASpinningBodyIsHeldTowardsItsAxis) {
  test::Random random(1);
  for (int i = 0; i < 20; ++i) {
    test::FreeBodies bodies;
    bodies.add(1.0, Mat3::Identity());
    const Vec3 centre = random.in_box(1.0), w = random.in_box(5.0), r = random.in_box(0.5);
    const int body = bodies.add(2.0, Mat3::Identity(), centre, {w, random.in_box(3.0)});
    const Vec3 expected = w.cross(w.cross(r));
    EXPECT_LT((turning_acceleration(bodies, body, centre + r) - expected).norm(), 1e-13);
  }
}

TEST(Mechanism, WhatStandsHasNone) {
  test::FreeBodies bodies;
  bodies.add(1.0, Mat3::Identity(), Vec3::Zero(), {Vec3::UnitX(), Vec3::UnitY()});
  EXPECT_EQ(turning_acceleration(bodies, 0, Vec3::UnitX()), Vec3::Zero());
}

}  // namespace
}  // namespace volcontact::mechanism_test
