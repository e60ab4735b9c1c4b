// SPDX-License-Identifier: Apache-2.0
#include "volcontact/force/hunt_crossley.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace volcontact::hunt_crossley_test {
namespace {

NormalOutput evaluate(const HuntCrossley& law, double volume, double speed) {
  return law.evaluate({.volume = volume, .depth_moment = 0.5 * volume, .approach_speed = speed},
                      {});
}

TEST(HuntCrossley, IsStiffnessTimesVolumeAtRest) {
  const HuntCrossley law({.stiffness = 2e7, .damping = 0.3});
  const NormalOutput out = evaluate(law, 1e-6, 0.0);
  EXPECT_DOUBLE_EQ(out.magnitude, 20.0);
  EXPECT_DOUBLE_EQ(out.elastic_energy, 2e7 * 0.5e-6);
  EXPECT_DOUBLE_EQ(out.rolling_damping, 6e6);
}

TEST(HuntCrossley, HasNoForceWithoutVolume) {
  const HuntCrossley law({.stiffness = 2e7, .damping = 0.3});
  EXPECT_EQ(evaluate(law, 0.0, 3.0).magnitude, 0.0);
}

TEST(HuntCrossley, NeverPulls) {
  const HuntCrossley law({.stiffness = 2e7, .damping = 0.5});
  EXPECT_EQ(evaluate(law, 1e-6, -2.5).magnitude, 0.0);  // faster than 1/a apart
  EXPECT_GT(evaluate(law, 1e-6, -1.9).magnitude, 0.0);
}

TEST(HuntCrossley, OnlyDissipates) {
  const HuntCrossley law({.stiffness = 2e7, .damping = 0.5});
  for (double speed : {-5.0, -1.0, -1e-6, 0.0, 1e-6, 2.0}) {
    const NormalOutput out = evaluate(law, 1e-6, speed);
    EXPECT_GE((out.magnitude - out.elastic) * speed, 0.0) << speed;
  }
}

// Head-on impact with any V(h); here V = area h. Semi-analytic truth: docs/theory.md,
// "Restitution": ln((1 + A)/(1 - e A)) = A (1 + e), A = a v_i; the values of e below solve it to
// six digits.
double restitution_by_integration(double damping, double impact_speed) {
  const double area = 1e-4, mass = 1.0;
  const HuntCrossley law({.stiffness = 1e9, .damping = damping});
  const auto acceleration = [&](double h, double v) {
    return -evaluate(law, area * std::max(0.0, h), v).magnitude / mass;
  };
  double h = 0.0, v = impact_speed;
  const double dt = 1e-6;
  do {  // classical Runge-Kutta
    const double k1h = v, k1v = acceleration(h, v);
    const double k2h = v + 0.5 * dt * k1v, k2v = acceleration(h + 0.5 * dt * k1h, k2h);
    const double k3h = v + 0.5 * dt * k2v, k3v = acceleration(h + 0.5 * dt * k2h, k3h);
    const double k4h = v + dt * k3v, k4v = acceleration(h + dt * k3h, k4h);
    h += dt / 6.0 * (k1h + 2.0 * k2h + 2.0 * k3h + k4h);
    v += dt / 6.0 * (k1v + 2.0 * k2v + 2.0 * k3v + k4v);
  } while (h > 0.0);
  return -v / impact_speed;
}

TEST(HuntCrossley, RealisesTheLambertRestitution) {
  constexpr double kIntegration = 2e-6;  // six digits of the table, plus the last step's overshoot
  const std::pair<double, double> table[] = {{0.01, 0.993377}, {0.05, 0.967739}, {0.1, 0.937476},
                                             {0.2, 0.882190},  {0.5, 0.748435},  {1.0, 0.593624},
                                             {2.0, 0.410720},  {5.0, 0.196980},  {10.0, 0.099982}};
  for (const auto& [a_times_speed, restitution] : table) {
    const double speed = 0.7;
    EXPECT_NEAR(restitution_by_integration(a_times_speed / speed, speed), restitution, kIntegration)
        << "a v = " << a_times_speed;
  }
}

// The same impact with the restitution asked for, its speed latched at the first touch.
double realised(double restitution, double impact_speed) {
  const double area = 1e-4, mass = 1.0, dt = 1e-6;
  const HuntCrossley law({.stiffness = 1e9, .restitution = restitution});
  double latched = 0.0, h = 0.0, v = impact_speed;
  const auto acceleration = [&](double depth, double speed) {
    double pending = -1.0;
    const double volume = area * std::max(0.0, depth);
    const NormalOutput out =
        law.evaluate({.volume = volume, .approach_speed = speed}, {&latched, &pending, dt});
    if (volume > 0.0) latched = pending;
    return -out.magnitude / mass;
  };
  do {  // midpoint rule
    const double vm = v + 0.5 * dt * acceleration(h, v), hm = h + 0.5 * dt * v;
    v += dt * acceleration(hm, vm);
    h += dt * vm;
  } while (h > 0.0);
  return -v / impact_speed;
}

TEST(HuntCrossley, RealisesTheRestitutionAskedForAtEverySpeed) {
  for (const double speed : {0.1, 1.0, 3.0}) {
    for (const double e : {0.9, 0.8, 0.5, 0.2}) EXPECT_NEAR(realised(e, speed), e, 1e-4);
  }
}

TEST(HuntCrossley, ImpactsBelowTheFloorAreDampedAsAtTheFloor) {
  const HuntCrossley law({.stiffness = 1e7, .restitution = 0.5, .restitution_speed_floor = 0.02});
  double none = 0.0, latched = 0.0;
  const NormalOutput out =
      law.evaluate({.volume = 1e-6, .approach_speed = 1e-3}, {&none, &latched, 0.0});
  EXPECT_EQ(latched, 0.02);
  EXPECT_NEAR(out.rolling_damping, 1e7 * 1.43275 / 0.02, 1e7 * 1e-5 / 0.02);  // table of the theory
}

TEST(HuntCrossley, KeepsTheSpeedOfTheFirstTouch) {
  const HuntCrossley law({.restitution = 0.5});
  double none = 0.0, first = 0.0, later = 0.0;
  law.evaluate({.volume = 1e-9, .approach_speed = 0.7}, {&none, &first, 1e-3});
  law.evaluate({.volume = 1e-6, .approach_speed = 0.1}, {&first, &later, 1e-3});
  EXPECT_EQ(first, 0.7);
  EXPECT_EQ(later, 0.7);
}

// A slow touch, then a blow before the bodies part: the blow has the restitution, not the touch.
TEST(HuntCrossley, ABlowOnWhatTouchesHasItsOwnSpeed) {
  const HuntCrossley law({.restitution = 0.5});
  double none = 0.0, touch = 0.0, blow = 0.0;
  law.evaluate({.volume = 1e-9, .approach_speed = 0.02}, {&none, &touch, 1e-3});
  const NormalOutput out =
      law.evaluate({.volume = 1e-6, .approach_speed = 0.7}, {&touch, &blow, 1e-3});
  EXPECT_EQ(blow, 0.7);
  EXPECT_NEAR(out.magnitude / out.elastic, 1.0 + damping_number_of(0.5), 1e-12);
}

TEST(HuntCrossley, BeginsAnewWhenTheBodiesPressAgain) {
  const HuntCrossley law({.restitution = 0.5});
  double first = 0.7, parting = 0.0, again = 0.0;
  law.evaluate({.volume = 1e-6, .approach_speed = -0.1}, {&first, &parting, 1e-3});
  EXPECT_EQ(parting, -0.7);  // still that of the blow they part from
  law.evaluate({.volume = 1e-6, .approach_speed = 0.1}, {&parting, &again, 1e-3});
  EXPECT_EQ(again, 0.1);
}

// What was pressed slowly and is let go parts faster than after any blow it had: it loses what the
// end of an impact loses, not all.
TEST(HuntCrossley, WhatIsLetGoKeepsTheForceOfThePartingOfAnImpact) {
  const double e = 0.8, A = damping_number_of(e);
  const HuntCrossley law({.restitution = e});
  double pressed = 0.01, parting = 0.0;
  for (const double speed : {0.008, 0.1, 1.6}) {
    const NormalInput in{.volume = 1e-6, .approach_speed = -speed};
    const NormalOutput out = law.evaluate(in, {&pressed, &parting, 1e-3});
    EXPECT_NEAR(out.magnitude / out.elastic, 1.0 - A * e, 1e-12) << speed;
    EXPECT_NEAR(law.slope(in, {&pressed, &parting, 1e-3}).damping, 0.0,
                speed > 0.008 ? 0.0 : 1e7 * 1e-6 * A / 0.01);
  }
}

TEST(HuntCrossley, KeepsNothingUnderConstantDamping) {
  EXPECT_EQ(HuntCrossley({.damping = 0.5}).state_size(), 0);
  EXPECT_EQ(HuntCrossley({.restitution = 0.5}).state_size(), 1);
}

TEST(HuntCrossley, RefusesDampingBesideRestitution) {
  EXPECT_THROW(HuntCrossley({.damping = 0.1, .restitution = 0.9}), std::invalid_argument);
  EXPECT_THROW(HuntCrossley({.restitution = 0.0}), std::invalid_argument);
}

TEST(HuntCrossley, RejectsNegativeStiffnessByName) {
  try {
    HuntCrossley({.stiffness = -1.0});
    FAIL() << "no exception";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "hunt_crossley: stiffness = -1 [N/m^3] is out of range: must be > 0");
  }
  EXPECT_THROW(HuntCrossley({.damping = std::nan("")}), std::invalid_argument);
}

}  // namespace
}  // namespace volcontact::hunt_crossley_test
