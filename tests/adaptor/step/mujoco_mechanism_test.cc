// SPDX-License-Identifier: Apache-2.0
#include "adaptor/step/mujoco_mechanism.h"

#include <gtest/gtest.h>

#include <vector>

#include "adaptor/support/models.h"
#include "core/support/random.h"

namespace volcontact::adaptor::mujoco_mechanism_test {
namespace {

using Mat14 = Matrix<14, 14>;
using testing::DataPointer;
using testing::ModelPointer;

// A body that flies alone, one that carries a limb with a welded hand, and a fixed one that carries
// a slide.
const char* const kBodies = R"(
  <worldbody>
    <body pos="0 0 1"><freejoint/><geom size=".1" pos=".02 0 0"/></body>
    <body pos="1 0 1"><freejoint/><geom size=".1"/>
      <body pos=".2 0 0"><joint name="elbow" axis="0 1 0" damping=".3"/><geom size=".05" pos=".1 0 0"/>
        <body pos=".3 0 0"><geom size=".04"/></body></body></body>
    <body pos="2 0 1"><geom size=".1"/>
      <body><joint type="slide" axis="1 0 1"/><geom size=".1"/></body></body>
  </worldbody>)";

DataPointer moving(const ModelPointer& m) {
  DataPointer d = testing::make_data(m);
  test::Random random(2);
  for (int i = 0; i < m->nv; ++i) d->qvel[i] = random.uniform(-2.0, 2.0);
  mj_forward(m.get(), d.get());
  return d;
}

TEST(MujocoMechanism, KnowsWhatCarriesWhat) {
  const ModelPointer m = testing::compile(std::string("<mujoco>") + kBodies + "</mujoco>");
  const MechanismTrees trees = trees_of(m.get());
  ASSERT_EQ(trees.dofs(), 14);
  ASSERT_EQ(trees.trees.size(), 3u);
  EXPECT_EQ(trees.trees[1].begin, 6);
  EXPECT_EQ(trees.trees[1].size(), 7);
  EXPECT_EQ(trees.tree_of_body, (std::vector<int>{-1, 0, 1, 1, 1, -1, 2}));
  EXPECT_EQ(trees.last_dof, (std::vector<int>{-1, 5, 11, 12, 12, -1, 13}));
  EXPECT_EQ(trees.root, (std::vector<int>{1, 2, 5}));
  EXPECT_EQ(trees.carrier[12], 11);
  EXPECT_EQ(trees.carrier[13], MechanismTrees::kNone);
}

TEST(MujocoMechanism, MotionsAndMassesAreThoseOfMuJoCo) {
  const ModelPointer m = testing::compile(std::string("<mujoco>") + kBodies + "</mujoco>");
  const DataPointer d = moving(m);
  const MechanismTrees trees = trees_of(m.get());
  const StepMetric none;
  const MujocoMechanism mechanism(m.get(), d.get(), trees, none);
  EXPECT_EQ(mechanism.step, m->opt.timestep);
  EXPECT_NEAR(mechanism.fall, 9.81 * m->opt.timestep, 1e-15);
  const int hand = 4;
  const Vec3 point(0.4, 0.1, 1.2), offset = point - mechanism.origin(1);
  std::vector<double> numbers(static_cast<std::size_t>(3 * m->nv));
  mj_jac(m.get(), d.get(), numbers.data(), nullptr, point.data(), hand);
  for (int dof = trees.last_dof[hand]; dof >= 0; dof = trees.carrier[size(dof)]) {
    const Vec3 way = Mechanism::linear(mechanism.motions, dof) +
                     Mechanism::angular(mechanism.motions, dof).cross(offset);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(way[i], numbers[size(i * 14 + dof)], 1e-14);
  }

  std::vector<int> dofs(14);
  for (int i = 0; i < 14; ++i) dofs[size(i)] = i;
  Mat14 lower = Mat14::Zero();
  for (const int dof : dofs) {
    double row[14] = {};
    mechanism.mass(dof, row);
    const double* number = row;
    for (int k = dof; k >= 0; k = trees.carrier[size(k)]) lower(dof, k) = *number++;
  }
  for (int i = 0; i < 14; ++i) {
    const auto unit = Vector<14>::Unit(i);
    Vector<14> column;
    mj_mulM(m.get(), d.get(), column.data(), unit.data());
    for (int k = i; k < 14; ++k) EXPECT_NEAR(lower(k, i), column[k], 1e-14);
  }
  std::vector<DofEntry> entries;
  mechanism.damping(dofs, entries);  // Euler damps joints implicitly
  double sum = 0.0;
  for (const DofEntry& entry : entries) sum += entry.value;
  EXPECT_NEAR(sum, 0.3 * m->opt.timestep, 1e-16);
}

// Against the change of the velocity of a point fixed to a spinning limb.
TEST(MujocoMechanism, TurningAccelerationIsThatOfThePoint) {
  const ModelPointer m =
      testing::compile(std::string("<mujoco><option gravity=\"0 0 0\"/>") + kBodies + "</mujoco>");
  const DataPointer d = moving(m);
  const MechanismTrees trees = trees_of(m.get());
  const int limb = 3;
  const Vec3 local(0.1, 0.05, -0.02);
  const auto velocity = [&](double time) -> Vec3 {
    const DataPointer at = testing::make_data(m);
    std::copy_n(d->qpos, m->nq, at->qpos);
    std::copy_n(d->qvel, m->nv, at->qvel);
    mj_integratePos(m.get(), at->qpos, at->qvel, time);
    mj_forward(m.get(), at.get());
    double point[3];
    mju_mulMatVec(point, at->xmat + 9 * limb, local.data(), 3, 3);
    mju_addTo3(point, at->xpos + 3 * limb);
    double jacobian[3 * 14], out[3];
    mj_jac(m.get(), at.get(), jacobian, nullptr, point, limb);
    mju_mulMatVec(out, jacobian, at->qvel, 3, 14);
    return Vec3(out[0], out[1], out[2]);
  };
  double point[3];
  mju_mulMatVec(point, d->xmat + 9 * limb, local.data(), 3, 3);
  mju_addTo3(point, d->xpos + 3 * limb);
  const StepMetric none;
  const MujocoMechanism mechanism(m.get(), d.get(), trees, none);
  const Vec3 found = turning_acceleration(mechanism, limb, Vec3(point[0], point[1], point[2]));
  constexpr double kTime = 1e-5;
  const Vec3 expected = (velocity(kTime) - velocity(-kTime)) / (2.0 * kTime);
  EXPECT_LT((found - expected).norm(), 1e-7 * expected.norm());
}

// All that MuJoCo calls smooth, from actuators and springs to a tendon that has inertia.
TEST(MujocoMechanism, KnownForcesAreAllSmoothOnes) {
  const std::string armature = mjVERSION_HEADER >= 340 ? "armature=\".4\"" : "";
  const ModelPointer m = testing::compile(
      R"(<mujoco><worldbody>
    <site name="high" pos="0 0 2"/>
    <body pos="0 0 1"><joint name="shoulder" axis="0 1 0" stiffness="3" damping=".2"/>
      <geom type="capsule" fromto="0 0 0 .4 0 0" size=".04"/>
      <body pos=".4 0 0"><joint axis="0 1 0"/><geom type="capsule" fromto="0 0 0 .3 0 0" size=".03"/>
        <site name="tip" pos=".3 0 0"/></body></body></worldbody>
    <tendon><spatial name="rope" )" +
      armature + R"( stiffness="5"><site site="high"/><site site="tip"/></spatial></tendon>
    <actuator><motor joint="shoulder"/></actuator></mujoco>)");
  const DataPointer d = moving(m);
  d->ctrl[0] = 0.7;
  d->qfrc_applied[1] = -0.3;
  d->xfrc_applied[12] = 2.0;
  mj_forward(m.get(), d.get());
  std::vector<double> known;
  known_forces(m.get(), d.get(), d->qfrc_applied, d->xfrc_applied, known);
  for (int i = 0; i < m->nv; ++i) EXPECT_NEAR(known[size(i)], d->qfrc_smooth[i], 1e-13) << i;
}

}  // namespace
}  // namespace volcontact::adaptor::mujoco_mechanism_test
