// SPDX-License-Identifier: Apache-2.0
#include "adaptor/auto_attach.h"

#include <gtest/gtest.h>

#include "adaptor/scene_registry.h"
#include "adaptor/support/models.h"

namespace volcontact::adaptor::auto_attach_test {
namespace {

using testing::DataPointer;
using testing::ModelPointer;

const std::string kKeys = testing::material("m", {{"stiffness", "1e8"}}, {"floor", "ball"});

class AutoAttach : public ::testing::Test {
 protected:
  AutoAttach() { EXPECT_EQ(volcontact_set_auto(1), 0); }
  ~AutoAttach() override {
    for (const ModelPointer* m : attached) volcontact_detach(m->get(), nullptr, 0);
    volcontact_set_auto(0);
    // A model that MuJoCo compiled and threw away was attached, too, in some releases.
    mjcb_passive = nullptr;
  }
  std::vector<const ModelPointer*> attached;
};

std::string with_room(const std::string& keys) {
  const ModelPointer m = testing::compile(testing::ball_scene(0.049, keys));
  const int needed = volcontact_userdata_size(m.get(), nullptr, 0);
  return testing::ball_scene(0.049, keys + "<size nuserdata=\"" + std::to_string(needed) + "\"/>");
}

TEST_F(AutoAttach, ModelWithKeysAndRoomIsVolumetricWithoutACall) {
  volcontact_set_auto(0);
  const std::string scene = with_room(kKeys);
  volcontact_set_auto(1);
  const ModelPointer m = testing::compile(scene);
  attached = {&m};
  const DataPointer d = testing::make_data(m);
  // The evaluation at which native contact is turned off has its native contacts still, alone.
  mj_forward(m.get(), d.get());
  EXPECT_EQ(d->ncon == 0, d->qfrc_applied[2] > 0.0);
  mj_forward(m.get(), d.get());
  EXPECT_EQ(volcontact_is_attached(m.get()), 1);
  EXPECT_EQ(d->ncon, 0);
  EXPECT_GT(d->qfrc_applied[2], 0.0);
}

TEST_F(AutoAttach, ModelWithoutKeysStaysAsItIs) {
  const ModelPointer m =
      testing::compile(testing::ball_scene(0.049, "<size nuserdata=\"20000\"/>"));
  const DataPointer d = testing::make_data(m);
  mj_forward(m.get(), d.get());
  EXPECT_EQ(volcontact_is_attached(m.get()), 0);
  EXPECT_EQ(d->ncon, 1);
}

std::string warning;
void keep_warning(const char* text) { warning = text; }

TEST_F(AutoAttach, WhatCannotBeAttachedIsWarnedOfAndStaysNative) {
  mju_user_warning = keep_warning;
  warning.clear();
  const ModelPointer m = testing::compile(testing::ball_scene(0.049, kKeys));
  const DataPointer d = testing::make_data(m);
  for (int i = 0; i < 3; ++i) mj_forward(m.get(), d.get());
  EXPECT_TRUE(testing::contains(warning, "contact stays native"));
  EXPECT_TRUE(testing::contains(warning, "<size nuserdata="));
  EXPECT_EQ(d->ncon, 1);
  warning.clear();
  mj_forward(m.get(), d.get());
  EXPECT_EQ(warning, "");
  mju_user_warning = nullptr;
}

TEST_F(AutoAttach, OffAgainItIsInstalledOnlyWhereAModelIsAttached) {
  const ModelPointer m = testing::load(testing::ball_scene(0.049, ""));
  {
    const testing::Attached while_it_lasts(m);
    volcontact_set_auto(0);
    EXPECT_EQ(volcontact_is_installed(), 1);
  }
  EXPECT_EQ(volcontact_is_installed(), scenes_of_the_callback() > 0 ? 1 : 0);
}

}  // namespace
}  // namespace volcontact::adaptor::auto_attach_test
