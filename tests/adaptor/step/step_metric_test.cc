// SPDX-License-Identifier: Apache-2.0
#include "adaptor/step/step_metric.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include "adaptor/step/look_ahead.h"
#include "adaptor/support/models.h"
#include "core/support/random.h"
#include "volcontact/base/sizes.h"

namespace volcontact::adaptor::step_metric_test {
namespace {

using Eigen::VectorXd;
using testing::DataPointer;
using testing::ModelPointer;

// Two arms with springs and servos, joined by tendons, and a body on a ball joint in a fluid.
ModelPointer scene(const std::string& option) {
  return testing::compile("<mujoco><option " + option + R"(/><worldbody>
    <body pos="0 0 1"><joint name="a" axis="0 1 0" stiffness="500" damping=".3"/>
      <geom type="box" size=".1 .05 .05" pos=".1 0 0" mass="1"/>
      <body pos=".2 0 0"><joint name="b" type="slide" axis="1 0 0" damping=".2"/>
        <geom type="box" size=".1 .05 .05" pos=".1 0 0" mass=".5"/></body>
      <body pos=".2 .2 0"><joint name="c" axis="0 0 1"/>
        <geom type="box" size=".1 .05 .05" pos=".1 0 0" mass=".5"/></body></body>
    <body pos="0 1 1"><joint name="d" axis="1 0 0"/><geom size=".1" pos="0 .2 0" mass="2"/></body>
    <body pos="0 2 1"><joint type="ball" stiffness="30"/>
      <geom type="box" size=".1 .05 .05" pos=".1 0 0" mass="1"/></body></worldbody>
    <tendon>
      <fixed name="limbs" stiffness="200" damping="3" springlength=".1"><joint joint="b" coef="1"/>
        <joint joint="c" coef=".5"/></fixed>
      <fixed name="arms" stiffness="900" springlength="-.2"><joint joint="a" coef="1"/>
        <joint joint="d" coef="-2"/></fixed></tendon>
    <actuator><position joint="a" kp="300"/><position joint="b" kp="70"/>
      <velocity joint="a" kv="2"/><velocity joint="c" kv="3"/><motor joint="b"/><position tendon="arms" kp="30"/></actuator>
    </mujoco>)");
}

#if mjVERSION_HEADER >= 3013000

// (M + N) a = t - s, with the a that MuJoCo finds where no constraint acts.
TEST(StepMetric, IsThatOfMuJoCosAcceleration) {
  for (const std::string fluid : {"", "density=\"1000\" viscosity=\".9\""}) {
    const ModelPointer m = scene("timestep=\".005\" integrator=\"discrete\" " + fluid);
    const DataPointer d = testing::make_data(m);
    volcontact::test::Random random(7);
    const int nv = static_cast<int>(m->nv);
    for (int i = 0; i < nv; ++i) d->qvel[i] = random.uniform(-1.0, 1.0);
    for (int i = 0; i < 4; ++i) d->qpos[i] = random.uniform(-0.3, 0.3);
    for (int i = 0; i < m->nu; ++i) d->ctrl[i] = random.uniform(-1.0, 1.0);
    mj_forward(m.get(), d.get());
    ASSERT_EQ(d->nefc, 0);

    StepMetric metric;
    metric.read(m.get(), look_ahead(m.get(), d.get()));
    ASSERT_TRUE(metric.is_known());
    EXPECT_EQ(metric.rows().size(), 3u);
    EXPECT_EQ(metric.fluid() != nullptr, !fluid.empty());
    const Eigen::Map<const VectorXd> a(d->qacc, nv);
    VectorXd left(nv), right = Eigen::Map<const VectorXd>(d->qfrc_smooth, nv);
    mj_mulM(m.get(), d.get(), left.data(), a.data());
    for (int i = 0; i < nv; ++i) left[i] += metric.diagonal(i) * a[i];
    for (const StepMetric::Row& row : metric.rows()) {
      double along = 0.0;
      for (const auto& [dof, value] : metric.entries(row)) along += value * a[dof];
      for (const auto& [dof, value] : metric.entries(row)) left[dof] += row.scale * along * value;
    }
    for (int i = 0; metric.fluid() && i < nv; ++i) {
      for_entry_of_mass(m.get(), i, [&](int k, int address) {
        left[i] += metric.fluid()[address] * a[k];
        if (k != i) left[k] += metric.fluid()[address] * a[i];
      });
    }
    metric.shift({right.data(), size(nv)});
    EXPECT_LT((left - right).norm(), 1e-12 * right.norm()) << fluid;
  }
}

#endif

TEST(StepMetric, OtherIntegratorsHaveNone) {
  const ModelPointer m = scene("integrator=\"Euler\"");
  const DataPointer d = testing::make_data(m);
  mj_forward(m.get(), d.get());
  EXPECT_EQ(look_ahead(m.get(), d.get()), nullptr);
  StepMetric metric;
  metric.read(m.get(), nullptr);
  EXPECT_FALSE(metric.is_known());
  EXPECT_TRUE(metric.rows().empty());
  double force = 3.0;
  metric.shift({&force, 1});
  EXPECT_EQ(force, 3.0);
}

}  // namespace
}  // namespace volcontact::adaptor::step_metric_test
