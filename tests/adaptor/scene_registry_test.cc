// SPDX-License-Identifier: Apache-2.0
#include "adaptor/scene_registry.h"

#include <gtest/gtest.h>

#include "adaptor/support/models.h"

namespace volcontact::adaptor::scene_registry_test {
namespace {

using testing::Attached;
using testing::DataPointer;
using testing::ModelPointer;

// Ball on floor, both of one material: half its stiffness acts.
std::string scene(const std::string& stiffness) {
  return testing::ball_scene(
      0.049,
      testing::material("m", {{"stiffness", stiffness}, {"damping", "0"}}, {"floor", "ball"}));
}

double ball_force(const ModelPointer& m, const DataPointer& d) {
  mj_forward(m.get(), d.get());
  return d->qfrc_applied[2];
}

// Another scene, of other sizes.
constexpr const char* kOther = R"(
<mujoco><worldbody><geom type="plane" size="1 1 1"/><body pos="0 0 .04"><freejoint/>
  <geom type="sphere" size=".05"/></body></worldbody></mujoco>)";

TEST(SceneRegistry, CopyOfAnAttachedModelHasContact) {
  const ModelPointer m = testing::load(scene("2e8"));
  const Attached attached(m);
  const ModelPointer copy(mj_copyModel(nullptr, m.get()));
  const DataPointer d = testing::make_data(m), of_copy = testing::make_data(copy);
  EXPECT_EQ(ball_force(copy, of_copy), ball_force(m, d));
  EXPECT_GT(ball_force(copy, of_copy), 0.0);
}

TEST(SceneRegistry, CopyMayHaveNumbersOfItsOwn) {
  const ModelPointer m = testing::load(scene("2e8"));
  const Attached attached(m);
  const ModelPointer copy(mj_copyModel(nullptr, m.get()));
  copy->numeric_data[0] = 6e8;
  const DataPointer d = testing::make_data(m), of_copy = testing::make_data(copy);
  for (int i = 0; i < 3; ++i) {
    const double force = ball_force(m, d);
    EXPECT_NEAR(ball_force(copy, of_copy), 3.0 * force, 1e-9 * force);
  }
}

TEST(SceneRegistry, CopyCanBeAttachedItselfAndGetsNativeContactBack) {
  const ModelPointer m = testing::load(scene("2e8"));
  const Attached attached(m);
  const ModelPointer copy(mj_copyModel(nullptr, m.get()));
  {
    const Attached second(copy);
  }
  EXPECT_FALSE(copy->opt.disableflags & mjDSBL_CONTACT);
  EXPECT_TRUE(m->opt.disableflags & mjDSBL_CONTACT);
}

TEST(SceneRegistry, SecondLoadOfTheSceneKeepsNativeContact) {
  const ModelPointer m = testing::load(scene("2e8"));
  const ModelPointer other = testing::load(scene("2e8"));
  const Attached attached(m);
  const DataPointer d = testing::make_data(other);
  EXPECT_EQ(ball_force(other, d), 0.0);
  EXPECT_EQ(d->ncon, 1);
}

TEST(SceneRegistry, FlagsAreAsBeforeAfterDetach) {
  const ModelPointer m = testing::load(scene("2e8"));
  const int before = m->opt.disableflags;
  {
    const Attached attached(m);
  }
  EXPECT_EQ(m->opt.disableflags, before);
}

TEST(SceneRegistry, ModelAtTheAddressOfOneThatWasNeverDetachedCanBeAttached) {
  const ModelPointer m = testing::load(scene("2e8")), other = testing::load(kOther);
  ASSERT_EQ(volcontact_attach(m.get(), nullptr, 0), 0);
  // As if `m` had been deleted and `other` were made in its place.
  mjModel kept = *m;
  *m = *other;
  EXPECT_EQ(contact_of(m.get()), nullptr);
  EXPECT_EQ(volcontact_attach(m.get(), nullptr, 0), 0);
  EXPECT_NE(contact_of(m.get()), nullptr);
  EXPECT_EQ(volcontact_detach(m.get(), nullptr, 0), 0);
  *m = kept;
  EXPECT_EQ(scenes_of_the_callback(), 0);
}

TEST(LiveNumbers, ChangeActsInTheNextEvaluation) {
  const ModelPointer m = testing::load(scene("2e8"));
  const DataPointer d = testing::make_data(m);
  const Attached attached(m);
  const double before = ball_force(m, d);
  m->numeric_data[0] = 4e8;  // both sides have this material
  EXPECT_NEAR(ball_force(m, d), 2.0 * before, 1e-9 * before);
  m->numeric_data[0] = 2e8;
  EXPECT_EQ(ball_force(m, d), before);
}

TEST(LiveNumbers, SizesFrictionAndMasksAreFollowed) {
  const ModelPointer m = testing::load(scene("2e8"));
  const DataPointer d = testing::make_data(m);
  const Attached attached(m);
  const double before = ball_force(m, d);
  m->geom_size[3] = 0.051;
  EXPECT_GT(ball_force(m, d), 2.0 * before);
  m->geom_contype[1] = m->geom_conaffinity[1] = 0;
  EXPECT_EQ(ball_force(m, d), 0.0);
}

TEST(LiveNumbers, InvalidOnesLeaveTheLastValidInForce) {
  const ModelPointer m = testing::load(scene("2e8"));
  const DataPointer d = testing::make_data(m);
  const Attached attached(m);
  m->numeric_data[0] = 3e8;
  const double valid = ball_force(m, d);
  static int warnings;
  warnings = 0;
  mju_user_warning = [](const char*) { ++warnings; };
  m->numeric_data[0] = -1.0;
  EXPECT_EQ(ball_force(m, d), valid);
  EXPECT_EQ(ball_force(m, d), valid);
  mju_user_warning = nullptr;
  EXPECT_EQ(warnings, 1);
  char text[500];
  EXPECT_GT(volcontact_live_error(m.get(), text, sizeof text), 0);
  EXPECT_TRUE(testing::contains(text, "stiffness = -1 [N/m^3] is out of range: must be > 0"));
  m->numeric_data[0] = 2e8;
  EXPECT_LT(ball_force(m, d), valid);
  EXPECT_EQ(volcontact_live_error(m.get(), text, sizeof text), 0);
}

TEST(LiveNumbers, TargetCannotChangeWhileAttached) {
  const ModelPointer m = testing::load(
      testing::ball_scene(0.049, testing::numeric("volcontact/option/target/passive", "0")));
  const DataPointer d = testing::make_data(m);
  const Attached attached(m);
  mju_user_warning = [](const char*) {};
  m->numeric_data[0] = 1.0;
  EXPECT_GT(ball_force(m, d), 0.0);
  mju_user_warning = nullptr;
  char text[500];
  volcontact_live_error(m.get(), text, sizeof text);
  EXPECT_TRUE(testing::contains(text, "volcontact/option/target cannot change"));
}

}  // namespace
}  // namespace volcontact::adaptor::scene_registry_test
