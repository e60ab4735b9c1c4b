// SPDX-License-Identifier: Apache-2.0
// What the laws of a scene keep from step to step: exact under copies, resets, repeated evaluation.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "adaptor/scene/largest_state.h"
#include "adaptor/scene/scene_contact.h"
#include "adaptor/support/count_allocations.h"
#include "adaptor/support/models.h"
#include "volcontact/step/work_limit.h"

namespace volcontact::adaptor::scene_states_test {
namespace {

// Two boxes, one on the other, on a floor that is pushed sideways by gravity; bristles hold them.
std::string stack(const char* integrator, double slope = 0.2) {
  return std::string("<mujoco><option timestep=\"1e-3\" integrator=\"") + integrator +
         "\" gravity=\"" + std::to_string(9.81 * slope) + R"( 0 -9.81"/><worldbody>
  <geom name="floor" type="plane" size="2 2 .1"/>
  <body pos="0 0 .1"><freejoint/><geom name="low" type="box" size=".1 .1 .1" mass="2"/></body>
  <body pos="0 .03 .25"><freejoint/><geom name="high" type="box" size=".05 .05 .05" mass=".5"/></body>
</worldbody><custom>
  <numeric name="volcontact/material/m/stiffness" data="2e7"/>
  <numeric name="volcontact/material/m/damping" data="10"/>
  <numeric name="volcontact/material/m/friction" data="0.4"/>
  <numeric name="volcontact/material/m/friction_law/bristle" data="1"/>
  <numeric name="volcontact/material/m/bristle_stiffness" data="5e4"/>
  <numeric name="volcontact/material/m/bristle_damping" data="100"/>
  <tuple name="volcontact/material/m">
    <element objtype="geom" objname="floor"/><element objtype="geom" objname="low"/>
    <element objtype="geom" objname="high"/>
  </tuple>
</custom></mujoco>)";
}

void run(const testing::ModelPointer& m, const testing::DataPointer& d, int steps) {
  for (int i = 0; i < steps; ++i) mj_step(m.get(), d.get());
}

void expect_same(const testing::ModelPointer& m, const testing::DataPointer& a,
                 const testing::DataPointer& b, double tolerance = 0.0) {
  for (int i = 0; i < m->nq; ++i) EXPECT_NEAR(a->qpos[i], b->qpos[i], tolerance) << i;
  for (int i = 0; i < m->nv; ++i) EXPECT_NEAR(a->qvel[i], b->qvel[i], 1e3 * tolerance) << i;
}

class SceneStates : public ::testing::TestWithParam<const char*> {};

TEST_P(SceneStates, BristlesHoldTheStackWithoutCreep) {
  const auto m = testing::load(stack(GetParam()));
  const auto d = testing::make_data(m);
  const testing::Attached attached(m);
  run(m, d, 7000);  // it rings down by a factor of 100 a second
  const std::vector<double> before(d->qpos, d->qpos + m->nq);
  run(m, d, 5000);
  for (int i = 0; i < m->nq; ++i) {
    EXPECT_NEAR(d->qpos[i], before[static_cast<std::size_t>(i)], 1e-15) << i;
  }
  EXPECT_GT(d->qpos[0], 1e-6);  // deflected, not welded
  EXPECT_LT(d->qpos[0], 1e-3);
}

TEST_P(SceneStates, CopiedDataGoOnAsTheOriginal) {
  const auto m = testing::load(stack(GetParam()));
  const auto a = testing::make_data(m), b = testing::make_data(m);
  const testing::Attached attached(m);
  run(m, a, 137);
  mj_copyData(b.get(), m.get(), a.get());
  run(m, a, 100);
  run(m, b, 100);
  expect_same(m, a, b);
}

TEST_P(SceneStates, ResetDataStartAsNew) {
  const auto m = testing::load(stack(GetParam()));
  const auto a = testing::make_data(m), b = testing::make_data(m);
  const testing::Attached attached(m);
  run(m, a, 137);
  mj_resetData(m.get(), a.get());
  run(m, a, 100);
  run(m, b, 100);
  expect_same(m, a, b);
}

TEST_P(SceneStates, RepeatedForwardChangesNothing) {
  const auto m = testing::load(stack(GetParam()));
  const auto a = testing::make_data(m), b = testing::make_data(m);
  const testing::Attached attached(m);
  for (int i = 0; i < 150; ++i) {
    for (int k = 0; k < 3; ++k) mj_forward(m.get(), b.get());
    run(m, a, 1);
    run(m, b, 1);
  }
  expect_same(m, a, b, 1e-14);  // MuJoCo 2.2.2 normalises the quaternions at each call
}

INSTANTIATE_TEST_SUITE_P(Integrators, SceneStates, ::testing::Values("Euler", "RK4", "implicit"),
                         [](const auto& name) { return std::string(name.param); });

// How the callback is watched: what it allocates, once warm.
long allocations_inside = 0;
void watched_callback(const mjModel* m, mjData* d) {
  const long before = testing::AllocationCounter::total();
  {
    const testing::AllocationCounter counter;
    volcontact_passive(m, d);
  }
  allocations_inside += testing::AllocationCounter::total() - before;
}

TEST(SceneStates, WarmStepAllocatesNothing) {
  const auto m = testing::load(stack("RK4"));
  const auto d = testing::make_data(m);
  const testing::Attached attached(m);
  run(m, d, 200);
  mjcb_passive = watched_callback;
  allocations_inside = 0;
  run(m, d, 200);
  mjcb_passive = volcontact_passive;
  EXPECT_EQ(allocations_inside, 0);
}

// Twenty spheres in a row as one solid on a floor: more contact sites than a pair has rows.
TEST(SceneStates, SitesBeyondTheRowsAreCounted) {
  std::ostringstream geoms, parts;
  for (int i = 0; i < 20; ++i) {
    geoms << "<geom name='s" << i << "' size='.02' pos='" << 0.1 * i << " 0 0'/>";
    parts << "<element objtype='geom' objname='s" << i << "' prm='1'/>";
  }
  std::ostringstream scene;
  scene << "<mujoco><worldbody><geom name='floor' type='box' size='5 5 1' pos='0 0 -1'/>"
        << "<body pos='0 0 .0199'><freejoint/>" << geoms.str() << "</body></worldbody><custom>"
        << "<numeric name='volcontact/option/tolerance' data='1e-2'/>"
        << "<numeric name='volcontact/pair/p/friction_law/bristle' data='1'/>"
        << "<tuple name='volcontact/pair/p'><element objtype='geom' objname='s0'/>"
        << "<element objtype='geom' objname='floor'/></tuple>"
        << "<tuple name='volcontact/solid/row'>" << parts.str() << "</tuple></custom></mujoco>";
  const auto m = testing::load(scene.str());
  const auto d = testing::make_data(m);
  const testing::Attached attached(m);
  mj_forward(m.get(), d.get());
  ASSERT_EQ(volcontact_sites(m.get(), d.get(), nullptr, 0), 20);
  volcontact_energy energy;
  ASSERT_EQ(volcontact_get_energy(m.get(), d.get(), &energy), 0);
  EXPECT_EQ(energy.forgotten, 1.0);
  EXPECT_EQ(energy.dropped, 0.0);
}

TEST(SceneStates, ASceneWithoutMemoryKeepsNoRows) {
  const auto m = testing::compile(
      std::string("<mujoco><worldbody><geom type=\"plane\" size=\"1 1 1\"/>") +
      "<body><freejoint/><geom name=\"ball\" size=\".1\"/></body></worldbody>" +
      testing::material("m", {{"friction_law/regularized_coulomb", "1"}}, {"ball"}) + "</mujoco>");
  // But for the energy of the one pair.
  const int energies = SitePoolLayout{rows_for(1, 2), PairEnergy::kNumbers}.size();
  EXPECT_EQ(SceneContact(m.get()).layout(m.get()).states, energies);
}

}  // namespace
}  // namespace volcontact::adaptor::scene_states_test
