// SPDX-License-Identifier: Apache-2.0
#include "adaptor/scene/law_classes.h"

#include <gtest/gtest.h>

#include "adaptor/scene/scene_contact.h"
#include "adaptor/support/models.h"
#include "volcontact/force/laws.h"

namespace volcontact::adaptor::law_classes_test {
namespace {

// Balls that each have a friction of their own; the last one's is given.
std::string balls(int count, const std::string& last) {
  std::string bodies;
  for (int i = 0; i < count; ++i) {
    const std::string friction = i + 1 < count ? std::to_string(0.1 + 0.002 * i) : last;
    bodies += "<body pos=\"" + std::to_string(i) +
              " 0 1\"><freejoint/><geom size=\".1\" mass=\"1\" " + "friction=\"" + friction +
              " 0 0\"/></body>";
  }
  return "<mujoco><worldbody>" + bodies + "</worldbody></mujoco>";
}

// More frictions than are looked at one by one when the scene is read.
TEST(LawClasses, EachPairHasItsOwnFriction) {
  const testing::ModelPointer m = testing::compile(balls(100, ".9"));
  const SceneContact contact(m.get());
  EXPECT_LT(contact.made_pairs(), 10u);
  const auto friction_of = [&](int a, int b) {
    GeomPair pair;
    EXPECT_TRUE(contact.rules().admit(a, b, pair));
    const PairLaws words = contact.laws().in_words(m.get(), pair);
    for (const PairField& field : words.fields) {
      if (field.name == "friction") return field.value[0];
    }
    return -1.0;
  };
  EXPECT_DOUBLE_EQ(friction_of(3, 7), 0.1 + 0.002 * 7);  // the larger one, as in MuJoCo
  EXPECT_DOUBLE_EQ(friction_of(0, 99), 0.9);
  GeomPair pair;
  ASSERT_TRUE(contact.rules().admit(3, 7, pair));
  const auto& laws = contact.laws().of(pair);
  EXPECT_EQ(&laws, &contact.laws().of(pair));
  EXPECT_EQ(contact.make_pair(pair).model.laws().friction.get(), laws.laws.friction.get());
}

// What is out of range is told when the scene is read, also where nobody looks at each friction.
TEST(LawClasses, AFrictionOutOfRangeIsRefusedAmongMany) {
  for (const int count : {5, 100}) {
    const testing::ModelPointer m = testing::compile(balls(count, ".5"));
    for (int i = 0; i < m->ngeom; ++i) m->geom_friction[3 * i] = -1.0 - i;
    const std::string message = testing::message_of([&] { SceneContact{m.get()}; });
    EXPECT_TRUE(testing::contains(message, "friction")) << message;
  }
}

}  // namespace
}  // namespace volcontact::adaptor::law_classes_test
