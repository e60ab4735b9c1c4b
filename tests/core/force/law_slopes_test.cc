// SPDX-License-Identifier: Apache-2.0
// The derivatives that laws give a step that is implicit in the contact, against differences of
// their forces.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "volcontact/force/bristle.h"
#include "volcontact/force/hunt_crossley.h"
#include "volcontact/force/regularized_coulomb.h"
#include "volcontact/force/volume_spring.h"

namespace volcontact::law_slopes_test {
namespace {

constexpr double kDifference = 1e-6;  // of the forward differences below, whose laws are linear

TEST(NormalSlope, OfTheSpringIsItsStiffness) {
  const VolumeSpring law({.stiffness = 3e8});
  const NormalSlope slope = law.slope({.volume = 1e-7, .approach_speed = 0.3}, {});
  EXPECT_EQ(slope.stiffness, 3e8);
  EXPECT_EQ(slope.damping, 0.0);
}

TEST(NormalSlope, OfHuntCrossleyIsThatOfItsFormula) {
  // f = k V (1 + a v): df/dV = k (1 + a v), df/dv = k V a.
  const HuntCrossley law({.stiffness = 2e7, .damping = 0.5});
  const NormalSlope slope = law.slope({.volume = 1e-6, .approach_speed = -0.4}, {});
  EXPECT_DOUBLE_EQ(slope.stiffness, 2e7 * 0.8);
  EXPECT_DOUBLE_EQ(slope.damping, 10.0);
}

TEST(NormalSlope, OfHuntCrossleyIsNoneWhereItsForceEnds) {
  const HuntCrossley law({.stiffness = 2e7, .damping = 0.5});
  const NormalSlope slope = law.slope({.volume = 1e-6, .approach_speed = -3.0}, {});
  EXPECT_EQ(slope.stiffness, 0.0);
  EXPECT_EQ(slope.damping, 0.0);
}

TEST(NormalSlope, UsesTheDampingThatTheImpactLatched) {
  const HuntCrossley law({.stiffness = 2e7, .restitution = 0.6});
  const double committed = 0.5;  // impact speed
  double pending = 0.0;
  const LawState state{&committed, &pending, 1e-3};
  const NormalInput in{.volume = 1e-6, .approach_speed = 0.2};
  NormalInput faster = in;
  faster.approach_speed += kDifference;
  const double by_difference =
      (law.evaluate(faster, state).magnitude - law.evaluate(in, state).magnitude) / kDifference;
  EXPECT_NEAR(law.slope(in, state).damping / by_difference, 1.0, 1e-8);
  EXPECT_EQ(pending, 0.5);
}

// A law of a user's own that does not know its slopes: f = k V^2 (1 + b v), with a state.
class Quadratic final : public NormalForce {
 public:
  const char* name() const noexcept override { return "quadratic"; }
  std::span<const StateField> states() const noexcept override { return kStates; }
  NormalOutput evaluate(const NormalInput& in, const LawState& state) const noexcept override {
    state.pending[0] = in.volume;
    const double elastic = 1e12 * in.volume * in.volume;
    return {elastic * std::max(0.0, 1.0 + 2.0 * in.approach_speed), elastic, 0.0, 0.0};
  }

 private:
  static constexpr std::array kStates{StateField{"volume", "m^3", Keeping::kValue, "the last"}};
};

TEST(NormalSlope, OfALawThatDoesNotKnowItComesFromDifferences) {
  const double committed = 0.0;
  double pending = 0.0;
  const NormalSlope slope =
      Quadratic().slope({.volume = 1e-5, .approach_speed = 0.1}, {&committed, &pending, 1e-3});
  EXPECT_NEAR(slope.stiffness, 2e12 * 1e-5 * 1.2, 1e-6 * 2.4e7);
  EXPECT_NEAR(slope.damping, 1e12 * 1e-10 * 2.0, 1e-6 * 200.0);
  EXPECT_EQ(pending, 1e-5);  // what is kept is of the true volume
}

TEST(NormalSlope, OfAForceThatFallsIsNone) {
  struct Falling final : NormalForce {
    const char* name() const noexcept override { return "falling"; }
    NormalOutput evaluate(const NormalInput& in, const LawState&) const noexcept override {
      return {1.0 - 10.0 * in.volume - in.approach_speed, 0.0, 0.0, 0.0};
    }
  };
  const NormalSlope slope = Falling().slope({.volume = 1e-2, .approach_speed = 0.0}, {});
  EXPECT_EQ(slope.stiffness, 0.0);
  EXPECT_EQ(slope.damping, 0.0);
}

FrictionInput sliding(double speed, double spin = 0.0) {
  return {.normal_force = 50.0,
          .slip = {speed, 0.0, 0.0},
          .spin = spin,
          .patch = {.gyration_radius = 0.02}};
}

// The slope's damping is force over slip, whatever the slip.
TEST(FrictionSlope, OfRegularizedCoulombIsForceOverSlip) {
  const RegularizedCoulomb law({.friction = 0.3, .slip_speed = 1e-3});
  for (const double speed : {1e-7, 2e-4, 9e-4, 0.5}) {
    const FrictionInput in = sliding(speed);
    const FrictionSlope slope = law.slope(in, {});
    EXPECT_NEAR(slope.damping * speed / -law.evaluate(in, {}).force.x(), 1.0, 1e-12) << speed;
    EXPECT_DOUBLE_EQ(slope.strength, 15.0);
    EXPECT_EQ(slope.stiffness, 0.0);
    EXPECT_EQ(slope.lever, 0.02);
  }
}

TEST(FrictionSlope, WithoutCouplingHasNoLever) {
  const RegularizedCoulomb law({.coupling = Coupling::kNone});
  EXPECT_EQ(law.slope(sliding(0.1, 3.0), {}).lever, 0.0);
}

TEST(FrictionSlope, OfHoldingBristlesIsThatOfTheirSpringAndDamper) {
  const Bristle law({.friction = 0.3, .static_friction = 0.4, .viscous_friction = 20.0});
  const std::array<double, 5> committed{1e-6, 0.0, 0.0, 0.0, 1.0};
  std::array<double, 5> pending{};
  const LawState state{committed.data(), pending.data(), 1.0};
  const FrictionInput in = sliding(0.0);
  FrictionInput moved = in, faster = in;
  moved.travel.x() += 1e-8;
  faster.slip.x() += 1e-8;
  const double here = law.evaluate(in, state).force.x();
  const FrictionSlope slope = law.slope(in, state);
  EXPECT_NEAR(slope.stiffness, (here - law.evaluate(moved, state).force.x()) / 1e-8, 1.0);
  EXPECT_NEAR(slope.damping, (here - law.evaluate(faster, state).force.x()) / 1e-8, 1e-2);
  EXPECT_DOUBLE_EQ(slope.strength, 0.4 * 50.0);  // after a long rest
}

// The default against the law's own: the same law behind a class that does not override it.
class Hidden final : public Friction {
 public:
  explicit Hidden(const Friction& law) : law_(law) {}
  const char* name() const noexcept override { return "hidden"; }
  std::span<const StateField> states() const noexcept override { return law_.states(); }
  FrictionOutput evaluate(const FrictionInput& in, const LawState& state) const noexcept override {
    return law_.evaluate(in, state);
  }

 private:
  const Friction& law_;
};

// F = -k z with z the way, no longer than 0.3 f_n / k.
class LimitedSpring final : public Friction {
 public:
  static constexpr std::array kStates{StateField{"deflection", "m", Keeping::kVector, ""}};
  const char* name() const noexcept override { return "limited_spring"; }
  std::span<const StateField> states() const noexcept override { return kStates; }
  FrictionOutput evaluate(const FrictionInput& in, const LawState& state) const noexcept override {
    Vec3 z = Vec3(state.committed[0], state.committed[1], state.committed[2]) + in.travel;
    const double most = 0.3 * in.normal_force / 1e5;
    if (z.norm() > most) z *= most / z.norm();
    for (int i = 0; i < 3; ++i) state.pending[i] = z[i];
    FrictionOutput out;
    out.force = -1e5 * z;
    return out;
  }
};

TEST(FrictionSlope, OfALawThatDoesNotKnowItComesFromDifferences) {
  const RegularizedCoulomb coulomb({.friction = 0.3, .slip_speed = 1e-3});
  for (const double speed : {0.0, 2e-4, 0.5}) {
    const FrictionSlope own = coulomb.slope(sliding(speed), {});
    const FrictionSlope found = Hidden(coulomb).slope(sliding(speed), {});
    EXPECT_NEAR(found.damping / own.damping, 1.0, 1e-5) << speed;
    EXPECT_NEAR(found.strength, own.strength, 1e-12);
    EXPECT_EQ(found.stiffness, 0.0);
  }
  const Bristle bristle({.friction = 0.3, .static_friction = 0.4});
  const std::array<double, 5> committed{1e-6, 0.0, 0.0, 0.0, 1.0};
  std::array<double, 5> pending{}, own_pending{}, kept{};
  const FrictionSlope own =
      bristle.slope(sliding(0.0), {committed.data(), own_pending.data(), 1e-3});
  const FrictionSlope found =
      Hidden(bristle).slope(sliding(0.0), {committed.data(), pending.data(), 1e-3});
  EXPECT_NEAR(found.stiffness / own.stiffness, 1.0, 1e-3);
  EXPECT_NEAR(found.damping / own.damping, 1.0, 1e-3);
  bristle.evaluate(sliding(0.0), {committed.data(), kept.data(), 1e-3});
  EXPECT_EQ(pending, kept);
  EXPECT_EQ(own_pending, (std::array<double, 5>{}));
}

// What a spring holds at most shows only once it has been drawn out.
TEST(FrictionSlope, OfASpringThatIsNotDrawnYetIsItsLimit) {
  const LimitedSpring spring;
  const std::array<double, 3> committed{};
  std::array<double, 3> pending{};
  const FrictionSlope slope = spring.slope(sliding(0.0), {committed.data(), pending.data(), 1e-3});
  EXPECT_NEAR(slope.strength, 0.3 * 50.0, 1e-9);
  EXPECT_NEAR(slope.stiffness, 1e5, 1.0);
  EXPECT_EQ(slope.damping, 0.0);
}

}  // namespace
}  // namespace volcontact::law_slopes_test
