// SPDX-License-Identifier: Apache-2.0
#include "volcontact/force/elastic_coulomb.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace volcontact::elastic_coulomb_test {
namespace {

constexpr double kWeight = 9.81, kMass = 1.0;
constexpr double kNormalStiffness = 1e6;  // [N/m]

using States = std::array<double, 6>;

FrictionInput patch(double normal_force = kWeight, double normal_stiffness = kNormalStiffness) {
  return {.normal_force = normal_force,
          .patch = {.gyration_radius = 0.02},
          .normal_stiffness = normal_stiffness,
          .mass = kMass};
}

// A block on a line, held by one patch: semi-implicit Euler, as in a simulation.
class Block {
 public:
  explicit Block(double friction = 0.3) : law_({.friction = friction}) {}

  double step(double load, double normal_force = kWeight, double normal_stiffness = 1e6) {
    const double dt = 1e-4;
    FrictionInput in = patch(normal_force, normal_stiffness);
    in.slip.x() = speed_;
    in.travel.x() = place_ - last_place_;
    States pending{};
    const FrictionOutput out = law_.evaluate(in, {states_.data(), pending.data(), dt});
    states_ = pending;
    last_place_ = place_;
    speed_ += dt / kMass * (load + out.force.x());
    place_ += dt * speed_;
    return out.force.x();
  }
  double place() const { return place_; }
  double speed() const { return speed_; }

 private:
  ElasticCoulomb law_;
  double place_ = 0.0, last_place_ = 0.0, speed_ = 0.0;
  States states_{};
};

TEST(ElasticCoulomb, HoldsWithinTheConeWithoutCreep) {
  Block block;
  const double load = 0.999 * 0.3 * kWeight;
  double place = 0.0;
  for (int i = 0; i < 300000; ++i) {  // 30 s
    block.step(load * std::min(1.0, i / 20000.0));
    if (i == 100000) place = block.place();
  }
  EXPECT_EQ(block.place(), place);  // not a single bit
  EXPECT_NEAR(place, load / 0.8e6, 1e-9 * place);
}

TEST(ElasticCoulomb, SlidesAtTheCone) {
  Block block;
  const double load = 1.1 * 0.3 * kWeight;
  for (int i = 0; i < 5000; ++i) block.step(load);
  const double speed = block.speed();
  for (int i = 0; i < 5000; ++i) block.step(load);
  EXPECT_NEAR(block.speed() - speed, 0.5 * 0.1 * 0.3 * kWeight / kMass, 1e-12);
  for (int i = 0; i < 40000; ++i) block.step(0.0);
  EXPECT_LT(std::abs(block.speed()), 1e-12);
}

// F^2 / 2k is the same before and after a patch grows: no work was done.
TEST(ElasticCoulomb, APatchThatGrowsKeepsTheEnergyOfItsSpring) {
  const ElasticCoulomb law({.friction = 0.5, .presliding = 0.0});
  States first{}, later{};
  first[5] = 0.5 * kWeight;
  FrictionInput in = patch();
  in.travel = {1e-6, 0.0, 0.0};
  in.turn = 2e-5;
  const FrictionOutput before = law.evaluate(in, {first.data(), first.data(), 1e-3});
  in = patch(kWeight, 4.0 * kNormalStiffness);
  const FrictionOutput after = law.evaluate(in, {first.data(), later.data(), 1e-3});
  EXPECT_NEAR(after.slide_energy, before.slide_energy, 1e-12 * before.slide_energy);
  EXPECT_NEAR(after.spin_energy, before.spin_energy, 1e-12 * before.spin_energy);
  EXPECT_NEAR(after.force.x(), 2.0 * before.force.x(), 1e-12 * -before.force.x());
}

// A grasp that breathes: normal force and patch swing by a third while the load stays.
TEST(ElasticCoulomb, APatchThatBreathesUnderALoadDoesNotCreep) {
  Block block;
  double place = 0.0, most = 0.0;
  for (int i = 0; i < 200000; ++i) {  // 20 s at 10 Hz
    const double breath = 1.0 + 0.33 * std::sin(2.0 * std::numbers::pi * 1e-3 * i);
    block.step(0.5 * 0.3 * kWeight, breath * kWeight, breath * kNormalStiffness);
    if (i % 1000 != 999) continue;
    if (i < 100000) {
      place = block.place();
    } else {
      most = std::max(most, std::abs(block.place() - place));
    }
  }
  EXPECT_LT(most, 1e-15);
}

TEST(ElasticCoulomb, IsNoStifferThanItsPreslidingSays) {
  const ElasticCoulomb law({.friction = 0.5, .presliding = 1e-6});
  States committed{}, pending{};
  const LawState state{committed.data(), pending.data(), 1e-3};
  EXPECT_EQ(law.slope(patch(), state).stiffness, 0.8 * kNormalStiffness);
  EXPECT_DOUBLE_EQ(law.slope(patch(kWeight, 1e12), state).stiffness, 0.5 * kWeight / 1e-6);
  FrictionInput none = patch(0.0, 1e308);  // nothing that is no number
  none.travel.x() = 1.0;
  EXPECT_EQ(law.evaluate(none, state).force, Vec3(Vec3::Zero()));
  EXPECT_EQ(pending[0], 0.0);
}

// A ball that rolls and slides has 2/7 of its mass there: critical for it.
TEST(ElasticCoulomb, DampingIsCriticalForABall) {
  const ElasticCoulomb law({.tangential_damping = 1.0});
  States committed{}, pending{};
  const FrictionSlope slope = law.slope(patch(), {committed.data(), pending.data(), 1e-3});
  EXPECT_DOUBLE_EQ(slope.damping, 2.0 * std::sqrt(slope.stiffness * 2.0 / 7.0 * kMass));
}

TEST(ElasticCoulomb, WhatItHoldsHangsOnTheWayAlone) {
  const ElasticCoulomb law({.friction = 0.5});
  States committed{1e-7, 0.0, 0.0, 1e-7, 0.8e6, 0.5 * kWeight}, still{}, fast{};
  FrictionInput in = patch();
  in.travel = {0.0, 2e-7, 0.0};
  law.evaluate(in, {committed.data(), still.data(), 1e-3});
  in.slip = {0.3, -0.2, 0.0};  // as of a body on a turntable, whose speed is old by a step
  law.evaluate(in, {committed.data(), fast.data(), 1e-3});
  EXPECT_EQ(still, fast);
}

// Along random ways, small and large, under normal forces and patches that change: what friction
// gives back is never more than what it was given, and never beyond the cone.
TEST(ElasticCoulomb, NeverMakesEnergy) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (const Coupling coupling : {Coupling::kEllipsoid, Coupling::kNone}) {
    const ElasticCoulomb law({.friction = 0.4, .coupling = coupling});
    for (int run = 0; run < 50; ++run) {
      States committed{}, pending{};
      double stored = 0.0;
      for (int i = 0; i < 200; ++i) {
        FrictionInput in = patch(20.0 * std::exp(any(random)), 1e6 * std::exp(2.0 * any(random)));
        const double size = std::pow(10.0, -6.0 + 2.0 * any(random)), dt = 1e-3;
        in.travel = size * Vec3(any(random), any(random), 0.0);
        in.turn = size / 0.02 * any(random);
        const FrictionOutput out = law.evaluate(in, {committed.data(), pending.data(), dt});
        const double load = std::hypot(out.force.norm(), out.torque / 0.02);
        EXPECT_LE(load, 0.4 * in.normal_force * (1.0 + 1e-12));
        // What the spring got is at most the work of its own force at the end, all along the way.
        const double now = out.slide_energy + out.spin_energy;
        const double given = -out.force.dot(in.travel) - out.torque * in.turn;
        EXPECT_LE(now - stored, given + 1e-9 * std::abs(given) + 1e-15);
        stored = now;
        committed = pending;
      }
    }
  }
}

}  // namespace
}  // namespace volcontact::elastic_coulomb_test
