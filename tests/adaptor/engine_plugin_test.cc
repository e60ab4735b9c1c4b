// SPDX-License-Identifier: Apache-2.0
#include "adaptor/engine_plugin.h"

#include <gtest/gtest.h>

#include "adaptor/support/models.h"

#if mjVERSION_HEADER >= 300

namespace volcontact::adaptor::engine_plugin_test {
namespace {

using testing::DataPointer;
using testing::ModelPointer;

constexpr const char* kExtension =
    "<extension><plugin plugin=\"volcontact\"><instance name=\"contact\"/></plugin></extension>";

class EnginePlugin : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { register_engine_plugin(); }

  const std::string bristle_ = testing::material(
      "m", {{"stiffness", "2e8"}, {"friction_law/bristle", "1"}}, {"floor", "ball"});
};

ModelPointer with_plugin(const std::string& custom) {
  return testing::compile(testing::ball_scene(0.0499, custom + kExtension));
}

// Rolls and spins, so that friction with a memory has something to keep.
void push(const DataPointer& d) {
  d->qvel[0] = 0.3;
  d->qvel[5] = 2.0;
}

std::vector<double> state_of(const ModelPointer& m, const DataPointer& d) {
  std::vector<double> state(d->qpos, d->qpos + m->nq);
  state.insert(state.end(), d->qvel, d->qvel + m->nv);
  state.insert(state.end(), d->plugin_state, d->plugin_state + m->npluginstate);
  return state;
}

void run(const ModelPointer& m, const DataPointer& d, int steps) {
  for (int i = 0; i < steps; ++i) mj_step(m.get(), d.get());
}

TEST_F(EnginePlugin, SceneWithItHasVolumetricContactUnasked) {
  const ModelPointer m = with_plugin(bristle_);
  const DataPointer d = testing::make_data(m);
  EXPECT_EQ(m->nuserdata, 0);
  push(d);
  run(m, d, 2000);
  EXPECT_EQ(d->ncon, 0);
  // As the same scene, attached, with its forces in the same array.
  const ModelPointer attached = testing::load(testing::ball_scene(
      0.0499, bristle_ + testing::numeric("volcontact/option/target/passive", "1")));
  const testing::Attached contact(attached);
  const DataPointer other = testing::make_data(attached);
  push(other);
  run(attached, other, 2000);
  for (int i = 0; i < m->nq; ++i) EXPECT_EQ(d->qpos[i], other->qpos[i]);
  EXPECT_NE(d->qpos[0], 0.0);
}

TEST_F(EnginePlugin, CallbackDoesNotDoubleItsForces) {
  const ModelPointer m = with_plugin("");
  const DataPointer d = testing::make_data(m);
  mj_forward(m.get(), d.get());
  const double force = d->qfrc_passive[2];
  EXPECT_GT(force, 0.0);
  {
    const testing::Attached attached(m);  // takes over what the plugin attached by itself
    mj_forward(m.get(), d.get());
    EXPECT_EQ(d->qfrc_passive[2], force);
  }
  mj_forward(m.get(), d.get());  // and gives it back
  EXPECT_EQ(d->qfrc_passive[2], force);
}

TEST_F(EnginePlugin, CopiesResetsAndFullPhysicsStatesAreExact) {
  const ModelPointer m = with_plugin(bristle_);
  const DataPointer d = testing::make_data(m);
  push(d);
  run(m, d, 100);
  const DataPointer copy(mj_copyData(nullptr, m.get(), d.get()));
  const DataPointer from_state = testing::make_data(m);
  std::vector<mjtNum> state(static_cast<std::size_t>(mj_stateSize(m.get(), mjSTATE_FULLPHYSICS)));
  mj_getState(m.get(), d.get(), state.data(), mjSTATE_FULLPHYSICS);
  run(m, from_state, 7);  // somewhere else
  mj_setState(m.get(), from_state.get(), state.data(), mjSTATE_FULLPHYSICS);
  for (const DataPointer* data : {&d, &copy, &from_state}) run(m, *data, 100);
  EXPECT_EQ(state_of(m, copy), state_of(m, d));
  EXPECT_EQ(state_of(m, from_state), state_of(m, d));
  mj_resetData(m.get(), copy.get());
  push(copy);
  run(m, copy, 200);
  EXPECT_EQ(state_of(m, copy), state_of(m, d));
}

TEST_F(EnginePlugin, SceneThatCannotBeUsedDoesNotCompile) {
  const std::string wrong = testing::numeric("volcontact/option/tolerence", "1e-3");
  try {
    with_plugin(wrong);
    FAIL() << "it compiled";
  } catch (const std::runtime_error& error) {
    EXPECT_TRUE(testing::contains(error.what(), "did you mean 'volcontact/option/tolerance'?"));
  }
}

TEST_F(EnginePlugin, DrawsPatchesAndForcesWhereTheProgramWantsThem) {
  const ModelPointer m = with_plugin("");
  const DataPointer d = testing::make_data(m);
  run(m, d, 100);
  mj_forward(m.get(), d.get());
  mjvOption option;
  mjv_defaultOption(&option);
  mjvScene scene;
  mjv_defaultScene(&scene);
  mjv_makeScene(m.get(), &scene, 100);
  mjvCamera camera;
  mjv_defaultCamera(&camera);
  const auto drawn = [&](int type, bool points, bool forces) {
    option.flags[mjVIS_CONTACTPOINT] = points;
    option.flags[mjVIS_CONTACTFORCE] = forces;
    mjv_updateScene(m.get(), d.get(), &option, nullptr, &camera, mjCAT_ALL, &scene);
    std::vector<mjvGeom> found;
    for (int i = 0; i < scene.ngeom; ++i) {
      if (scene.geoms[i].type == type) found.push_back(scene.geoms[i]);
    }
    return found;
  };
  EXPECT_EQ(drawn(mjGEOM_CYLINDER, false, true).size(), 0U);
  EXPECT_EQ(drawn(mjGEOM_ARROW, true, false).size(), 0U);
  const auto patches = drawn(mjGEOM_CYLINDER, true, true);
  ASSERT_EQ(patches.size(), 1U);
  const double depth = 0.05 - d->qpos[2];
  EXPECT_NEAR(patches[0].size[0], std::sqrt(2.0 * 0.05 * depth - depth * depth), 2e-5);
  const auto forces = drawn(mjGEOM_ARROW, true, true);
  ASSERT_EQ(forces.size(), 1U);
  // MuJoCo's arrows are scaled by the mean mass of the bodies; this one points up, on the ball.
  EXPECT_NEAR(forces[0].size[2] * m->stat.meanmass / m->vis.map.force, d->qfrc_passive[2], 1e-3);
  EXPECT_NEAR(forces[0].mat[8], 1.0, 1e-6);
  mjv_freeScene(&scene);
}

}  // namespace
}  // namespace volcontact::adaptor::engine_plugin_test

#endif
