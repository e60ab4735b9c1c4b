// SPDX-License-Identifier: Apache-2.0
#include "adaptor/memory/energy_account.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace volcontact::adaptor::energy_account_test {
namespace {

// A simulation whose contacts take the power P(t) by sliding and store E(t) in bristles.
class Simulation {
 public:
  Simulation(double step, bool runge_kutta)
      : step_(step),
        runge_kutta_(runge_kutta),
        numbers_(static_cast<std::size_t>(UserdataLayout{}.size()), 0.0) {
    block().claim();
  }

  // `wrong` is added to the power, as the first and second middle of a step have it wrong.
  double evaluate(double time, double wrong = 0.0) {
    const AccountKeeper account(block(), time, step_, runge_kutta_);
    EnergyAccount now;
    now.taken.slide = power(time) + wrong;
    now.slide_energy = stored(time);
    now.force_power = now.friction_power = -power(time) - wrong;
    // The forces of a step do not change in it: at its end their power is that of their slip then.
    account.write(now, -power(time), -power(time), 0.0);
    return block().slot(0).energy().dissipated.slide;
  }
  EnergyAccount account() { return block().slot(0).energy(); }
  static double power(double t) { return 3.0 + 2.0 * t - t * t * t; }
  static double stored(double t) { return 0.1 * std::sin(5.0 * t); }
  /// Exact, from 0 to t.
  static double dissipated(double t) {
    return 3.0 * t + t * t - t * t * t * t / 4.0 - (stored(t) - stored(0.0));
  }

 private:
  UserdataBlock block() { return {numbers_.data() + numbers_.size(), {}}; }

  double step_;
  bool runge_kutta_;
  std::vector<double> numbers_;
};

TEST(EnergyAccount, TrapezoidalRuleLosesTheCurvatureOfThePower) {
  Simulation simulation(0.1, false);
  double sum = 0.0;
  for (int i = 0; i <= 10; ++i) sum = simulation.evaluate(0.1 * i);
  // Exact less h^2/12 (P'(1) - P'(0)) of the trapezoidal rule, exact itself for a cubic.
  const double curvature = 0.01 / 12.0 * (-3.0);
  EXPECT_NEAR(sum, Simulation::dissipated(1.0) + curvature, 1e-14);
}

TEST(EnergyAccount, RungeKuttaStepsAreSummedBySimpson) {
  Simulation simulation(0.1, true);
  double sum = 0.0;
  for (double t = 0.0; t < 1.05; t += 0.1) {
    sum = simulation.evaluate(t);
    EXPECT_NEAR(sum, Simulation::dissipated(t), 1e-14);  // exact for a cubic
    simulation.evaluate(t + 0.05, 0.3);                  // errors that cancel in the mean
    simulation.evaluate(t + 0.05, -0.3);
    simulation.evaluate(t + 0.1, 0.7);  // redone as the first of the next step
  }
  EXPECT_GT(sum, 3.0);
}

TEST(EnergyAccount, StepsThatAreRedoneCountOnce) {
  Simulation plain(0.1, true), trials(0.1, true);
  double expected = 0.0, found = 0.0;
  for (double t = 0.0; t < 1.05; t += 0.1) {
    for (int trial = 0; trial < 3; ++trial) {
      for (const double stage : {t, t + 0.05, t + 0.05, t + 0.1}) trials.evaluate(stage, trial);
    }
    for (const double stage : {t, t + 0.05, t + 0.05, t + 0.1}) {
      expected = plain.evaluate(stage);
      found = trials.evaluate(stage);
    }
  }
  EXPECT_EQ(found, expected);
}

TEST(EnergyAccount, WorkIsTheSumOfWhatIsSpentStoredAndMadeByTheStep) {
  // All the power that the forces take, by either rule, is taken by sliding; the bristles' energy
  // is not reported as elastic here, so what they keep is what remains.
  for (const bool runge_kutta : {false, true}) {
    Simulation simulation(0.1, runge_kutta);
    for (double t = 0.0; t < 1.05; t += 0.1) {
      simulation.evaluate(t);
      if (!runge_kutta) continue;
      simulation.evaluate(t + 0.05, 0.3);
      simulation.evaluate(t + 0.05, -0.3);
      simulation.evaluate(t + 0.1);
    }
    const EnergyAccount e = simulation.account();
    const double end = runge_kutta ? 1.1 : 1.0;
    const double kept = Simulation::stored(end) - Simulation::stored(0.0);
    EXPECT_NEAR(e.work, -(Simulation::dissipated(end) + kept), runge_kutta ? 1e-14 : 3e-3);
    EXPECT_NEAR(e.numerical, kept, 1e-14);
    EXPECT_NEAR(e.work + e.dissipated.sum() + e.numerical, 0.0, 1e-14);
  }
}

TEST(EnergyAccount, WhatTheLawsDoNotKnowIsNumerical) {
  EnergyAccount before{0.5, {1.0, 2.0, 3.0, 4.0}, {}, {}, 0.0, 0.0};
  before.work = -10.0;
  before.numerical = 0.25;
  EnergyAccount now{0.7, {1.5, 2.0, 3.0, 4.0}, {}, {}, 0.0, 0.0};
  add_work(before, -1.0, 0.0, now);  // of 1 J taken 0.2 are stored, 0.5 dissipated
  EXPECT_DOUBLE_EQ(now.work, -11.0);
  EXPECT_DOUBLE_EQ(now.numerical, 0.25 + 0.3);
}

// Two steps of 0.1 s: the first explicit or implicit as `before` says, the second not looked at.
EnergyAccount after_one_step(EnergyAccount before, EnergyAccount now, double later,
                             double friction_later) {
  std::vector<double> numbers(static_cast<std::size_t>(UserdataLayout{}.size()), 0.0);
  const UserdataBlock block{numbers.data() + numbers.size(), {}};
  block.claim();
  AccountKeeper(block, 0.0, 0.1, false).write(before, 0.0, 0.0, 0.0);
  AccountKeeper(block, 0.1, 0.1, false).write(now, later, friction_later, 0.0);
  return block.slot(0).energy();
}

TEST(EnergyAccount, FrictionOfAnExplicitStepIsWhatItDidWhateverFollows) {
  EnergyAccount before, now;
  before.taken.slide = 5.0;
  before.force_power = before.friction_power = -5.0;
  now.taken.slide = 1.0;  // by the forces of the next step
  for (const bool implicit : {false, true}) {
    now.implicit = implicit;
    const EnergyAccount after = after_one_step(before, now, -3.0, -3.0);
    EXPECT_DOUBLE_EQ(after.dissipated.slide, 0.1 * 4.0);
    EXPECT_NEAR(after.numerical, 0.0, 1e-15);
  }
}

TEST(EnergyAccount, WhatIsLentIsMadeByTheStep) {
  EnergyAccount before, now;
  before.implicit = true;
  before.taken.normal = -2.0;
  before.force_power = 2.0;
  now.owed = 0.2;
  const EnergyAccount after = after_one_step(before, now, 2.0, 0.0);
  EXPECT_NEAR(after.dissipated.normal, 0.0, 1e-15);
  EXPECT_NEAR(after.numerical, -0.2, 1e-15);
  EXPECT_NEAR(after.made, 0.0, 1e-15);
}

TEST(EnergyAccount, WhatABristleGivesBackIsDissipatedElsewhere) {
  const EnergyAccount before{0.5, {1.0, 2.0, 3.0, 4.0}, {}, {}, 0.7, 0.2};
  EnergyAccount now;
  now.slide_energy = 0.0;  // its site ended: the energy is lost
  now.spin_energy = 0.3;
  const EnergyAccount after = accounted(before, {0.0, 0.0, 5.0, 5.0}, 0.1, now);
  EXPECT_DOUBLE_EQ(after.dissipated.normal, 1.0);
  EXPECT_DOUBLE_EQ(after.dissipated.roll, 2.0);
  EXPECT_DOUBLE_EQ(after.dissipated.slide, 3.0 + 0.5 + 0.7);
  EXPECT_DOUBLE_EQ(after.dissipated.spin, 4.0 + 0.5 - 0.1);
}

}  // namespace
}  // namespace volcontact::adaptor::energy_account_test
