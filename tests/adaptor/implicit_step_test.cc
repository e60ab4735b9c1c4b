// SPDX-License-Identifier: Apache-2.0
#include "adaptor/implicit_step.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "adaptor/passive_callback.h"
#include "adaptor/support/count_allocations.h"
#include "adaptor/support/models.h"
#include "core/support/random.h"

namespace volcontact::adaptor {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::Attached;
using testing::DataPointer;
using testing::ModelPointer;

std::string keys(const std::string& mode, const std::string& friction, const std::string& stiffness,
                 const std::vector<std::string>& geoms = {"floor", "low", "high", "hand"}) {
  return testing::numeric("volcontact/option/implicit/" + mode, "1") +
         testing::numeric("volcontact/material/m/friction_law/" + friction, "1") +
         testing::material("m", {{"stiffness", stiffness}, {"damping", "0.3"}, {"friction", "0.4"}},
                           geoms);
}

// A box on a floor, one on it, and the hand of a jointed arm on that, driven by a servo.
std::string bodies(const std::string& option, double joint_damping, const std::string& keys) {
  const std::string damping = " damping=\"" + std::to_string(joint_damping) + "\"/>";
  return "<mujoco><option timestep=\"2e-3\" " + option +
         "/><worldbody><geom name=\"floor\" type=\"plane\" size=\"2 2 .1\"/>"
         "<body pos=\"0 0 .099\"><freejoint/>"
         "<geom name=\"low\" type=\"box\" size=\".15 .12 .1\" mass=\"3\"/></body>"
         "<body pos=\".02 .01 .248\"><freejoint/>"
         "<geom name=\"high\" type=\"box\" size=\".08 .1 .05\" mass=\"1\"/></body>"
         "<body pos=\".5 0 .29\"><joint name=\"lift\" axis=\"0 1 0\"" +
         damping + "<geom type=\"sphere\" size=\".02\" mass=\"2\" pos=\"-.2 0 0\" contype=\"0\" " +
         "conaffinity=\"0\"/><body pos=\"-.3 0 0\"><joint axis=\"0 1 0\"" + damping +
         "<joint type=\"slide\" axis=\"0 1 0\"" + damping +
         "<geom name=\"hand\" type=\"box\" size=\".1 .03 .02\" pos=\"-.15 0 .026\" mass=\"1\" "
         "euler=\"3 2 0\"/></body></body></worldbody>"
         "<actuator><position joint=\"lift\" kp=\"50\"/></actuator>" +
         keys + "</mujoco>";
}

void scatter(const ModelPointer& m, const DataPointer& d, std::uint64_t seed) {
  test::Random random(seed);
  for (int i = 0; i < m->nv; ++i) d->qvel[i] = random.uniform(-0.5, 0.5);
  for (const int body : {0, 7}) {
    d->qpos[body + 2] -= random.uniform(0.0, 2e-3);
    for (int i = 4; i < 7; ++i) d->qpos[body + i] = random.uniform(-0.01, 0.01);
    mju_normalize4(d->qpos + body + 3);
  }
  d->ctrl[0] = random.uniform(-1.0, 1.0);
  for (int i = 0; i < m->nv; ++i) d->qfrc_applied[i] = random.uniform(-5.0, 5.0);
  for (int i = 6; i < 6 * m->nbody; ++i) d->xfrc_applied[i] = random.uniform(-1.0, 1.0);
}

// J of the sites by MuJoCo's own function; rows as in ContactPlace.
MatrixXd jacobian(const ModelPointer& m, const DataPointer& d,
                  const std::vector<volcontact_site>& sites) {
  using RowMajor = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>;
  MatrixXd out = MatrixXd::Zero(6 * static_cast<Eigen::Index>(sites.size()), m->nv);
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const Mat3 axes = basis_with_z(Vec3(sites[i].normal));
    for (const double sign : {1.0, -1.0}) {
      const int geom = sign > 0.0 ? sites[i].geom_a : sites[i].geom_b;
      RowMajor way(3, m->nv), turn(3, m->nv);
      mj_jac(m.get(), d.get(), way.data(), turn.data(), sites[i].centroid, m->geom_bodyid[geom]);
      const MatrixXd w = sign * axes.transpose() * way, t = sign * axes.transpose() * turn;
      const Eigen::Index row = 6 * static_cast<Eigen::Index>(i);
      out.row(row) += w.row(2);
      out.middleRows(row + 1, 2) += t.topRows(2);
      out.middleRows(row + 3, 2) += w.topRows(2);
      out.row(row + 5) += t.row(2);
    }
  }
  return out;
}

MatrixXd mass_matrix(const ModelPointer& m, const DataPointer& d) {
  MatrixXd out(m->nv, m->nv);
  for (int i = 0; i < m->nv; ++i) {
    const VectorXd unit = VectorXd::Unit(m->nv, i);
    mj_mulM(m.get(), d.get(), out.col(i).data(), unit.data());
  }
  return out;
}

struct Scene {
  const char* integrator;
  double joint_damping;
  const char* friction;
  const char* target;
};

class DenseStep : public ::testing::TestWithParam<Scene> {};

// (Mh + h J' C J) dv = h (t + J' (e - C u)), with J, M and t had from MuJoCo without volcontact.
TEST_P(DenseStep, IsWhatMuJoCoDoes) {
  constexpr double kTolerance = 1e-10;
  const Scene& scene = GetParam();
  const std::string option = std::string("integrator=\"") + scene.integrator + "\"";
  const std::string text =
      bodies(option, scene.joint_damping,
             keys("on", scene.friction, "2e9") +
                 testing::numeric(std::string("volcontact/option/target/") + scene.target, "1"));
  const ModelPointer m = testing::load(text), plain = testing::compile(text);
  plain->opt.disableflags |= mjDSBL_CONTACT;
  const Attached attached(m);
  int most = 0, compared = 0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const DataPointer d = testing::make_data(m), free = testing::make_data(plain);
    scatter(m, d, seed);
    scatter(plain, free, seed);
    mj_forward(plain.get(), free.get());
    const int nv = static_cast<int>(m->nv);
    VectorXd known = VectorXd::Zero(nv);
    for (int body = 1; body < m->nbody; ++body) {
      mj_applyFT(plain.get(), free.get(), free->xfrc_applied + 6 * body,
                 free->xfrc_applied + 6 * body + 3, free->xipos + 3 * body, body, known.data());
    }
    MatrixXd left = mass_matrix(plain, free);
    const double h = m->opt.timestep;
    for (int i = 0; i < nv; ++i) {
      known[i] += free->qfrc_passive[i] - free->qfrc_bias[i] + free->qfrc_actuator[i] +
                  free->qfrc_applied[i];
      left(i, i) += h * plain->dof_damping[i];
    }
    const VectorXd before = Eigen::Map<VectorXd>(d->qvel, nv);
    mj_step(m.get(), d.get());
    const VectorXd change = Eigen::Map<VectorXd>(d->qvel, nv) - before;

    std::vector<volcontact_site> sites(100);
    sites.resize(static_cast<std::size_t>(volcontact_sites(m.get(), d.get(), sites.data(), 100)));
    most = std::max(most, static_cast<int>(sites.size()));
    const MatrixXd j = jacobian(plain, free, sites);
    const VectorXd u = j * before;
    const ImplicitStep& step = thread_scratch().implicit;
    VectorXd right = known;
    for (std::size_t i = 0; i < sites.size(); ++i) {
      const Eigen::Index row = 6 * static_cast<Eigen::Index>(i);
      const auto block = j.middleRows(row, 6);
      left += h * block.transpose() * step.slope(i) * block;
      right += block.transpose() * (step.constant(i) - step.slope(i) * u.segment(row, 6));
    }
    // What friction could not hold was cut off after the solution: not linear.
    const VectorXd after = j * Eigen::Map<VectorXd>(d->qvel, nv);
    bool cut = false;
    for (std::size_t i = 0; i < sites.size(); ++i) {
      const auto& f = step.force(i);
      const VectorXd linear =
          step.constant(i) - step.slope(i) * after.segment(6 * static_cast<Eigen::Index>(i), 6);
      cut = cut || (f - linear).tail(3).norm() > 1e-9 * f.norm();
    }
    if (cut) continue;
    ++compared;
    const VectorXd truth = left.ldlt().solve(h * right);
    EXPECT_LT((change - truth).norm(), kTolerance * truth.norm()) << seed;
  }
  EXPECT_GE(most, 3);
  EXPECT_GE(compared, 5);
}

INSTANTIATE_TEST_SUITE_P(Scenes, DenseStep,
                         ::testing::Values(Scene{"Euler", 0.0, "regularized_coulomb", "applied"},
                                           Scene{"Euler", 3.0, "regularized_coulomb", "passive"},
                                           Scene{"Euler", 3.0, "bristle", "xfrc"},
                                           Scene{"Euler", 0.0, "bristle", "applied"}),
                         [](const auto& run) {
                           return std::string(run.param.integrator) + run.param.friction +
                                  run.param.target;
                         });

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

TEST(ImplicitStep, FormsForForcesAndForVelocitiesAgree) {
  const ModelPointer m = testing::load(bodies("", 2.0, keys("on", "regularized_coulomb", "2e9")));
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
  islands.build(m.get(), places);
  ASSERT_EQ(islands.count(), 1);
  ContactSpace space;
  space.build(m.get(), d.get(), places, islands, 0, known.data());
  ContactEquations equations;
  test::Random random(3);
  for (int first = 0; first < 18; first += 3) {
    for (int i = 0; i < 3; ++i) {
      equations.constant.push_back(random.uniform(-50.0, 50.0));
      equations.columns.push_back({1e3 * random.in_box(1.0), first});
    }
  }
  std::vector<double> force, velocity, other_force, other_velocity;
  equations.solve_for_dofs(space, 2e-3, force, velocity);
  space.build_mobility();
  space.build_delassus();
  equations.solve_for_forces(space, 2e-3, other_force, other_velocity);
  const Eigen::Map<VectorXd> f(force.data(), 18), other(other_force.data(), 18);
  EXPECT_LT((f - other).norm(), 1e-9 * f.norm());
  std::vector<double> moved(18);
  space.move(force, moved);
  for (std::size_t i = 0; i < 18; ++i) {
    EXPECT_NEAR(velocity[i], other_velocity[i], 1e-10);
    EXPECT_NEAR(velocity[i], moved[i], 1e-8);
  }
}

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

TEST(ImplicitStep, AllocatesNothingWhenWarm) {
  for (const double damping : {0.0, 2.0}) {
    const ModelPointer m = testing::load(bodies("", damping, keys("auto", "bristle", "2e10")));
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
}  // namespace volcontact::adaptor
