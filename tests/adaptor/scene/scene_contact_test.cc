// SPDX-License-Identifier: Apache-2.0
#include "adaptor/scene/scene_contact.h"

#include <gtest/gtest.h>

#include <limits>
#include <thread>

#include "adaptor/support/count_allocations.h"
#include "adaptor/support/models.h"

namespace volcontact::adaptor::scene_contact_test {
namespace {

using testing::Attached;
using testing::DataPointer;
using testing::ModelPointer;

std::vector<volcontact_site> sites(const ModelPointer& m, const DataPointer& d) {
  std::vector<volcontact_site> out(100);
  out.resize(static_cast<std::size_t>(volcontact_sites(m.get(), d.get(), out.data(), 100)));
  return out;
}

volcontact_energy energy(const ModelPointer& m, const DataPointer& d) {
  volcontact_energy out{};
  EXPECT_EQ(volcontact_get_energy(m.get(), d.get(), &out), 0);
  return out;
}

void step(const ModelPointer& m, const DataPointer& d, int count) {
  for (int i = 0; i < count; ++i) mj_step(m.get(), d.get());
}

// Two bodies of one stiffness are in series: half of it acts.
std::string both(const std::string& stiffness, const std::string& damping,
                 const std::string& geom) {
  return testing::material(
      "m", {{"stiffness", stiffness}, {"damping", damping}, {"friction", "0.1"}}, {"floor", geom});
}

TEST(SceneContact, BallRestsWhereTheCapCarriesItsWeight) {
  // k V(h) = m g with V = pi h^2 (3 R - h) / 3, R = 0.05 m, k = 1e8 N/m^3, m = 1 kg.
  constexpr double kDepth = 0.792364e-3;
  const ModelPointer m = testing::load(testing::ball_scene(0.0493, both("2e8", "10", "ball")));
  m->opt.timestep = 1e-3;
  const DataPointer d = testing::make_data(m);
  const Attached attached(m);
  step(m, d, 1000);
  EXPECT_NEAR(0.05 - d->qpos[2], kDepth, 1e-6 * kDepth);
  const auto found = sites(m, d);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].depth, kDepth, 1e-6 * kDepth);
  EXPECT_NEAR(found[0].normal_force, 9.81, 1e-8);
  EXPECT_NEAR(found[0].force[2], -9.81, 1e-8);  // on the floor, the lower geom
}

TEST(SceneContact, CubeRestsAtWeightOverStiffnessAndFace) {
  // h = m g / (k A) = 9.81 / (1e7 0.04) m.
  constexpr double kDepth = 24.525e-6;
  const ModelPointer m = testing::load(
      "<mujoco><option timestep=\"5e-4\"/><worldbody><geom name=\"floor\" type=\"plane\" "
      "size=\"1 1 .1\"/><body pos=\"0 0 .09998\"><freejoint/><geom name=\"cube\" type=\"box\" "
      "size=\".1 .1 .1\" mass=\"1\"/></body></worldbody>" +
      both("2e7", "10", "cube") + "</mujoco>");
  const DataPointer d = testing::make_data(m);
  const Attached attached(m);
  step(m, d, 2000);
  EXPECT_NEAR(0.1 - d->qpos[2], kDepth, 1e-6 * kDepth);
  EXPECT_NEAR(d->qpos[3], 1.0, 1e-12);
}

TEST(SceneContact, SceneWithoutAKeyWorks) {
  // Two default materials: k = 5e6 N/m^3, so h = m g / (k A) = 49.05 um.
  const ModelPointer m = testing::load(
      "<mujoco><option timestep=\"5e-4\"/><worldbody><geom type=\"plane\" size=\"1 1 .1\"/>"
      "<body pos=\"0 0 .0999\"><freejoint/><geom type=\"box\" size=\".1 .1 .1\" mass=\"1\"/></body>"
      "</worldbody></mujoco>");
  const DataPointer d = testing::make_data(m);
  const Attached attached(m);
  step(m, d, 6000);
  EXPECT_NEAR(0.1 - d->qpos[2], 49.05e-6, 1e-3 * 49.05e-6);
}

// Energy: kinetic + potential + elastic + dissipated.

struct Run {
  const char* integrator;
  double timestep;
};

class EnergyBalance : public ::testing::TestWithParam<Run> {};

TEST_P(EnergyBalance, ClosesForABouncingSlidingSpinningBall) {
  const std::string keys = testing::material(
      "m", {{"stiffness", "2e7"}, {"damping", "0.5"}, {"friction", "0.3"}, {"slip_speed", "0.05"}},
      {"floor", "ball"});
  const ModelPointer m = testing::load(
      testing::ball_scene(0.1, keys, std::string("integrator=\"") + GetParam().integrator + "\""));
  m->opt.timestep = GetParam().timestep;
  m->opt.enableflags |= mjENBL_ENERGY;
  const DataPointer d = testing::make_data(m);
  d->qvel[0] = 1.0;
  d->qvel[4] = -10.0;
  d->qvel[5] = 30.0;
  const Attached attached(m);
  double first = 0.0, worst = 0.0, without_work = 0.0;
  const int steps = static_cast<int>(0.5 / GetParam().timestep);
  for (int i = 0; i < steps; ++i) {
    mj_forward(m.get(), d.get());  // all at one instant, also under Runge-Kutta
    const volcontact_energy e = energy(m, d);
    double sum = d->energy[0] + d->energy[1] + e.elastic;
    for (const double dissipated : e.dissipated) sum += dissipated;
    if (i == 0) first = sum;
    worst = std::max(worst, std::abs(sum - first));
    without_work = std::max(without_work, std::abs(d->energy[0] + d->energy[1] - e.work - first));
    EXPECT_NEAR(sum - first + e.numerical, d->energy[0] + d->energy[1] - e.work - first,
                1e-12 * first);
    mj_step(m.get(), d.get());
  }
  EXPECT_LT(worst, 1e-3 * first);
  EXPECT_LT(without_work, 1e-4 * first);  // m g h v/2 of Euler's free fall is 4e-5 of it
  const volcontact_energy e = energy(m, d);
  EXPECT_GT(e.dissipated[0], 0.0);                     // normal
  EXPECT_GT(e.dissipated[2] + e.dissipated[3], 0.05);  // slide and spin: it was thrown fast
}

INSTANTIATE_TEST_SUITE_P(Integrators, EnergyBalance,
                         ::testing::Values(Run{"Euler", 1e-5}, Run{"RK4", 1e-4},
                                           Run{"implicit", 1e-5}),
                         [](const auto& run) { return std::string(run.param.integrator); });

// What the forces in the target array do to the motion: docs/theory.md, "Energy".
class Work : public ::testing::TestWithParam<const char*> {};

// Without weight the contact alone changes the kinetic energy, and a ball has no gyroscopic torque:
// the account is exact for any step, explicit or implicit, beside a force of the user's own.
TEST_P(Work, IsTheChangeOfKineticEnergyAtAnyStep) {
  using Case = std::pair<const char*, const char*>;  // stiffness, damping
  for (const auto& [stiffness, damping] : {Case{"2e7", "1"}, Case{"2e7", "0"}, Case{"2e12", "1"}}) {
    const ModelPointer m = testing::load(testing::ball_scene(
        0.06,
        testing::numeric(std::string("volcontact/option/target/") + GetParam(), "1") +
            testing::material("m",
                              {{"stiffness", stiffness},
                               {"damping", damping},
                               {"friction", "0.3"},
                               {"friction_law/regularized_coulomb", "1"}},
                              {"floor", "ball"}),
        "gravity=\"0 0 0\""));
    m->opt.timestep = 2e-3;
    m->opt.enableflags |= mjENBL_ENERGY;
    const DataPointer d = testing::make_data(m);
    const double start[] = {0.7, 0.2, -1.3, 3.0, -10.0, 30.0};
    std::copy(std::begin(start), std::end(start), d->qvel);
    const Attached attached(m);
    double kinetic = 0.0;
    for (int i = 0; i < 40; ++i) {
      mj_step(m.get(), d.get());
      mj_forward(m.get(), d.get());
      if (i == 0) kinetic = d->energy[1];
      const volcontact_energy e = energy(m, d);
      EXPECT_NEAR(d->energy[1] - e.work, kinetic, 1e-12 * kinetic) << stiffness << " " << i;
      const double spent = e.dissipated[0] + e.dissipated[1] + e.dissipated[2] + e.dissipated[3];
      EXPECT_NEAR(e.work + e.elastic + spent + e.numerical, 0.0, 1e-12 * kinetic);
    }
    const volcontact_energy e = energy(m, d);
    EXPECT_LT(e.work, -0.1 * kinetic);
    // What damps takes what the forces of a step took; a spring has nothing to lose it to.
    if (std::string(damping) == "0") {
      EXPECT_GT(std::abs(e.numerical), 1e-4 * kinetic);
    } else {
      EXPECT_LT(std::abs(e.numerical), 1e-6 * kinetic) << stiffness;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, Work, ::testing::Values("applied", "passive", "xfrc"),
                         [](const auto& run) { return std::string(run.param); });

TEST(WorkAccount, StepThatIsRedoneCountsOnce) {
  double work[2];
  for (const bool redone : {false, true}) {
    const ModelPointer m = testing::load(testing::ball_scene(0.049, both("2e7", "1", "ball")));
    const DataPointer d = testing::make_data(m);
    const Attached attached(m);
    for (int i = 0; i < 50; ++i) {
      for (int trial = 0; redone && trial < 3; ++trial) mj_forward(m.get(), d.get());
      mj_step(m.get(), d.get());
    }
    work[redone ? 1 : 0] = energy(m, d).work;
  }
  EXPECT_GT(std::abs(work[0]), 1e-5);
  EXPECT_EQ(work[0], work[1]);
}

// A pile in which many pairs touch, all of the fast engines' kind.
constexpr const char* kPile = R"(
<mujoco><option timestep="1e-3"/><worldbody>
  <geom name="floor" type="plane" size="2 2 .1"/>
  <geom name="wall" type="box" size=".02 1 1" pos="-.2 0 0"/>
  <body pos="0 0 .15"><freejoint/><geom type="box" size=".15 .1 .1" mass="2"/></body>
  <body pos=".02 .03 .37" euler="10 5 0"><freejoint/><geom type="box" size=".1 .1 .1" mass="1"/>
  </body>
  <body pos=".4 0 .12"><freejoint/><geom type="sphere" size=".1" mass="1"/></body>
  <body pos=".4 .02 .32"><freejoint/><geom type="sphere" size=".1" mass="1"/></body>
  <body pos="0 .5 .2" euler="30 0 0"><freejoint/><geom type="ellipsoid" size=".1 .15 .08"/></body>
  <body pos="-.05 0 .55"><joint axis="0 1 0" pos=".3 0 0"/>
    <geom type="box" size=".1 .1 .03" mass="1"/></body>
</worldbody></mujoco>)";

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

TEST(SceneContact, WarmStepAllocatesNothing) {
  const ModelPointer m = testing::load(kPile);
  const DataPointer d = testing::make_data(m);
  const Attached attached(m);
  mjcb_passive = watched_callback;
  allocations_inside = 0;
  step(m, d, 1500);
  EXPECT_GT(allocations_inside, 0) << "the counter does not count";
  EXPECT_GE(sites(m, d).size(), 4u);
  allocations_inside = 0;
  step(m, d, 1500);
  EXPECT_EQ(allocations_inside, 0);
  mjcb_passive = volcontact_passive;
}

TEST(SceneContact, MomentumOfFreeBodiesIsConserved) {
  const ModelPointer m = testing::load(kPile);
  m->opt.gravity[2] = 0.0;
  m->geom_contype[0] = m->geom_conaffinity[0] = 0;
  m->geom_contype[1] = m->geom_conaffinity[1] = 0;
  m->geom_contype[7] = m->geom_conaffinity[7] = 0;  // hangs on the world
  const DataPointer d = testing::make_data(m);
  d->qvel[2] = 1.0;
  d->qvel[8] = -1.0;
  d->qvel[14] = 0.5;
  d->qvel[20] = -0.5;
  const Attached attached(m);
  const auto momentum = [&] {
    mj_forward(m.get(), d.get());
    mj_subtreeVel(m.get(), d.get());
    // Of all bodies together: linear, and angular about the origin.
    Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
    for (int body = 1; body <= 5; ++body) {
      const Vec3 p = m->body_mass[body] * vec3_at(d->subtree_linvel, body);
      linear += p;
      angular +=
          Vec3(vec3_at(d->subtree_angmom, body)) + Vec3(vec3_at(d->subtree_com, body)).cross(p);
    }
    return std::pair{linear, angular};
  };
  const auto before = momentum();
  double strongest = 0.0;
  for (int i = 0; i < 300; ++i) {
    mj_step(m.get(), d.get());
    for (const volcontact_site& site : sites(m, d)) {
      strongest = std::max(strongest, site.normal_force);
    }
  }
  const auto after = momentum();
  EXPECT_GT(strongest, 10.0);
  EXPECT_LT((after.first - before.first).norm(), 1e-12);
  EXPECT_LT((after.second - before.second).norm(), 1e-4);  // MuJoCo's free rotation: O(h)
}

void expect_equal_states(const ModelPointer& m, const DataPointer& a, const DataPointer& b) {
  for (int i = 0; i < m->nq; ++i) EXPECT_EQ(a->qpos[i], b->qpos[i]);
  for (int i = 0; i < m->nv; ++i) EXPECT_EQ(a->qvel[i], b->qvel[i]);
  for (int i = 0; i < m->nuserdata; ++i) EXPECT_EQ(a->userdata[i], b->userdata[i]);
}

TEST(SceneContact, CopiedDataGoOnAsTheOriginal) {
  const ModelPointer m = testing::load(kPile);
  const DataPointer d = testing::make_data(m), copy = testing::make_data(m);
  const Attached attached(m);
  step(m, d, 400);
  mj_copyData(copy.get(), m.get(), d.get());
  step(m, d, 400);
  step(m, copy, 400);
  expect_equal_states(m, d, copy);
}

TEST(SceneContact, ResetDataStartAsNew) {
  const ModelPointer m = testing::load(kPile);
  const DataPointer used = testing::make_data(m), fresh = testing::make_data(m);
  const Attached attached(m);
  step(m, used, 400);
  mj_resetData(m.get(), used.get());
  EXPECT_TRUE(sites(m, used).empty());
  EXPECT_EQ(energy(m, used).dissipated[0], 0.0);
  step(m, used, 400);
  step(m, fresh, 400);
  expect_equal_states(m, used, fresh);
}

TEST(SceneContact, RepeatedForwardAndInverseChangeNothing) {
  const ModelPointer m = testing::load(kPile);
  const DataPointer plain = testing::make_data(m), repeated = testing::make_data(m);
  const Attached attached(m);
  for (int i = 0; i < 400; ++i) {
    mj_forward(m.get(), repeated.get());
    mj_inverse(m.get(), repeated.get());
    mj_forward(m.get(), repeated.get());
    // Each of these makes the quaternions unit again, which may change their last bit.
    for (int k = 0; k < 3; ++k) mj_kinematics(m.get(), plain.get());
    step(m, repeated, 1);
    step(m, plain, 1);
  }
  expect_equal_states(m, plain, repeated);
}

TEST(SceneContact, ThreadsOnTheirOwnDataEqualASingleRun) {
  const ModelPointer m = testing::load(kPile);
  const Attached attached(m);
  const DataPointer single = testing::make_data(m);
  step(m, single, 500);
  std::vector<DataPointer> data;
  for (int i = 0; i < 8; ++i) data.push_back(testing::make_data(m));
  std::vector<std::thread> threads;
  for (const DataPointer& d : data) threads.emplace_back([&] { step(m, d, 500); });
  for (std::thread& thread : threads) thread.join();
  for (const DataPointer& d : data) expect_equal_states(m, single, d);
}

// Some pairs that take long, if the octree is forced, and so many quick ones that they are shared
// among threads.
std::string many_bodies(int bodies_count, const std::string& options) {
  std::string bodies;
  for (int i = 0; i < bodies_count; ++i) {
    const bool quick = i >= 4;
    bodies += "<body pos=\"" + std::to_string(0.5 * (i % 20)) + " " +
              std::to_string(0.5 * (i / 20)) +
              " .099\" euler=\"3 2 1\"><freejoint/><geom size=\".1 .1 .1\" type=\"" +
              (quick   ? "box"
               : i % 2 ? "cylinder"
                       : "capsule") +
              "\"/></body>";
  }
  return "<mujoco><option timestep=\"1e-3\"/><default><geom contype=\"1\" conaffinity=\"2\"/>"
         "</default><worldbody><geom name=\"floor\" type=\"box\" size=\"20 20 .1\" pos=\"0 0 -.1\" "
         "contype=\"2\" conaffinity=\"1\"/>" +
         bodies + "</worldbody>" + testing::numeric("volcontact/option/tolerance", "0.02") +
         options + "</mujoco>";
}

// Velocities after some steps, for each number of threads.
std::vector<std::vector<double>> by_threads(int bodies, const std::string& options, int steps) {
  std::vector<std::vector<double>> states;
  for (const char* threads : {"1", "2", "3", "4", "8", "16", "0"}) {
    const ModelPointer m = testing::load(
        many_bodies(bodies, options + testing::numeric("volcontact/option/threads", threads)));
    const DataPointer d = testing::make_data(m);
    const Attached attached(m);
    step(m, d, steps);
    EXPECT_EQ(volcontact_sites(m.get(), d.get(), nullptr, 0), bodies);
    states.emplace_back(d->qvel, d->qvel + m->nv);
  }
  return states;
}

TEST(SceneContact, NumberOfThreadsChangesNoBit) {
  const auto states = by_threads(230, "", 5);
  for (const std::vector<double>& state : states) EXPECT_EQ(state, states[0]);
}

TEST(SceneContact, NumberOfThreadsChangesNoBitOfWhatSitesKeep) {
  const std::string bristles = testing::material(
      "m", {{"friction_law/bristle", "1"}, {"bristle_damping", "20"}, {"restitution", "0.5"}},
      {"floor"});
  const auto states = by_threads(230, bristles, 5);
  for (const std::vector<double>& state : states) EXPECT_EQ(state, states[0]);
}

// A hollow cylinder on a bored block, which only the octree serves: unless the scene asks for the
// octree, a step gives it fewer cells than this tolerance needs, and the site says so.
TEST(SceneContact, StepHasItsBudgetOfCells) {
  const auto first_site = [](const std::string& options) {
    const std::string part = "<element objtype=\"geom\" objname=\"";
    const ModelPointer m = testing::load(
        "<mujoco><worldbody><body name=\"fixture\">"
        "<geom name=\"block\" type=\"box\" size=\".05 .05 .03\"/>"
        "<geom name=\"hole\" type=\"cylinder\" size=\".01 .04\"/></body>"
        "<body name=\"part\" pos=\".004 .003 .0492\" euler=\"2 1 0\"><freejoint/>"
        "<geom name=\"sleeve\" type=\"cylinder\" size=\".02 .02\" mass=\"1\"/>"
        "<geom name=\"bore\" type=\"cylinder\" size=\".012 .03\" mass=\"0\"/></body></worldbody>" +
        testing::numeric("volcontact/option/tolerance", "1e-11") + options +
        "<custom><tuple name=\"volcontact/solid/a\">" + part + "block\" prm=\"1\"/>" + part +
        "hole\" prm=\"-1\"/></tuple><tuple name=\"volcontact/solid/b\">" + part +
        "sleeve\" prm=\"1\"/>" + part + "bore\" prm=\"-1\"/></tuple></custom></mujoco>");
    const DataPointer d = testing::make_data(m);
    const Attached attached(m);
    mj_forward(m.get(), d.get());
    return sites(m, d).at(0);
  };
  const volcontact_site step = first_site("");
  const volcontact_site chosen =
      first_site(testing::numeric("volcontact/option/engine/octree", "1"));
  EXPECT_EQ(step.status, static_cast<int>(Status::kApproximate));
  EXPECT_LT(chosen.volume_error, 0.5 * step.volume_error);
  EXPECT_LE(std::abs(step.volume - chosen.volume), step.volume_error + chosen.volume_error);
  EXPECT_LT(step.volume_error, 0.01 * step.volume);
}

// Six pairs: fewer threads take a pair each, more of them share the cells of one.
TEST(SceneContact, NumberOfThreadsChangesNoBitOfTheOctree) {
  const auto states = by_threads(6, testing::numeric("volcontact/option/engine/octree", "1"), 3);
  for (const std::vector<double>& state : states) EXPECT_EQ(state, states[0]);
}

TEST(SceneContact, ForceThatIsNoNumberIsLeftOutAndCounted) {
  const ModelPointer m = testing::load(testing::ball_scene(0.0499, ""));
  const DataPointer d = testing::make_data(m);
  const Attached attached(m);
  mj_forward(m.get(), d.get());
  EXPECT_EQ(energy(m, d).dropped, 0.0);
  for (double* number : {&d->qvel[2], &d->qpos[2]}) {
    const double sound = *number;
    *number = std::numeric_limits<double>::quiet_NaN();
    mj_forward(m.get(), d.get());
    *number = sound;
    for (int i = 0; i < m->nv; ++i) EXPECT_TRUE(std::isfinite(d->qfrc_applied[i]));
    for (int i = 0; i < m->nuserdata; ++i) EXPECT_TRUE(std::isfinite(d->userdata[i]));
  }
  EXPECT_EQ(energy(m, d).dropped, 2.0);
  mj_forward(m.get(), d.get());
  EXPECT_EQ(energy(m, d).dropped, 2.0);
  EXPECT_GT(d->qfrc_applied[2], 0.0);
}

TEST(SceneContact, NothingIsReadBeforeTheFirstEvaluation) {
  const ModelPointer m = testing::load(testing::ball_scene(0.0499, ""));
  const DataPointer d = testing::make_data(m);
  const Attached attached(m);
  EXPECT_TRUE(sites(m, d).empty());
  EXPECT_EQ(energy(m, d).elastic, 0.0);
}

TEST(SceneContact, ReadingChangesNothing) {
  const ModelPointer m = testing::load(kPile);
  const DataPointer read = testing::make_data(m), plain = testing::make_data(m);
  const Attached attached(m);
  for (int i = 0; i < 200; ++i) {
    step(m, read, 1);
    step(m, plain, 1);
    sites(m, read);
    energy(m, read);
  }
  expect_equal_states(m, read, plain);
}

}  // namespace
}  // namespace volcontact::adaptor::scene_contact_test
