// SPDX-License-Identifier: Apache-2.0
#include "adaptor/evaluation/body_forces.h"

#include <gtest/gtest.h>

#include <limits>

#include "adaptor/support/models.h"

namespace volcontact::adaptor::body_forces_test {
namespace {

// Two trees, one a branched chain with every joint type, and a static body.
constexpr const char* kTrees = R"(
<mujoco>
  <worldbody>
    <body name="table" pos="3 0 0"><geom type="box" size=".1 .1 .1"/></body>
    <body pos="0 0 1"><freejoint/><geom type="box" size=".1 .2 .1"/>
      <body pos=".3 0 0"><joint type="hinge" axis="0 1 .3"/><geom type="capsule" size=".05 .2"/>
        <body pos=".3 .1 0"><joint type="slide" axis="1 0 0"/><joint type="ball"/>
          <geom type="sphere" size=".1" pos=".2 .1 -.3"/></body></body>
      <body pos="-.3 0 0"><joint type="hinge" axis="1 1 0"/><geom type="capsule" size=".05 .2"/>
      </body></body>
    <body pos="9 0 1"><joint type="hinge" axis="0 1 0" pos="0 0 .4"/>
      <geom type="box" size=".1 .2 .1"/></body>
  </worldbody>
</mujoco>)";

struct Load {
  int body;
  Vec3 point, force, torque;
};

std::vector<Load> loads(const mjModel* m) {
  std::vector<Load> out;
  for (int i = 0; i < 12; ++i) {
    const double x = i;
    out.push_back({i % static_cast<int>(m->nbody),
                   {std::sin(x), std::cos(2 * x), std::sin(5 * x)},
                   {10 * std::cos(x), std::sin(3 * x), 7 * std::cos(7 * x)},
                   {std::cos(11 * x), std::sin(13 * x), std::cos(17 * x)}});
  }
  return out;
}

class BodyForcesTest : public ::testing::Test {
 protected:
  BodyForcesTest() : m(testing::compile(kTrees)), d(testing::make_data(m)) {
    for (int i = 0; i < m->nq; ++i) d->qpos[i] += 0.3 * std::sin(1.0 + i);
    mj_forward(m.get(), d.get());
    forces.reset(m.get());
    for (const Load& l : loads(m.get())) {
      forces.add(m.get(), d.get(), l.body, l.point, l.force, l.torque);
    }
  }

  testing::ModelPointer m;
  testing::DataPointer d;
  BodyForces forces;
};

TEST_F(BodyForcesTest, GeneralizedForceIsThatOfApplyFT) {
  std::vector<double> expected(static_cast<std::size_t>(m->nv), 0.0);
  for (const Load& l : loads(m.get())) {
    mj_applyFT(m.get(), d.get(), l.force.data(), l.torque.data(), l.point.data(), l.body,
               expected.data());
  }
  const std::vector<double>& numbers = forces.generalized(m.get(), d.get());
  ASSERT_EQ(numbers.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(numbers[i], expected[i], 1e-12);
}

TEST_F(BodyForcesTest, CartesianForceHasTheSameGeneralizedForce) {
  const std::vector<double> cartesian = forces.cartesian(m.get(), d.get());
  std::vector<double> through(static_cast<std::size_t>(m->nv), 0.0);
  for (int body = 1; body < m->nbody; ++body) {
    const double* load = &cartesian[6 * static_cast<std::size_t>(body)];
    mj_applyFT(m.get(), d.get(), load, load + 3, d->xipos + 3 * body, body, through.data());
  }
  const std::vector<double>& direct = forces.generalized(m.get(), d.get());
  for (std::size_t i = 0; i < direct.size(); ++i) EXPECT_NEAR(direct[i], through[i], 1e-12);
}

TEST_F(BodyForcesTest, ForceOnTheWorldIsNotKept) {
  forces.reset(m.get());
  forces.add(m.get(), d.get(), 0, Vec3::Zero(), Vec3::Ones(), Vec3::Ones());
  forces.add(m.get(), d.get(), mj_name2id(m.get(), mjOBJ_BODY, "table"), Vec3::Zero(), Vec3::Ones(),
             Vec3::Ones());
  EXPECT_TRUE(forces.empty());
}

TEST(DropNonFinite, ZeroesAndReports) {
  const double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> numbers{1.0, std::nan(""), -infinity, 2.0};
  EXPECT_TRUE(drop_non_finite(numbers));
  EXPECT_EQ(numbers, (std::vector<double>{1.0, 0.0, 0.0, 2.0}));
  EXPECT_FALSE(drop_non_finite(numbers));
}

}  // namespace
}  // namespace volcontact::adaptor::body_forces_test
