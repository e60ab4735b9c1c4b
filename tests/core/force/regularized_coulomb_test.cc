// SPDX-License-Identifier: Apache-2.0
#include "volcontact/force/regularized_coulomb.h"

#include <gtest/gtest.h>

namespace volcontact::regularized_coulomb_test {
namespace {

constexpr double kRounding = 1e-14;

FrictionInput patch(const Vec3& slip, double spin, double gyration_radius = 0.02) {
  return {.normal_force = 50.0,
          .normal = Vec3::UnitZ(),
          .slip = slip,
          .spin = spin,
          .patch = {.gyration_radius = gyration_radius}};
}

TEST(RegularizedCoulomb, IsCoulombBeyondTheSlipSpeed) {
  const RegularizedCoulomb law({.friction = 0.3, .slip_speed = 1e-3});
  const FrictionOutput out = law.evaluate(patch({0.3, -0.4, 0.0}, 0.0), {});
  EXPECT_NEAR((out.force - Vec3(-9.0, 12.0, 0.0)).norm(), 0.0, kRounding * 15.0);
  EXPECT_EQ(out.torque, 0.0);
  EXPECT_NEAR(out.slide_power, 0.3 * 50.0 * 0.5, kRounding * 7.5);
}

TEST(RegularizedCoulomb, PureSpinHasTorqueOfTheGyrationRadius) {
  const RegularizedCoulomb law({.friction = 0.3, .slip_speed = 1e-3});
  const FrictionOutput out = law.evaluate(patch(Vec3::Zero(), 10.0), {});
  EXPECT_EQ(out.force.norm(), 0.0);
  EXPECT_NEAR(out.torque, -0.3 * 50.0 * 0.02, kRounding);
}

// Contensou: fast spin leaves only mu f v / (r_g w) of the sliding friction.
TEST(RegularizedCoulomb, FastSpinWeakensSliding) {
  const RegularizedCoulomb law({.friction = 0.3, .slip_speed = 1e-3});
  const double spin = 1e4, slip = 1e-2;
  const FrictionOutput out = law.evaluate(patch({slip, 0.0, 0.0}, spin), {});
  EXPECT_NEAR(out.force.x() / (-0.3 * 50.0 * slip / (0.02 * spin)), 1.0, 1e-8);
}

TEST(RegularizedCoulomb, UncoupledHasNoSpinTorque) {
  const RegularizedCoulomb law({.friction = 0.3, .coupling = Coupling::kNone});
  const FrictionOutput out = law.evaluate(patch({0.5, 0.0, 0.0}, 1e3), {});
  EXPECT_NEAR(out.force.x(), -15.0, kRounding * 15.0);
  EXPECT_EQ(out.torque, 0.0);
}

TEST(RegularizedCoulomb, IsFiniteAndZeroAtRest) {
  const RegularizedCoulomb law({.friction = 0.3});
  const FrictionOutput out = law.evaluate(patch(Vec3::Zero(), 0.0), {});
  EXPECT_EQ(out.force.norm(), 0.0);
  EXPECT_EQ(out.torque, 0.0);
}

TEST(RegularizedCoulomb, OnlyDissipatesAndStaysInTheCone) {
  const RegularizedCoulomb law({.friction = 0.3, .slip_speed = 1e-2});
  for (double slip : {0.0, 1e-9, 1e-4, 5e-3, 1e-2, 1.0}) {
    for (double spin : {-30.0, -0.1, 0.0, 1e-6, 2.0}) {
      const FrictionOutput out = law.evaluate(patch({0.6 * slip, 0.8 * slip, 0.0}, spin), {});
      EXPECT_GE(out.slide_power, 0.0);
      EXPECT_GE(out.spin_power, 0.0);
      EXPECT_LE(std::hypot(out.force.norm(), out.torque / 0.02), 15.0 * (1.0 + kRounding));
    }
  }
}

TEST(RegularizedCoulomb, ChoosesTheCouplingByWord) {
  RegularizedCoulomb::Params params;
  set_choices<RegularizedCoulomb>(params, {{"coupling", "none"}});
  EXPECT_EQ(params.coupling, Coupling::kNone);
  EXPECT_THROW(set_choices<RegularizedCoulomb>(params, {{"coupling", "elipsoid"}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace volcontact::regularized_coulomb_test
