// SPDX-License-Identifier: Apache-2.0
#include "adaptor/volcontact_mujoco.h"

#include <gtest/gtest.h>

#include "adaptor/mujoco/mujoco_compat.h"
#include "adaptor/support/models.h"

namespace volcontact::adaptor::volcontact_mujoco_test {
namespace {

using testing::ModelPointer;

struct Answer {
  int code;
  std::string message;
};

template <typename Model>
Answer ask(int (*function)(Model*, char*, int), const ModelPointer& m) {
  char message[1000] = "";
  const int code = function(m.get(), message, sizeof message);
  return {code, message};
}

TEST(Interface, KnowsTheReleaseItWasBuiltFor) {
  EXPECT_EQ(volcontact_mujoco_version(), mj_version());
  EXPECT_EQ(volcontact_check_version(nullptr, 0), 0);
}

TEST(Interface, VersionsAreSpeltAsMuJoCoDoes) {
  EXPECT_EQ(version_text(222), "2.2.2");
  EXPECT_EQ(version_text(3010000), "3.10.0");
  EXPECT_EQ(version_text(4000000), "4.0.0");
}

TEST(Interface, TooSmallUserdataNamesTheLineToAdd) {
  const std::string key = testing::numeric("volcontact/option/tolerance", "1e-3");
  const ModelPointer m = testing::compile(testing::ball_scene(1.0, key));
  const int needed = ask(volcontact_userdata_size, m).code;
  EXPECT_GT(needed, 0);
  const Answer answer = ask(volcontact_attach, m);
  EXPECT_EQ(answer.code, VOLCONTACT_ERROR_SCENE);
  const std::string line = "<size nuserdata=\"" + std::to_string(needed) + "\"/>";
  EXPECT_TRUE(testing::contains(answer.message, line));
  // And with that line it works.
  const ModelPointer better = testing::compile(testing::ball_scene(1.0, key + line));
  EXPECT_EQ(ask(volcontact_attach, better).code, 0);
  EXPECT_EQ(ask(volcontact_detach, better).code, 0);
}

TEST(Interface, KeysOfTheProgramComeBeforeThoseOfTheFile) {
  const ModelPointer m = testing::load(testing::ball_scene(
      0.049, testing::material("m", {{"stiffness", "2e8"}, {"damping", "0"}}, {"floor"})));
  const testing::DataPointer d = testing::make_data(m);
  const auto force_with = [&](std::vector<std::pair<std::string, double>> given) {
    std::vector<volcontact_key> keys;
    for (const auto& [name, number] : given) keys.push_back({name.c_str(), &number, 1});
    char message[1000] = "";
    const int code = volcontact_attach_with(m.get(), keys.data(), static_cast<int>(keys.size()),
                                            message, sizeof message);
    if (code < 0) throw std::invalid_argument(message);
    mj_resetData(m.get(), d.get());
    mj_forward(m.get(), d.get());
    volcontact_detach(m.get(), nullptr, 0);
    return d->qfrc_applied[2] + d->qfrc_passive[2];
  };
  const std::string ball = "volcontact/material/of_ball/stiffness";
  const double one = force_with({{ball, 2e8}, {"volcontact/option/implicit/off", 1.0}});
  EXPECT_GT(one, 0.0);
  // In series with the floor of the file: 1e8 of two times 2e8, and 3/2 of it of 2e8 and 6e8.
  const double other = force_with({{ball, 6e8}, {"volcontact/option/implicit/off", 1.0}});
  EXPECT_NEAR(other, 1.5 * one, 1e-9 * one);
  const double floor = force_with({{ball, 6e8},
                                   {"volcontact/material/m/stiffness", 6e8},
                                   {"volcontact/option/implicit/off", 1.0},
                                   {"volcontact/option/target/passive", 1.0}});
  EXPECT_NEAR(floor, 3.0 * one, 1e-9 * one);
  EXPECT_GT(d->qfrc_passive[2], 0.0);
  const auto error_with = [&](const char* name, double number) {
    return testing::message_of([&] { force_with({{ball, 1e8}, {name, number}}); });
  };
  EXPECT_TRUE(testing::contains(error_with("volcontact/option/tolerence", 1e-3), "tolerance"));
  EXPECT_TRUE(testing::contains(error_with("stiffness", 1e8), "begin with volcontact/"));
  EXPECT_TRUE(testing::contains(error_with("volcontact/material/b/stiffness", 1e8),
                                "volcontact/material/of_ball is that of all geoms"));
  EXPECT_TRUE(
      testing::contains(error_with("volcontact/material/m/friction", -1.0), "out of range"));
}

TEST(Interface, ModelWithoutKeysNeedsNoRoom) {
  const ModelPointer m = testing::compile(testing::ball_scene(0.049, ""));
  const ModelPointer roomy = testing::load(
      testing::ball_scene(0.049, testing::numeric("volcontact/option/target/passive", "1")));
  const testing::DataPointer d = testing::make_data(m), of_roomy = testing::make_data(roomy);
  const testing::Attached attached(m), also(roomy);
  for (int i = 0; i < 1000; ++i) {
    mj_step(m.get(), d.get());
    mj_step(roomy.get(), of_roomy.get());
  }
  EXPECT_EQ(d->ncon, 0);
  EXPECT_GT(d->qfrc_passive[2], 0.0);
  for (int i = 0; i < m->nq; ++i) EXPECT_EQ(d->qpos[i], of_roomy->qpos[i]);
  volcontact_energy energy, of_other;
  volcontact_get_energy(m.get(), d.get(), &energy);
  volcontact_get_energy(roomy.get(), of_roomy.get(), &of_other);
  EXPECT_EQ(energy.elastic, of_other.elastic);
  EXPECT_EQ(energy.dissipated[0], of_other.dissipated[0]);
  EXPECT_GT(energy.dissipated[0], 0.0);
}

TEST(Interface, OnlyTargetPassiveGoesWithoutRoom) {
  const ModelPointer m = testing::compile(testing::ball_scene(0.049, ""));
  const double one = 1.0;
  for (const char* name : {"volcontact/option/target/applied", "volcontact/option/target/xfrc"}) {
    const volcontact_key key{name, &one, 1};
    char message[1000] = "";
    EXPECT_EQ(volcontact_attach_with(m.get(), &key, 1, message, sizeof message),
              VOLCONTACT_ERROR_SCENE);
    EXPECT_TRUE(
        testing::contains(message, "without room there is volcontact/option/target/passive"));
  }
}

TEST(Interface, UsersOwnUserdataIsNotTouched) {
  const ModelPointer m = testing::load(testing::ball_scene(0.049, "<size nuserdata=\"3\"/>"));
  const testing::DataPointer d = testing::make_data(m);
  const testing::Attached attached(m);
  for (int i = 0; i < 3; ++i) d->userdata[i] = 1.0 + i;
  for (int i = 0; i < 10; ++i) mj_step(m.get(), d.get());
  for (int i = 0; i < 3; ++i) EXPECT_EQ(d->userdata[i], 1.0 + i);
  EXPECT_GT(d->qfrc_applied[2], 0.0);
}

TEST(Interface, SceneErrorsComeAsMessages) {
  const ModelPointer m = testing::compile(
      testing::ball_scene(1.0, testing::numeric("volcontact/option/tolerence", "1e-3")));
  for (const Answer& answer :
       {ask(volcontact_attach, m), ask(volcontact_reserve, m), ask(volcontact_userdata_size, m)}) {
    EXPECT_EQ(answer.code, VOLCONTACT_ERROR_SCENE);
    EXPECT_TRUE(testing::contains(answer.message, "did you mean 'volcontact/option/tolerance'?"));
  }
  EXPECT_FALSE(m->opt.disableflags & mjDSBL_CONTACT);
}

TEST(Interface, ModelWithoutGeomsIsRefused) {
  const ModelPointer m = testing::compile(
      "<mujoco><worldbody><body><freejoint/><inertial pos=\"0 0 0\" mass=\"1\" "
      "diaginertia=\"1 1 1\"/></body></worldbody></mujoco>");
  const Answer answer = ask(volcontact_attach, m);
  EXPECT_EQ(answer.code, VOLCONTACT_ERROR_SCENE);
  EXPECT_TRUE(testing::contains(answer.message, "no geoms"));
}

TEST(Interface, OpenMeshThatCanTouchIsRefusedAndOthersAreNot) {
  const std::string mesh =
      "<mujoco><asset><mesh name=\"w\" vertex=\"0 0 0  1 0 0  0 1 0  0 0 1\" "
      "face=\"0 2 1  0 1 3  1 2 3\"/></asset><worldbody>"
      "<geom type=\"plane\" size=\"1 1 1\"/><body><freejoint/><inertial pos=\"0 0 0\" mass=\"1\" "
      "diaginertia=\"1 1 1\"/><geom name=\"wedge\" type=\"mesh\" mesh=\"w\" MASKS/></body>"
      "</worldbody></mujoco>";
  const auto with = [&](const std::string& masks) {
    std::string text = mesh;
    return testing::compile(text.replace(text.find("MASKS"), 5, masks));
  };
  const Answer answer = ask(volcontact_reserve, with(""));
  EXPECT_EQ(answer.code, VOLCONTACT_ERROR_SCENE);
  EXPECT_TRUE(testing::contains(answer.message, "geom 'wedge', mesh 'w'"));
  EXPECT_GT(ask(volcontact_reserve, with("contype=\"0\" conaffinity=\"0\"")).code, 0);
}

TEST(Interface, NativeContactIsOffWhileAttachedAndRestored) {
  const ModelPointer m = testing::load(testing::ball_scene(0.0499, ""));
  const testing::DataPointer d = testing::make_data(m);
  {
    const testing::Attached attached(m);
    mj_forward(m.get(), d.get());
    EXPECT_EQ(d->ncon, 0);
  }
  mj_forward(m.get(), d.get());
  EXPECT_EQ(d->ncon, 1);
  // A scene that had it off keeps it off.
  m->opt.disableflags |= mjDSBL_CONTACT;
  {
    const testing::Attached attached(m);
  }
  EXPECT_TRUE(m->opt.disableflags & mjDSBL_CONTACT);
}

TEST(Interface, AttachingTwiceOrDetachingNothingIsAnError) {
  const ModelPointer m = testing::load(testing::ball_scene(1.0, ""));
  const Answer nothing = ask(volcontact_detach, m);
  EXPECT_EQ(nothing.code, VOLCONTACT_ERROR_STATE);
  EXPECT_EQ(nothing.message, "the model is not attached");
  const testing::Attached attached(m);
  const Answer twice = ask(volcontact_attach, m);
  EXPECT_EQ(twice.code, VOLCONTACT_ERROR_STATE);
  EXPECT_EQ(twice.message, "the model is attached already");
  EXPECT_EQ(volcontact_is_attached(m.get()), 1);
}

TEST(Interface, ReleaseLeavesTheUsersForce) {
  const ModelPointer m = testing::load(testing::ball_scene(0.049, ""));
  const testing::DataPointer d = testing::make_data(m);
  const testing::Attached attached(m);
  d->qfrc_applied[0] = 2.0;
  d->qfrc_applied[2] = 3.0;
  mj_forward(m.get(), d.get());
  EXPECT_GT(d->qfrc_applied[2], 3.0);
  EXPECT_EQ(volcontact_release(m.get(), d.get()), 0);
  EXPECT_EQ(d->qfrc_applied[0], 2.0);
  EXPECT_EQ(d->qfrc_applied[2], 3.0);
}

TEST(Interface, SkippedCallbackIsWarnedOf) {
  const ModelPointer m = testing::load(testing::ball_scene(1.0, ""));
#if mjVERSION_HEADER <= 335
  m->opt.disableflags |= mjDSBL_PASSIVE;
#else
  m->opt.disableflags |= mjDSBL_SPRING | mjDSBL_DAMPER;
#endif
  const Answer answer = ask(volcontact_attach, m);
  EXPECT_EQ(answer.code, 0);
  EXPECT_TRUE(testing::contains(answer.message, "there will be no contact at all"));
  ask(volcontact_detach, m);
}

TEST(Interface, FlagsThatSkipTheCallbackAreTheOnesNamed) {
  // Independent of what we believe: count the calls.
  const ModelPointer m = testing::load(testing::ball_scene(1.0, ""));
  const testing::DataPointer d = testing::make_data(m);
  static int calls;
  mjcb_passive = [](const mjModel*, mjData*) { ++calls; };
  for (int flags = 0; flags < (1 << 12); ++flags) {
    m->opt.disableflags = flags;
    calls = 0;
    mj_forward(m.get(), d.get());
    EXPECT_EQ(calls == 0, !flags_that_skip_passive(m.get()).empty()) << "flags " << flags;
  }
  mjcb_passive = nullptr;
}

#if mjVERSION_HEADER >= 340 && mjVERSION_HEADER < 4000000
TEST(Interface, SleepIsRefusedWhereNobodyCanWake) {
  const ModelPointer m = testing::load(testing::ball_scene(1.0, ""));
  m->opt.enableflags |= mjENBL_SLEEP;
  const Answer answer = ask(volcontact_attach, m);
  EXPECT_EQ(answer.code, VOLCONTACT_ERROR_SCENE);
  EXPECT_TRUE(testing::contains(answer.message, "sleep"));
}
#endif

TEST(Interface, DescriptionNeedsNoAttachAndCutsAtTheBuffer) {
  const ModelPointer m = testing::compile(testing::ball_scene(1.0, ""));
  const int length = volcontact_describe(m.get(), nullptr, 0, nullptr, 0);
  ASSERT_GT(length, 100);
  std::string text(static_cast<std::size_t>(length) + 1, 'x');
  EXPECT_EQ(volcontact_describe(m.get(), text.data(), length + 1, nullptr, 0), length);
  EXPECT_EQ(text[static_cast<std::size_t>(length)], '\0');
  EXPECT_EQ(text[static_cast<std::size_t>(length) - 1], '}');
  char little[5] = "xxxx";
  EXPECT_EQ(volcontact_describe(m.get(), little, 5, nullptr, 0), length);
  EXPECT_STREQ(little, text.substr(0, 4).c_str());
}

TEST(Interface, SitesBeyondTheCapacityAreCountedOnly) {
  const ModelPointer m = testing::load(testing::ball_scene(0.049, ""));
  const testing::DataPointer d = testing::make_data(m);
  const testing::Attached attached(m);
  mj_forward(m.get(), d.get());
  EXPECT_EQ(volcontact_sites(m.get(), d.get(), nullptr, 0), 1);
}

TEST(Interface, ReadingAModelThatIsNotAttachedIsAnError) {
  const ModelPointer m = testing::load(testing::ball_scene(0.049, ""));
  const testing::DataPointer d = testing::make_data(m);
  volcontact_energy energy;
  EXPECT_EQ(volcontact_sites(m.get(), d.get(), nullptr, 0), VOLCONTACT_ERROR_STATE);
  EXPECT_EQ(volcontact_get_energy(m.get(), d.get(), &energy), VOLCONTACT_ERROR_STATE);
  EXPECT_EQ(volcontact_release(m.get(), d.get()), VOLCONTACT_ERROR_STATE);
}

}  // namespace
}  // namespace volcontact::adaptor::volcontact_mujoco_test
