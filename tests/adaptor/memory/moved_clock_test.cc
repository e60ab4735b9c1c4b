// SPDX-License-Identifier: Apache-2.0
#include "adaptor/memory/moved_clock.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "adaptor/readings/last_evaluation.h"
#include "adaptor/scene_registry.h"
#include "adaptor/support/count_allocations.h"
#include "adaptor/support/models.h"

namespace volcontact::adaptor::moved_clock_test {
namespace {

constexpr double kStep = 1e-3;

// A box of 2 kg that bristles hold on a floor under a sideways pull of 0.2 of its weight, and a
// ball that rolls beside it.
std::string scene(const std::string& integrator) {
  return "<mujoco><option timestep=\"1e-3\" integrator=\"" + integrator +
         R"(" gravity="1.962 0 -9.81"/><worldbody>
  <geom name="floor" type="plane" size="2 2 .1"/>
  <body pos="0 0 .1"><freejoint/><geom name="box" type="box" size=".1 .1 .1" mass="2"/></body>
  <body pos="0 1 .05"><freejoint/><geom name="ball" type="sphere" size=".05" mass=".5"/></body>
</worldbody><custom>
  <numeric name="volcontact/material/m/stiffness" data="2e7"/>
  <numeric name="volcontact/material/m/damping" data="10"/>
  <numeric name="volcontact/material/m/friction" data="0.4"/>
  <numeric name="volcontact/material/m/friction_law/bristle" data="1"/>
  <numeric name="volcontact/material/m/bristle_stiffness" data="5e4"/>
  <numeric name="volcontact/material/m/bristle_damping" data="100"/>
  <tuple name="volcontact/material/m"><element objtype="geom" objname="floor"/>
    <element objtype="geom" objname="box"/><element objtype="geom" objname="ball"/></tuple>
</custom></mujoco>)";
}

class MovedClock : public ::testing::TestWithParam<const char*> {
 protected:
  MovedClock()
      : m(testing::load(scene(GetParam()))),
        d(testing::make_data(m)),
        same(testing::make_data(m)),
        attached(m) {
    run(*d, 2000);  // the box has come to rest
    mj_copyData(same.get(), m.get(), d.get());
  }
  void run(mjData& data, int steps) {
    for (int i = 0; i < steps; ++i) mj_step(m.get(), &data);
  }
  void expect_same(double tolerance) {
    for (int i = 0; i < m->nq; ++i) EXPECT_NEAR(d->qpos[i], same->qpos[i], tolerance) << i;
    for (int i = 0; i < m->nv; ++i) EXPECT_NEAR(d->qvel[i], same->qvel[i], 1e3 * tolerance) << i;
  }
  EnergyAccount energy(const testing::DataPointer& data) {
    return volcontact::adaptor::energy(*contact_of(m.get()), m.get(), data.get());
  }

  testing::ModelPointer m;
  testing::DataPointer d, same;
  testing::Attached attached;
};

// The motion of the untouched copy is the answer. Before, the box slipped by .083 mm at each
// change.
TEST_P(MovedClock, TheMotionGoesOnAsItWas) {
  for (const double time : {0.0, 100.0, -5.0, 100.0, 1e6, 0.3}) {
    d->time = time;
    run(*d, 7);
    run(*same, 7);
    expect_same(1e-9 * std::abs(time) * kStep + 1e-11);
  }
  const EnergyAccount moved = energy(d), untouched = energy(same);
  EXPECT_NEAR(moved.dissipated.sum(), untouched.dissipated.sum(), 1e-8);
  EXPECT_NEAR(moved.work, untouched.work, 1e-8);
  EXPECT_GT(untouched.dissipated.sum(), 1e-4);
}

TEST_P(MovedClock, RepeatedEvaluationsAtAnotherTimeAreOfTheSameState) {
  mj_forward(m.get(), d.get());
  const double force = d->qfrc_applied[0];
  EXPECT_LT(force, -1.0);  // of the bristles
  for (const double time : {0.0, 50.0, -3.0}) {
    d->time = time;
    mj_forward(m.get(), d.get());
    EXPECT_NEAR(d->qfrc_applied[0], force, 1e-6 * std::abs(force));
  }
}

// A state that is set with the time is another simulation: it begins as fresh data do.
TEST_P(MovedClock, AnotherStateBeginsAnew) {
  const auto fresh = testing::make_data(m);
  for (mjData* data : {d.get(), fresh.get()}) {
    mju_copy(data->qpos, m->qpos0, m->nq);
    data->qpos[0] = 0.5;
    data->qpos[2] -= 1e-5;
    mju_zero(data->qvel, m->nv);
    data->time = 0.0;
    run(*data, 1);
  }
  for (int i = 0; i < m->nq; ++i) EXPECT_EQ(d->qpos[i], fresh->qpos[i]) << i;
  EXPECT_EQ(energy(d).dissipated.sum(), energy(fresh).dissipated.sum());
}

TEST_P(MovedClock, AStateThatIsNoNumberIsAnother) {
  d->time = 0.0;
  d->qpos[7] = std::nan("");
  std::vector<double> difference;
  const UserdataBlock block = contact_of(m.get())->block(m.get(), d.get());
  const double before = block.slot(0).time();
  follow_clock(m.get(), d.get(), block, difference);
  EXPECT_EQ(block.slot(0).time(), before);
}

TEST_P(MovedClock, ResetsAndStepsThatAreRedoneAreAsBefore) {
  const double time = d->time;
  std::vector<double> state(d->qpos, d->qpos + m->nq), speed(d->qvel, d->qvel + m->nv);
  run(*d, 1);
  run(*same, 1);
  // Back by a step, as finite differences do, without userdata.
  mju_copy(d->qpos, state.data(), m->nq);
  mju_copy(d->qvel, speed.data(), m->nv);
  d->time = time;
  run(*d, 1);
  expect_same(1e-15);
  mj_resetData(m.get(), d.get());
  const auto fresh = testing::make_data(m);
  run(*d, 5);
  run(*fresh, 5);
  for (int i = 0; i < m->nq; ++i) EXPECT_EQ(d->qpos[i], fresh->qpos[i]) << i;
}

TEST_P(MovedClock, AllocatesNothingOnceWarm) {
  d->time = 7.0;
  run(*d, 1);
  d->time = 0.0;
  const long before = testing::AllocationCounter::total();
  {
    const testing::AllocationCounter counter;
    run(*d, 1);
  }
  EXPECT_EQ(testing::AllocationCounter::total(), before);
}

INSTANTIATE_TEST_SUITE_P(Integrators, MovedClock, ::testing::Values("Euler", "implicit", "RK4"));

}  // namespace
}  // namespace volcontact::adaptor::moved_clock_test
