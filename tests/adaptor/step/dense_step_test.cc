// SPDX-License-Identifier: Apache-2.0
// What MuJoCo makes of the forces of an implicit step, against the same step solved as a whole.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "adaptor/passive_callback.h"
#include "adaptor/support/models.h"
#include "adaptor/support/servo_scene.h"
#include "core/support/dense.h"
#include "volcontact/step/implicit_step.h"

namespace volcontact::adaptor::dense_step_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::Attached;
using testing::bodies;
using testing::DataPointer;
using testing::keys;
using testing::ModelPointer;
using testing::scatter;
using volcontact::test::product;
using volcontact::test::solution;

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
      const MatrixXd to_site = test::eigen(sign * axes.transpose());
      const MatrixXd w = product(to_site, way), t = product(to_site, turn);
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

bool is_discrete([[maybe_unused]] const ModelPointer& m) {
#if mjVERSION_HEADER >= 3013000
  return m->opt.integrator == mjINT_DISCRETE;
#else
  return false;
#endif
}

// Bodies that fly alone, whose bias is taken implicitly: under `discrete` only where no constraint
// acts on them.
bool flies(const ModelPointer& m, const DataPointer& d, int dof) {
  const int first = dof < 6 ? 0 : 6;
  if (mjVERSION_HEADER < 3011000 || dof >= 12) return false;
  if (!is_discrete(m)) return true;
  for (int i = 0; i < d->nefc; ++i) {
    for (int k = first; k < first + 6; ++k) {
      if (d->efc_J[i * m->nv + k] != 0.0) return false;
    }
  }
  return true;
}

// Of passive forces and actuators, less the bias if wished: minus the derivative by the velocities,
// or by the positions of the joints, from central differences, which are exact: the forces are at
// most quadratic in velocities, and linear in the joints' positions.
enum class By { kVelocities, kPositions };
MatrixXd slope(const ModelPointer& m, const DataPointer& d, By by, auto with_bias) {
  const int nv = static_cast<int>(m->nv);
  MatrixXd out = MatrixXd::Zero(nv, nv);
  const auto forces = [&](double& at, double more, bool biased) {
    const double before = std::exchange(at, at + more);
    mj_fwdPosition(m.get(), d.get());
    mj_fwdVelocity(m.get(), d.get());
    mj_fwdActuation(m.get(), d.get());
    VectorXd sum(nv);
    for (int i = 0; i < nv; ++i) {
      sum[i] = d->qfrc_passive[i] + d->qfrc_actuator[i] - (biased ? d->qfrc_bias[i] : 0.0);
    }
    at = before;
    return sum;
  };
  for (int k = by == By::kVelocities ? 0 : 12; k < nv; ++k) {
    double& at = by == By::kVelocities ? d->qvel[k] : d->qpos[k + 2];
    out.col(k) = -0.5 * (forces(at, 1.0, with_bias(k)) - forces(at, -1.0, with_bias(k)));
  }
  mj_forward(m.get(), d.get());
  return out;
}

// h B of M + h B, which the integrator divides by; `end`: after the step.
MatrixXd implicit_damping(const ModelPointer& m, const DataPointer& d, const DataPointer& end) {
  const int nv = static_cast<int>(m->nv);
  const double h = m->opt.timestep;
  MatrixXd out = MatrixXd::Zero(nv, nv);
  if (m->opt.integrator == mjINT_EULER) {
    for (int i = 0; i < nv; ++i) out(i, i) = h * m->dof_damping[i];
    return out;
  }
  return h * slope(m, d, By::kVelocities,
                   [&](int k) { return m->opt.integrator == mjINT_IMPLICIT || flies(m, end, k); });
}

struct Scene {
  const char* name;
  const char* option;
  double joint_damping;
  const char* friction;
  const char* target;
  std::string joints = "";
  std::string more = "";
};

class DenseStep : public ::testing::TestWithParam<Scene> {};

// (M + h B + h J' C J) dv = h (t + J' (e - C u) + Jc' f), with J, M, B and t had from MuJoCo
// without volcontact, and the forces f of its constraints from what its solver found. `discrete`
// has h B + h^2 K of springs and servos, too, and t - h K v.
TEST_P(DenseStep, IsWhatMuJoCoDoes) {
  constexpr double kTolerance = 1e-10;
  const Scene& scene = GetParam();
  const std::string text =
      bodies(std::string("tolerance=\"0\" iterations=\"300\" ") + scene.option, scene.joint_damping,
             keys("on", scene.friction, "2e9") + scene.more +
                 testing::numeric(std::string("volcontact/option/target/") + scene.target, "1"),
             scene.joints);
  const ModelPointer m = testing::load(text), plain = testing::compile(text);
  plain->opt.disableflags |= mjDSBL_CONTACT;
  const Attached attached(m);
  int most = 0, compared = 0, constrained = 0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const DataPointer d = testing::make_data(m), free = testing::make_data(plain);
    scatter(m, d, seed);
    scatter(plain, free, seed);
    mj_forward(plain.get(), free.get());
    const int nv = static_cast<int>(m->nv);
    const double h = m->opt.timestep;
    VectorXd right = VectorXd::Zero(nv);
    for (int body = 1; body < m->nbody; ++body) {
      mj_applyFT(plain.get(), free.get(), free->xfrc_applied + 6 * body,
                 free->xfrc_applied + 6 * body + 3, free->xipos + 3 * body, body, right.data());
    }
    const VectorXd before = Eigen::Map<VectorXd>(d->qvel, nv);
    mj_step(m.get(), d.get());
    const VectorXd change = Eigen::Map<VectorXd>(d->qvel, nv) - before;
    for (int i = 0; i < nv; ++i) {
      right[i] += free->qfrc_passive[i] - free->qfrc_bias[i] + free->qfrc_actuator[i] +
                  free->qfrc_applied[i] + d->qfrc_constraint[i];
    }
    MatrixXd left = mass_matrix(plain, free) + implicit_damping(plain, free, d);
    if (is_discrete(m)) {
      const MatrixXd springs = slope(plain, free, By::kPositions, [](int) { return false; });
      left += h * h * springs;
      right -= h * product(springs, before);
    }
    if (std::any_of(d->efc_force, d->efc_force + d->nefc, [](double f) { return f != 0.0; })) {
      ++constrained;
    }

    std::vector<volcontact_site> sites(100);
    sites.resize(static_cast<std::size_t>(volcontact_sites(m.get(), d.get(), sites.data(), 100)));
    most = std::max(most, static_cast<int>(sites.size()));
    const MatrixXd j = jacobian(plain, free, sites);
    const VectorXd u = product(j, before);
    const ImplicitStep& step = thread_scratch().implicit;
    for (std::size_t i = 0; i < sites.size(); ++i) {
      const Eigen::Index row = 6 * static_cast<Eigen::Index>(i);
      const MatrixXd block = j.middleRows(row, 6), slope = test::eigen(step.slope(i));
      const VectorXd borne = test::eigen(step.constant(i)) - product(slope, u.segment(row, 6));
      left += h * product(block.transpose(), product(slope, block));
      right += product(block.transpose(), borne);
    }
    // What friction could not hold was cut off after the solution: not linear.
    const VectorXd after = product(j, Eigen::Map<VectorXd>(d->qvel, nv));
    bool cut = false;
    for (std::size_t i = 0; i < sites.size(); ++i) {
      const VectorXd f = test::eigen(step.force(i));
      const Eigen::Index row = 6 * static_cast<Eigen::Index>(i);
      const VectorXd linear = test::eigen(step.constant(i)) -
                              product(test::eigen(step.slope(i)), after.segment(row, 6));
      cut = cut || (f - linear).tail(3).norm() > 1e-9 * f.norm();
    }
    if (cut) continue;
    ++compared;
    const VectorXd truth = solution(left, h * right);
    EXPECT_LT((change - truth).norm(), kTolerance * truth.norm()) << seed;
  }
  const bool is_native = scene.more.find("pairs/listed") != std::string::npos;
  EXPECT_GE(most, is_native ? 2 : 3);
  const bool is_limited = scene.joints.find("limited") != std::string::npos;
  EXPECT_GE(constrained, is_limited || is_native ? 5 : 0);
  EXPECT_GE(compared, 5);
}

const std::string kLimits = "limited=\"true\" range=\".001 2\" frictionloss=\".4\"";
const std::string kJoined =
    "<tendon><fixed name=\"rope\" limited=\"true\" range=\".001 2\" damping=\"1\">"
    "<joint joint=\"lift\" coef=\"1\"/><joint joint=\"elbow\" coef=\"-.5\"/></fixed></tendon>"
    "<equality><connect body1=\"low\" body2=\"high\" anchor=\".1 0 .1\"/></equality>";
const std::string kServos =
    "<tendon><fixed name=\"wire\"><joint joint=\"lift\" coef=\"1\"/>"
    "<joint joint=\"elbow\" coef=\"-.5\"/></fixed></tendon><actuator>"
    "<velocity joint=\"elbow\" kv=\"6\"/><velocity tendon=\"wire\" kv=\"20\"/></actuator>";
// The hand touches the upper box as in MuJoCo.
const std::string kNative =
    testing::numeric("volcontact/option/pairs/listed", "1") +
    "<custom><tuple name=\"volcontact/pair/a\"><element objtype=\"geom\" objname=\"floor\"/>"
    "<element objtype=\"geom\" objname=\"low\"/></tuple><tuple name=\"volcontact/pair/b\">"
    "<element objtype=\"geom\" objname=\"low\"/><element objtype=\"geom\" objname=\"high\"/>"
    "</tuple></custom>";
const std::string kFast =
    mjVERSION_HEADER < 233 ? "integrator=\"implicit\"" : "integrator=\"implicitfast\"";

const std::string kSprings = "stiffness=\"4000\"";
const std::string kSpringServos =
    "<tendon><fixed name=\"wire\" stiffness=\"9000\" springlength=\".3\" "
    "damping=\"30\"><joint joint=\"lift\" "
    "coef=\"1\"/><joint joint=\"elbow\" coef=\"-.5\"/></fixed></tendon><actuator>"
    "<position joint=\"elbow\" kp=\"3000\" kv=\"20\"/><position tendon=\"wire\" kp=\"5000\"/>"
    "</actuator>";
const std::string kDiscrete = "integrator=\"discrete\"";

INSTANTIATE_TEST_SUITE_P(
    Scenes, DenseStep,
    ::testing::Values(
        Scene{"Plain", "", 0.0, "regularized_coulomb", "applied"},
        Scene{"Damped", "", 3.0, "regularized_coulomb", "passive"},
        Scene{"DampedBristles", "", 3.0, "bristle", "xfrc"},
        Scene{"Bristles", "", 0.0, "bristle", "applied"},
        Scene{"Servos", "integrator=\"implicit\"", 3.0, "bristle", "applied", "", kServos},
        Scene{"ServosFast", kFast.c_str(), 3.0, "bristle", "applied", "", kServos},
        Scene{"Limits", "", 0.0, "bristle", "applied", kLimits, kJoined},
        Scene{"DampedLimits", "", 3.0, "bristle", "applied", kLimits, kJoined},
        Scene{"SparseLimits", "jacobian=\"sparse\"", 3.0, "bristle", "applied", kLimits, kJoined},
        Scene{"LimitsServos", "integrator=\"implicit\"", 3.0, "bristle", "applied", kLimits,
              kJoined + kServos},
        Scene{"LimitsServosFast", kFast.c_str(), 3.0, "bristle", "applied", kLimits,
              kJoined + kServos},
        Scene{"Native", "", 0.0, "bristle", "applied", "", kNative},
        Scene{"NativeDamped", "", 3.0, "bristle", "applied", kLimits, kNative + kJoined},
        Scene{"NativeElliptic", "cone=\"elliptic\"", 3.0, "bristle", "applied", "", kNative}),
    [](const auto& run) { return std::string(run.param.name); });

#if mjVERSION_HEADER >= 3013000
INSTANTIATE_TEST_SUITE_P(
    Discrete, DenseStep,
    ::testing::Values(Scene{"Plain", kDiscrete.c_str(), 0.0, "bristle", "applied"},
                      Scene{"Damped", kDiscrete.c_str(), 3.0, "regularized_coulomb", "passive"},
                      Scene{"Springs", kDiscrete.c_str(), 0.0, "bristle", "applied", kSprings},
                      Scene{"Servos", kDiscrete.c_str(), 3.0, "bristle", "xfrc", "", kSpringServos},
                      Scene{"SpringsServos", kDiscrete.c_str(), 3.0, "bristle", "applied", kSprings,
                            kSpringServos},
                      Scene{"LimitsServos", kDiscrete.c_str(), 3.0, "bristle", "applied",
                            kLimits + " " + kSprings, kJoined + kSpringServos}),
    [](const auto& run) { return std::string(run.param.name); });
#endif

}  // namespace
}  // namespace volcontact::adaptor::dense_step_test
