// SPDX-License-Identifier: Apache-2.0
#include "volcontact/step/implicit_step.h"

#include <gtest/gtest.h>

#include <cmath>

#include "adaptor/passive_callback.h"
#include "adaptor/step/mujoco_mechanism.h"
#include "adaptor/support/count_allocations.h"
#include "adaptor/support/models.h"
#include "adaptor/support/servo_scene.h"
#include "core/support/random.h"

namespace volcontact::adaptor::implicit_step_test {
namespace {

using testing::Attached;
using testing::bodies;
using testing::DataPointer;
using testing::keys;
using testing::ModelPointer;
using testing::scatter;

// The linear model of a site is that of theory: f = f_0 - D (u' - u) - h K u'.
TEST(ImplicitStep, TakesStiffnessAndDampingOfTheSite) {
  const ModelPointer m = testing::load(
      "<mujoco><option timestep=\"2e-3\"/><worldbody>"
      "<geom name=\"floor\" type=\"plane\" size=\"2 2 .1\"/><body pos=\"0 0 .099\"><freejoint/>"
      "<geom name=\"low\" type=\"box\" size=\".15 .12 .1\" mass=\"3\"/></body></worldbody>" +
      keys("on", "regularized_coulomb", "2e9", {"floor", "low"}) + "</mujoco>");
  const Attached attached(m);
  const DataPointer d = testing::make_data(m);
  d->qvel[2] = -0.5;
  mj_forward(m.get(), d.get());
  const ImplicitStep& step = thread_scratch().implicit;
  const double h = 2e-3, k = 1e9, area = 0.3 * 0.24, depth = 1e-3, a = 0.3;
  const double raised = 1.0 + a * 0.5;  // k (1 + a v) is df/dV
  const auto slope = step.slope(0);
  EXPECT_NEAR(slope(0, 0) / (h * k * area * raised + k * area * depth * a), 1.0, 1e-9);
  const double bed = h * k * area * raised + k * area * depth * a;
  EXPECT_NEAR(slope(1, 1) + slope(2, 2), bed * (0.09 + 0.0576) / 12.0, 1e-6 * bed);
  EXPECT_NEAR(step.constant(0)[0] / (k * area * depth), 1.0, 1e-9);  // without the damping
}

// Damping of the joints, and the integrator: an implicit one has a matrix that is not symmetric.
class BothForms : public ::testing::TestWithParam<std::pair<double, mjtIntegrator>> {};

TEST_P(BothForms, ForForcesAndForVelocitiesAgree) {
  const auto [damping, integrator] = GetParam();
  const ModelPointer m =
      testing::load(bodies("", damping, keys("on", "regularized_coulomb", "2e9")));
  m->opt.integrator = integrator;
  const Attached attached(m);
  const DataPointer d = testing::make_data(m);
  scatter(m, d, 5);
  mj_forward(m.get(), d.get());
  const std::vector<ContactPlace> places = {
      {1, 0, {0.1, 0.05, 0.0}, basis_with_z(Vec3(0.0, 0.6, 0.8))},
      {2, 1, {0.0, 0.02, 0.2}, basis_with_z(Vec3(0.1, 0.0, 1.0).normalized())},
      {4, 2, {0.05, 0.0, 0.3}, basis_with_z(Vec3::UnitZ())}};
  const std::vector<double> known(static_cast<std::size_t>(m->nv), 1.0);
  ContactIslands islands;
  const MechanismTrees trees = trees_of(m.get());
  islands.build(trees, places);
  ASSERT_EQ(islands.count(), 1);
  ContactSpace space;
  const StepMetric none;
  const MujocoMechanism mechanism(m.get(), d.get(), trees, none);
  space.build(mechanism, places, islands, 0, known.data());
  space.constrain(NoConstraints());
  EXPECT_EQ(space.is_symmetric(), integrator != mjINT_IMPLICIT);
  space.build_mobility();
  space.build_delassus();
  ContactEquations equations;
  test::Random random(3);
  equations.constant.resize(18);
  for (double& constant : equations.constant) constant = random.uniform(-50.0, 50.0);
  equations.slopes.resize(3);
  const auto press = [&](std::size_t place) {
    Mat3 root;
    for (int k = 0; k < 3; ++k) root.col(k) = random.in_box(1e3);
    equations.slopes[place].normal = root * root.transpose();
  };
  const auto rub = [&](std::size_t place) {
    equations.slopes[place].friction = 1e6 * random.in_box(1.0).cwiseAbs2();
  };
  const auto expect_same = [&] {
    std::vector<double> force, velocity, other_force, other_velocity;
    ContactEquations fresh = equations;
    fresh.forget();
    fresh.solve_for_dofs(space, 2e-3, force, velocity);
    equations.solve_for_forces(space, 2e-3, other_force, other_velocity);
    const auto f = Vector<18>::from(force.data()), other = Vector<18>::from(other_force.data());
    EXPECT_LT((f - other).norm(), 1e-9 * f.norm());
    std::vector<double> moved(18);
    space.move(force, moved);
    for (std::size_t i = 0; i < 18; ++i) {
      EXPECT_NEAR(velocity[i], other_velocity[i], 1e-10);
      EXPECT_NEAR(velocity[i], moved[i], 1e-8);
    }
  };
  // From solution to solution, as in a step: what was factored must not outlive what it was of.
  expect_same();  // nothing is borne
  for (std::size_t place = 0; place < 3; ++place) press(place);
  expect_same();
  for (std::size_t place = 0; place < 3; ++place) rub(place);
  expect_same();
  for (std::size_t place = 0; place < 3; ++place) rub(place);
  expect_same();
  equations.slopes[1].friction.setZero();
  expect_same();
  for (ContactEquations::Slope& slope : equations.slopes) slope.friction.setZero();
  expect_same();
  rub(2);
  expect_same();
  rub(0);
  expect_same();
  equations.slopes[0].normal.setZero();  // it rubs and does not press
  expect_same();
  press(0);
  equations.slopes[2] = {};
  expect_same();
}

INSTANTIATE_TEST_SUITE_P(Mechanisms, BothForms,
                         ::testing::Values(std::pair{0.0, mjINT_EULER}, std::pair{2.0, mjINT_EULER},
                                           std::pair{2.0, mjINT_IMPLICIT}));

std::string soft_ball(const std::string& mode) {
  return testing::ball_scene(
      0.06,
      testing::numeric("volcontact/option/implicit/" + mode, "1") +
          testing::material("m", {{"stiffness", "2e8"}, {"damping", "0.3"}}, {"floor", "ball"}));
}

TEST(ImplicitStep, SoftContactIsExplicitToTheBit) {
  const ModelPointer with = testing::load(soft_ball("auto")), off = testing::load(soft_ball("off"));
  const DataPointer d = testing::make_data(with), e = testing::make_data(off);
  const Attached attached(with), also(off);
  double least = 1.0;
  for (int i = 0; i < 3000; ++i) {
    mj_step(with.get(), d.get());
    mj_step(off.get(), e.get());
    least = std::min(least, d->qpos[2]);
  }
  for (int i = 0; i < with->nq; ++i) EXPECT_EQ(d->qpos[i], e->qpos[i]);
  for (int i = 0; i < with->nv; ++i) EXPECT_EQ(d->qvel[i], e->qvel[i]);
  EXPECT_LT(least, 0.05);  // it did touch
}

// A ball that an explicit step holds, and 3 m from it a box on the same floor that it does not.
std::string ball_and_box(const std::string& mode, bool with_box) {
  const std::string box =
      "<body pos=\"3 0 .12\" euler=\"10 5 0\"><freejoint/><geom name=\"box\" type=\"box\" "
      "size=\".1 .1 .1\" mass=\"3\"/></body>";
  const auto material = [](const char* name, const char* stiffness, const char* geom) {
    return testing::material(
        name, {{"stiffness", stiffness}, {"damping", "0.3"}, {"friction", "0"}}, {geom});
  };
  return "<mujoco><option timestep=\"2e-3\"><flag energy=\"enable\"/></option><worldbody>"
         "<geom name=\"floor\" type=\"plane\" size=\"9 9 .1\"/><body pos=\"0 0 .06\"><freejoint/>"
         "<geom name=\"ball\" type=\"sphere\" size=\".05\" mass=\"2\"/></body>" +
         (with_box ? box : "") + "</worldbody>" +
         testing::numeric("volcontact/option/implicit/" + mode, "1") +
         material("rock", "1e12", "floor") + material("foam", "3e6", "ball") +
         (with_box ? material("steel", "1e12", "box") : "") + "</mujoco>";
}

TEST(ImplicitStep, SoftContactIsExplicitBesideStiff) {
  const ModelPointer both = testing::load(ball_and_box("auto", true));
  const ModelPointer alone = testing::load(ball_and_box("off", false));
  const DataPointer d = testing::make_data(both), e = testing::make_data(alone);
  const Attached attached(both), also(alone);
  int together = 0;
  for (int i = 0; i < 500; ++i) {
    mj_step(both.get(), d.get());
    mj_step(alone.get(), e.get());
    const ImplicitStep& step = thread_scratch().implicit;
    volcontact_site sites[2];
    if (volcontact_sites(both.get(), d.get(), sites, 2) < 2) continue;
    ++together;
    EXPECT_NE(step.is_solved(0), step.is_solved(1));
  }
  EXPECT_GT(together, 100);
  for (int i = 0; i < alone->nq; ++i) EXPECT_EQ(d->qpos[i], e->qpos[i]) << i;
  for (int i = 0; i < alone->nv; ++i) EXPECT_EQ(d->qvel[i], e->qvel[i]) << i;
}

// What a body does depends on no contact of others that it does not touch.
TEST(ImplicitStep, IslandsAreSolvedAsIfAlone) {
  const ModelPointer both = testing::load(ball_and_box("on", true));
  const ModelPointer alone = testing::load(ball_and_box("on", false));
  const DataPointer d = testing::make_data(both), e = testing::make_data(alone);
  const Attached attached(both), also(alone);
  for (int i = 0; i < 500; ++i) {
    mj_step(both.get(), d.get());
    mj_step(alone.get(), e.get());
  }
  for (int i = 0; i < alone->nq; ++i) EXPECT_EQ(d->qpos[i], e->qpos[i]) << i;
  for (int i = 0; i < alone->nv; ++i) EXPECT_EQ(d->qvel[i], e->qvel[i]) << i;
}

TEST(ImplicitStep, EnergyAccountClosesWhereSomeContactsAreExplicit) {
  const ModelPointer m = testing::load(ball_and_box("auto", true));
  m->opt.gravity[2] = 0.0;
  const Attached attached(m);
  const DataPointer d = testing::make_data(m);
  d->qvel[2] = d->qvel[8] = -1.0;
  double first = 0.0;
  volcontact_energy e{};
  bool mixed = false;
  for (int i = 0; i < 60; ++i) {
    mj_forward(m.get(), d.get());
    ASSERT_EQ(volcontact_get_energy(m.get(), d.get(), &e), 0);
    volcontact_site sites[2];
    mixed = mixed || volcontact_sites(m.get(), d.get(), sites, 2) == 2;
    double sum = d->energy[1] + e.elastic + e.numerical;
    for (const double dissipated : e.dissipated) sum += dissipated;
    if (i == 0) first = sum;
    EXPECT_NEAR(sum, first, 1e-9 * std::max(first, e.elastic)) << i;
    mj_step(m.get(), d.get());
  }
  EXPECT_TRUE(mixed);
}

TEST(ImplicitStep, SitesReportTheForcesThatAct) {
  const ModelPointer m = testing::load(bodies("", 2.0, keys("auto", "bristle", "2e10")));
  const Attached attached(m);
  const DataPointer d = testing::make_data(m);
  for (int i = 0; i < 300; ++i) mj_step(m.get(), d.get());
  std::vector<volcontact_site> sites(100);
  sites.resize(static_cast<std::size_t>(volcontact_sites(m.get(), d.get(), sites.data(), 100)));
  ASSERT_GE(sites.size(), 2u);
  Vec3 on_low = Vec3::Zero();
  for (const volcontact_site& site : sites) {
    const Vec3 force(site.force);
    if (m->geom_bodyid[site.geom_a] == 1) on_low += force;
    if (m->geom_bodyid[site.geom_b] == 1) on_low -= force;
  }
  EXPECT_GT(on_low.norm(), 1.0);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(d->qfrc_applied[i], on_low[i], 1e-9 * on_low.norm());
}

// Without weight nothing else takes part: kinetic + elastic + dissipated energy is constant.
TEST(ImplicitStep, EnergyAccountCloses) {
  for (const char* friction : {"regularized_coulomb", "bristle"}) {
    const ModelPointer m = testing::load(
        "<mujoco><option timestep=\"2e-3\" gravity=\"0 0 0\"><flag energy=\"enable\"/></option>"
        "<worldbody><geom name=\"floor\" type=\"plane\" size=\"2 2 .1\"/><body pos=\"0 0 .11\">"
        "<freejoint/><geom name=\"low\" type=\"box\" size=\".1 .1 .1\" mass=\"3\"/></body>"
        "</worldbody>" +
        keys("auto", friction, "2e10", {"floor", "low"}) + "</mujoco>");
    const Attached attached(m);
    const DataPointer d = testing::make_data(m);
    d->qvel[0] = 0.7;
    d->qvel[2] = -1.3;
    double first = 0.0;
    bool stored = false;
    volcontact_energy e{};
    for (int i = 0; i < 40; ++i) {
      mj_forward(m.get(), d.get());
      ASSERT_EQ(volcontact_get_energy(m.get(), d.get(), &e), 0);
      double sum = d->energy[1] + e.elastic;
      for (const double dissipated : e.dissipated) sum += dissipated;
      if (i == 0) first = sum;
      stored = stored || e.elastic > 0.1 * first;
      EXPECT_NEAR(sum, first, 1e-9 * std::max(first, e.elastic)) << friction << " " << i;
      mj_step(m.get(), d.get());
    }
    EXPECT_TRUE(stored);
    EXPECT_GT(e.dissipated[2], 0.0);                                              // by sliding
    EXPECT_GT(e.dissipated[0] + e.dissipated[1] + e.dissipated[2], 0.2 * first);  // in all
  }
}

// What lay still is pushed, lifted and turned in one step: one solution with the friction of before
// is no longer right.
TEST(ImplicitStep, WhatIsKickedOutOfRestIsHeldByNoMoreThanFrictionCan) {
  constexpr double kFriction = 0.4;  // of keys()
  test::Random random(31);
  for (const char* friction : {"elastic_coulomb", "bristle"}) {
    const ModelPointer m = testing::load(
        "<mujoco><option timestep=\"2e-3\" gravity=\"1.4 0.3 -9.7\"/><worldbody>"
        "<geom name=\"floor\" type=\"plane\" size=\"2 2 .1\"/><body pos=\"0 0 .1\"><freejoint/>"
        "<geom name=\"low\" type=\"box\" size=\".15 .12 .1\" mass=\"3\"/></body></worldbody>" +
        keys("on", friction, "2e9", {"floor", "low"}) + "</mujoco>");
    const Attached attached(m);
    const DataPointer rest = testing::make_data(m), d = testing::make_data(m);
    mj_step(m.get(), rest.get());
    for (int i = 0; i < 500; ++i) mj_step(m.get(), rest.get());
    int held = 0, slid = 0;
    for (int kick = 0; kick < 1000; ++kick) {
      mj_copyData(d.get(), m.get(), rest.get());
      const double size = random.log_uniform(5.0, 50.0);
      for (int i = 0; i < 6; ++i) {
        d->xfrc_applied[6 + i] = random.uniform(-1.0, 1.0) * (i < 3 ? size : 0.1 * size);
      }
      for (int i = 0; i < 3; ++i) {
        mj_step(m.get(), d.get());
        volcontact_site site;
        if (volcontact_sites(m.get(), d.get(), &site, 1) != 1) break;
        const Vec3 n(site.normal), force(site.force);
        const double across = (force - force.dot(n) * n).norm();
        EXPECT_LT(across, kFriction * site.normal_force * (1.0 + 1e-6) + 1e-9)
            << friction << " " << kick << " " << i;
        (across < 0.99 * kFriction * site.normal_force ? held : slid) += 1;
      }
    }
    EXPECT_GT(held, 200);
    EXPECT_GT(slid, 100);
  }
}

TEST(ImplicitStep, AllocatesNothingWhenWarm) {
  const std::string limits = "limited=\"true\" range=\".001 2\"";
  for (const double damping : {0.0, 2.0, 3.0}) {
    const ModelPointer m =
        testing::load(bodies(damping == 3.0 ? "integrator=\"implicit\"" : "", damping,
                             keys("auto", "bristle", "2e10"), damping > 0.0 ? limits : ""));
    const Attached attached(m);
    const DataPointer d = testing::make_data(m);
    scatter(m, d, 1);
    mj_forward(m.get(), d.get());
    ASSERT_FALSE(thread_scratch().implicit.empty());
    const long before = testing::AllocationCounter::total();
    {
      const testing::AllocationCounter counter;
      for (int i = 0; i < 10; ++i) volcontact_passive(m.get(), d.get());
    }
    EXPECT_EQ(testing::AllocationCounter::total(), before) << damping;
  }
}

// One evaluation at one time is one evaluation, however often it is asked for.
TEST(ImplicitStep, RepeatedEvaluationsChangeNothing) {
  for (const char* target : {"applied", "passive", "xfrc"}) {
    const ModelPointer m = testing::load(
        bodies("", 2.0,
               keys("auto", "bristle", "2e10") +
                   testing::numeric(std::string("volcontact/option/target/") + target, "1")));
    const Attached attached(m);
    const DataPointer once = testing::make_data(m), often = testing::make_data(m);
    for (int i = 0; i < 60; ++i) {
      mj_step(m.get(), once.get());
      mj_forward(m.get(), often.get());
      mj_forward(m.get(), often.get());
      mj_step(m.get(), often.get());
    }
    for (int i = 0; i < m->nv; ++i) EXPECT_EQ(once->qvel[i], often->qvel[i]) << target;
  }
}

}  // namespace
}  // namespace volcontact::adaptor::implicit_step_test
