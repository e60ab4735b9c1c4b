// SPDX-License-Identifier: Apache-2.0
// Contact far beyond what an explicit step holds, at MuJoCo's usual 2 ms: docs/validation.md,
// "Implicit contact at 2 ms", has the whole table of which this is a part.
#include <gtest/gtest.h>

#include <cmath>

#include "adaptor/support/models.h"
#include "core/support/random.h"

namespace volcontact::adaptor::stiff_contact_test {
namespace {

using testing::Attached;
using testing::DataPointer;
using testing::ModelPointer;

constexpr double kStep = 2e-3, kMass = 12.0, kGravity = 9.81, kHalf = 0.1;

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

// k_v of which the whole face has `factor` times the stiffness 4 m/h^2 that an explicit step holds.
double stiffness_of(double factor) {
  return factor * 4.0 * kMass / (kStep * kStep) / (4.0 * kHalf * kHalf);
}

ModelPointer box(double factor, double friction, const std::string& more = "") {
  return testing::load(
      "<mujoco><option timestep=\"2e-3\"/><worldbody>"
      "<geom name=\"floor\" type=\"plane\" size=\"2 2 .1\"/><body><freejoint/>"
      "<geom name=\"box\" type=\"box\" size=\".1 .1 .1\" mass=\"12\"/></body></worldbody>" +
      testing::material("m",
                        {{"stiffness", number(2.0 * stiffness_of(factor))},
                         {"damping", "0"},
                         {"friction", number(friction)}},
                        {"floor", "box"}) +
      more + "</mujoco>");
}

// Kinetic and gravitational, at the positions and velocities in `d`.
double mechanical_energy(const ModelPointer& m, const DataPointer& d) {
  mj_kinematics(m.get(), d.get());
  mj_comPos(m.get(), d.get());
  mj_crb(m.get(), d.get());
  double momentum[6];
  mj_mulM(m.get(), d.get(), momentum, d->qvel);
  return 0.5 * mju_dot(momentum, d->qvel, 6) + kMass * kGravity * d->qpos[2];
}

Vector<4> random_quaternion(test::Random& random) {
  mjtNum rotation[9];
  random.rotation().to_rows(rotation);
  Vector<4> out;
  mju_mat2Quat(out.data(), rotation);
  return out;
}

void throw_at_floor(const DataPointer& d, std::uint64_t seed) {
  test::Random random(seed);
  d->qpos[2] = 0.35;
  random_quaternion(random).to(d->qpos + 3);
  for (int i = 0; i < 3; ++i) d->qvel[i] = random.uniform(-0.8, 0.8);
  for (int i = 3; i < 6; ++i) d->qvel[i] = random.uniform(-3.0, 3.0);
}

TEST(StiffContact, ThrownBoxesGainNoEnergyAndComeToRest) {
  int restless = 0, runs = 0;
  for (const double factor : {1.0, 1e3, 1e6}) {
    for (const double friction : {0.0, 0.5, 1.0}) {
      const ModelPointer m = box(factor, friction);
      const Attached attached(m);
      for (std::uint64_t seed = 0; seed < 3; ++seed) {
        const DataPointer d = testing::make_data(m);
        throw_at_floor(d, seed);
        const double first = mechanical_energy(m, d);
        double most = 0.0;
        for (int i = 0; i < 1500; ++i) {
          mj_step(m.get(), d.get());
          most = std::max(most, mechanical_energy(m, d));
        }
        EXPECT_LE(most, 1.000001 * first) << factor << " " << friction << " " << seed;
        if (friction == 0.0) continue;  // it slides on for ever
        ++runs;
        if (std::sqrt(mju_dot(d->qvel, d->qvel, 6)) > 1e-3) ++restless;
      }
    }
  }
  EXPECT_LE(restless, runs / 6);  // a corner may go on rocking, by less than a micrometre
}

// Thrown boxes of which some fall on an edge: none rocks on from edge to edge.
TEST(StiffContact, ThrownBoxesRockNoLonger) {
  for (const char* stiffness : {"2e9", "2e11", "2e13"}) {
    std::string bodies;
    test::Random random(6);
    for (int i = 0; i < 12; ++i) {
      const Vector<4> numbers = random_quaternion(random);
      bodies += "<body pos=\"" + std::to_string(0.5 * i) + " 0 .4\" quat=\"";
      for (const double x : numbers) bodies += std::to_string(x) + " ";
      bodies += "\"><freejoint/><geom name=\"box" + std::to_string(i) +
                "\" type=\"box\" size=\".1 .08 .06\" mass=\"2\"/></body>";
    }
    std::vector<std::string> geoms = {"floor"};
    for (int i = 0; i < 12; ++i) geoms.push_back("box" + std::to_string(i));
    const ModelPointer m = testing::load(
        "<mujoco><option timestep=\"2e-3\"/><worldbody><geom name=\"floor\" type=\"plane\" "
        "size=\"9 9 1\"/>" +
        bodies + "</worldbody>" +
        testing::material("m", {{"stiffness", stiffness}, {"friction", ".5"}}, geoms) +
        "</mujoco>");
    const Attached attached(m);
    const DataPointer d = testing::make_data(m);
    for (int i = 0; i < 5000; ++i) mj_step(m.get(), d.get());
    for (int i = 0; i < m->nv; ++i) EXPECT_NEAR(d->qvel[i], 0.0, 1e-9) << stiffness << " " << i;
  }
}

TEST(StiffContact, RestsAtWeightOverStiffness) {
  for (const double factor : {1.0, 1e2, 1e4}) {
    const ModelPointer m = box(factor, 0.5);
    const Attached attached(m);
    const DataPointer d = testing::make_data(m);
    d->qpos[2] = kHalf + 1e-4;
    for (int i = 0; i < 1000; ++i) mj_step(m.get(), d.get());
    const double depth = kMass * kGravity / (stiffness_of(factor) * 4.0 * kHalf * kHalf);
    EXPECT_NEAR((kHalf - d->qpos[2]) / depth, 1.0, 1e-6) << factor;
    EXPECT_LT(std::abs(d->qvel[2]), 1e-12);
  }
}

// Bristles hold what lies on a slope of less than the angle of friction, without creep.
TEST(StiffContact, StictionHoldsOnASlope) {
  const ModelPointer m = box(1e4, 0.5,
                             testing::numeric("volcontact/material/m/friction_law/bristle", "1") +
                                 testing::numeric("volcontact/material/m/static_friction", "0.5"));
  m->opt.gravity[0] = 0.4 * kGravity;
  const Attached attached(m);
  const DataPointer d = testing::make_data(m);
  d->qpos[2] = kHalf;
  for (int i = 0; i < 1000; ++i) mj_step(m.get(), d.get());
  const double place = d->qpos[0];
  for (int i = 0; i < 1000; ++i) mj_step(m.get(), d.get());
  EXPECT_NEAR(d->qpos[0], place, 1e-9);
  EXPECT_LT(std::abs(d->qvel[0]), 1e-9);
  EXPECT_LT(place, 1e-2);
}

// Sliding friction under the solved normal force: mu m g.
TEST(StiffContact, SlidingBoxIsSlowedByCoulombFriction) {
  const ModelPointer m = box(1e3, 0.3);
  const Attached attached(m);
  const DataPointer d = testing::make_data(m);
  d->qpos[2] = kHalf;
  for (int i = 0; i < 50; ++i) mj_step(m.get(), d.get());  // settles
  d->qvel[0] = 2.0;
  for (int i = 0; i < 250; ++i) mj_step(m.get(), d.get());
  EXPECT_NEAR(d->qvel[0], 2.0 - 0.3 * kGravity * 0.5, 1e-3);
}

// A two-link arm whose servos press its hand on the floor.
class ServoArm : public ::testing::TestWithParam<const char*> {};

TEST_P(ServoArm, PressesSteadily) {
  for (const auto& [stiffness, law] :
       {std::pair{"2e9", "elastic_coulomb"}, std::pair{"2e11", "elastic_coulomb"},
        std::pair{"2e13", "elastic_coulomb"}, std::pair{"2e9", "regularized_coulomb"},
        std::pair{"2e11", "regularized_coulomb"}, std::pair{"2e13", "regularized_coulomb"}}) {
    const ModelPointer m = testing::load(
        std::string("<mujoco><compiler angle=\"degree\"/><option timestep=\"2e-3\" integrator=\"") +
        GetParam() +
        "\"/><worldbody><geom name=\"floor\" type=\"plane\" size=\"2 2 .1\"/>"
        "<body pos=\"0 0 .5\"><joint name=\"shoulder\" axis=\"0 1 0\" damping=\"2\"/>"
        "<geom type=\"capsule\" fromto=\"0 0 0 .5 0 0\" size=\".02\" mass=\"3\" contype=\"0\" "
        "conaffinity=\"0\"/><body pos=\".5 0 0\"><joint name=\"elbow\" axis=\"0 1 0\" "
        "damping=\"2\"/><geom type=\"capsule\" fromto=\"0 0 0 .5 0 0\" size=\".02\" mass=\"2\" "
        "contype=\"0\" conaffinity=\"0\"/><body pos=\".5 0 0\">"
        "<geom name=\"hand\" type=\"box\" size=\".05 .05 .05\" mass=\"1\"/></body></body></body>"
        "</worldbody><actuator><position joint=\"shoulder\" kp=\"200\"/>"
        "<position joint=\"elbow\" kp=\"200\"/></actuator>" +
        testing::material("m",
                          {{"stiffness", stiffness},
                           {"damping", "0"},
                           {"friction", ".5"},
                           {std::string("friction_law/") + law, "1"}},
                          {"floor", "hand"}) +
        "</mujoco>");
    const Attached attached(m);
    const DataPointer d = testing::make_data(m);
    d->ctrl[0] = 1.2;
    d->ctrl[1] = 0.3;
    for (int i = 0; i < 5000; ++i) mj_step(m.get(), d.get());
    double least = HUGE_VAL, most = 0.0;
    for (int i = 0; i < 100; ++i) {
      mj_step(m.get(), d.get());
      volcontact_site site{};
      ASSERT_EQ(volcontact_sites(m.get(), d.get(), &site, 1), 1);
      least = std::min(least, site.normal_force);
      most = std::max(most, site.normal_force);
    }
    EXPECT_GT(least, 100.0) << stiffness;
    EXPECT_LT(most - least, 1e-3 * most) << stiffness;
  }
}

INSTANTIATE_TEST_SUITE_P(Integrators, ServoArm, ::testing::Values("Euler", "implicit"),
                         [](const auto& run) { return std::string(run.param); });

// A ball's patch does not resist turning: it goes on rolling.
TEST(StiffContact, BallRollsOnWithoutResistance) {
  const ModelPointer m = testing::load(testing::ball_scene(
      0.05, testing::material("m", {{"stiffness", "2e12"}, {"damping", "0"}, {"friction", "0.5"}},
                              {"floor", "ball"})));
  m->opt.timestep = kStep;
  const Attached attached(m);
  const DataPointer d = testing::make_data(m);
  d->qvel[0] = 0.5;
  d->qvel[4] = 10.0;
  for (int i = 0; i < 1000; ++i) mj_step(m.get(), d.get());
  EXPECT_NEAR(d->qvel[0], 0.5, 1e-3);
  EXPECT_NEAR(d->qvel[4], 10.0, 2e-2);
}

TEST(StiffContact, RungeKuttaRestsAsDeepAsStiffnessSays) {
  for (const double factor : {1e-3, 1.0, 1e3}) {
    for (const char* implicit : {"auto", "on"}) {
      const ModelPointer m =
          box(factor, 0.5,
              testing::numeric(std::string("volcontact/option/implicit/") + implicit, "1"));
      m->opt.integrator = mjINT_RK4;
      const Attached attached(m);
      const DataPointer d = testing::make_data(m);
      const double depth = kMass * kGravity / (stiffness_of(factor) * 4.0 * kHalf * kHalf);
      d->qpos[2] = kHalf - depth;
      for (int i = 0; i < 500; ++i) mj_step(m.get(), d.get());
      EXPECT_NEAR(d->qpos[2], kHalf - depth, 1e-6 * depth + 1e-15) << factor << " " << implicit;
    }
  }
}

TEST(StiffContact, RungeKuttaNeverMakesEnergy) {
  for (const double factor : {0.1, 10.0, 1e5}) {
    const ModelPointer m = box(factor, 0.5);
    m->opt.integrator = mjINT_RK4;
    const Attached attached(m);
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      const DataPointer d = testing::make_data(m);
      throw_at_floor(d, seed);
      const double start = mechanical_energy(m, d);
      double most = start;
      for (int i = 0; i < 1000; ++i) {
        mj_step(m.get(), d.get());
        most = std::max(most, mechanical_energy(m, d));
      }
      EXPECT_LE(most, 1.001 * start) << factor << " " << seed;
    }
  }
}

}  // namespace
}  // namespace volcontact::adaptor::stiff_contact_test
