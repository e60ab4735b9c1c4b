// SPDX-License-Identifier: Apache-2.0
#include "adaptor/passive_callback.h"

#include <gtest/gtest.h>

#include "adaptor/support/models.h"

namespace volcontact::adaptor::passive_callback_test {
namespace {

using testing::DataPointer;
using testing::ModelPointer;

// A user's own callback: pushes along x.
void push(const mjModel*, mjData* d) { d->qfrc_passive[0] += 2.0; }

mjfGeneric covered = nullptr;
void cover(const mjModel* m, mjData* d) {
  covered(m, d);
  d->qfrc_passive[0] += 1.0;
}

class PassiveCallback : public ::testing::Test {
 protected:
  PassiveCallback() : m(testing::load(testing::ball_scene(0.049, ""))), d(testing::make_data(m)) {
    mjcb_passive = nullptr;
  }
  ~PassiveCallback() override { mjcb_passive = nullptr; }

  void attach() { ASSERT_EQ(volcontact_attach(m.get(), nullptr, 0), 0); }
  void detach() { ASSERT_EQ(volcontact_detach(m.get(), nullptr, 0), 0); }
  void forward() { mj_forward(m.get(), d.get()); }

  ModelPointer m;
  DataPointer d;
};

TEST_F(PassiveCallback, IsInstalledWhileAModelIsAttached) {
  attach();
  EXPECT_EQ(volcontact_is_installed(), 1);
  detach();
  EXPECT_EQ(volcontact_is_installed(), 0);
  EXPECT_EQ(mjcb_passive, nullptr);
}

TEST_F(PassiveCallback, CallbackThatWasThereIsCalledAndRestored) {
  mjcb_passive = push;
  attach();
  forward();
  EXPECT_EQ(d->qfrc_passive[0], 2.0);
  EXPECT_GT(d->qfrc_applied[2], 0.0);
  detach();
  EXPECT_EQ(mjcb_passive, push);
}

TEST_F(PassiveCallback, ReplacedCallbackIsNoticedAndLeftAlone) {
  attach();
  mjcb_passive = push;
  EXPECT_EQ(volcontact_is_installed(), 0);
  detach();
  EXPECT_EQ(mjcb_passive, push);
}

TEST_F(PassiveCallback, CallbackPutOverOursMayCallOursAlsoInASecondRound) {
  attach();
  covered = mjcb_passive;
  mjcb_passive = cover;
  forward();
  EXPECT_EQ(d->qfrc_passive[0], 1.0);
  const double force = d->qfrc_applied[2];
  EXPECT_GT(force, 0.0);
  detach();
  // Theirs stays and still calls ours; ours is now put over theirs.
  forward();
  attach();
  forward();
  EXPECT_EQ(d->qfrc_passive[0], 1.0);
  EXPECT_EQ(d->qfrc_applied[2], force);
  detach();
  EXPECT_EQ(mjcb_passive, cover);
}

TEST_F(PassiveCallback, ServesSeveralModelsEachUntilItsOwnDetach) {
  const ModelPointer second = testing::load(testing::ball_scene(0.048, ""));
  const DataPointer of_second = testing::make_data(second);
  attach();
  ASSERT_EQ(volcontact_attach(second.get(), nullptr, 0), 0);
  forward();
  mj_forward(second.get(), of_second.get());
  EXPECT_GT(of_second->qfrc_applied[2], d->qfrc_applied[2]);
  EXPECT_GT(d->qfrc_applied[2], 0.0);
  detach();
  EXPECT_EQ(volcontact_is_installed(), 1);
  mj_resetData(second.get(), of_second.get());
  mj_forward(second.get(), of_second.get());
  EXPECT_GT(of_second->qfrc_applied[2], 0.0);
  mj_resetData(m.get(), d.get());
  forward();
  EXPECT_EQ(d->qfrc_applied[2], 0.0);
  ASSERT_EQ(volcontact_detach(second.get(), nullptr, 0), 0);
  EXPECT_EQ(volcontact_is_installed(), 0);
}

TEST_F(PassiveCallback, ModelsCompileWhileItIsInstalled) {
  // MuJoCo calls it once with a temporary model and data that have no room in userdata.
  attach();
  EXPECT_NO_THROW(testing::compile(testing::ball_scene(0.049, "")));
  EXPECT_NO_THROW(
      testing::compile(testing::ball_scene(0.049, "<option><flag contact=\"disable\"/></option>")));
  detach();
}

}  // namespace
}  // namespace volcontact::adaptor::passive_callback_test
