// SPDX-License-Identifier: Apache-2.0
#include "adaptor/model_content.h"

#include <gtest/gtest.h>

#include "adaptor/support/models.h"

namespace volcontact::adaptor::model_content_test {
namespace {

using testing::ModelPointer;

// The user's own number stands between two of ours.
std::string scene(const std::string& ball_name) {
  return "<mujoco><worldbody><geom name=\"floor\" type=\"plane\" size=\"1 1 1\"/>"
         "<body pos=\"0 0 1\"><freejoint/><geom name=\"" +
         ball_name +
         "\" type=\"sphere\" size=\".05\"/></body></worldbody><custom>"
         "<numeric name=\"volcontact/option/tolerance\" data=\"1e-3\"/>"
         "<numeric name=\"mine\" data=\"7\"/>"
         "<numeric name=\"volcontact/option/threads\" data=\"1\"/></custom></mujoco>";
}

class ModelContentTest : public ::testing::Test {
 protected:
  ModelContentTest()
      : m(testing::compile(scene("ball"))), content(m.get(), read_scene_keys(m.get())) {}

  ModelPointer m;
  ModelContent content;
};

TEST_F(ModelContentTest, KnowsTheModelAndItsCopies) {
  const ModelPointer copy(mj_copyModel(nullptr, m.get()));
  for (const mjModel* model : {m.get(), copy.get()}) {
    EXPECT_TRUE(content.is_same_model(model));
    EXPECT_TRUE(content.has_same_values(model));
  }
}

TEST_F(ModelContentTest, OtherNamesAreAnotherModel) {
  EXPECT_FALSE(content.is_same_model(testing::compile(scene("bell")).get()));
  EXPECT_FALSE(content.is_same_model(testing::compile(scene("a_ball")).get()));
}

TEST_F(ModelContentTest, WatchesWhatItWasMadeOf) {
  const auto changes = [&](auto& number, auto value) {
    const auto before = number;
    number = value;
    const bool noticed = !content.has_same_values(m.get());
    EXPECT_TRUE(content.is_same_model(m.get()));
    number = before;
    return noticed;
  };
  EXPECT_TRUE(changes(m->numeric_data[0], 1e-4));
  EXPECT_TRUE(changes(m->numeric_data[2], 2.0));
  EXPECT_TRUE(changes(m->geom_size[3], 0.06));
  EXPECT_TRUE(changes(m->geom_friction[0], 0.5));
  EXPECT_TRUE(changes(m->geom_type[1], static_cast<int>(mjGEOM_BOX)));
  EXPECT_TRUE(changes(m->geom_contype[1], 0));
  EXPECT_TRUE(changes(m->geom_conaffinity[1], 0));
  EXPECT_TRUE(changes(m->opt.disableflags, static_cast<int>(mjDSBL_FILTERPARENT)));
  EXPECT_TRUE(content.has_same_values(m.get()));
}

TEST_F(ModelContentTest, UsersNumbersAreNotWatched) {
  m->numeric_data[1] = 8.0;
  m->body_mass[1] = 3.0;
  EXPECT_TRUE(content.has_same_values(m.get()));
}

}  // namespace
}  // namespace volcontact::adaptor::model_content_test
