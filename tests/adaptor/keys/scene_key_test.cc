// SPDX-License-Identifier: Apache-2.0
#include "adaptor/keys/scene_key.h"

#include <gtest/gtest.h>

#include "adaptor/support/models.h"

namespace volcontact::adaptor::scene_key_test {
namespace {

using testing::contains;
using testing::message_of;

TEST(SceneKey, IsSplitAtItsSlashes) {
  const auto key = parse_key("c1_volcontact/material/rubber/stiffness");
  ASSERT_TRUE(key.has_value());
  EXPECT_EQ(key->prefix, "c1_");
  EXPECT_EQ(key->parts, (std::vector<std::string>{"material", "rubber", "stiffness"}));
  EXPECT_EQ(key->stem(2), "c1_volcontact/material/rubber");
}

TEST(SceneKey, NamesOfOthersAreLeftAlone) {
  EXPECT_FALSE(parse_key("gripper/gain").has_value());
  EXPECT_FALSE(parse_key("volcontact").has_value());
}

TEST(SceneKey, NearlyOurNameIsAnError) {
  EXPECT_TRUE(contains(message_of([] { parse_key("volcontat/option/threads"); }),
                       "did you mean 'volcontact/option/threads'?"));
}

TEST(SceneKey, UnknownPartOffersTheNearest) {
  const auto key = parse_key("volcontact/option/thread");
  const std::string message = message_of([&] { unknown_part(*key, 1, {"tolerance", "threads"}); });
  EXPECT_TRUE(contains(message, "after 'volcontact/option/' comes one of tolerance, threads"));
  EXPECT_TRUE(contains(message, "did you mean 'volcontact/option/threads'?"));
}

TEST(SceneKey, AMissingPartIsNamed) {
  const auto key = parse_key("volcontact/option/implicit");
  const std::string message = message_of([&] { unknown_part(*key, 2, {"on", "off", "auto"}); });
  EXPECT_TRUE(contains(message, "after 'volcontact/option/implicit/' comes one of on, off, auto"));
}

TEST(SceneKey, AKeyThatEndsBeforeItsNameIsToldSo) {
  const auto key = parse_key("volcontact/material");
  EXPECT_EQ(key->stem(2), "volcontact/material");
  const std::string message = message_of([&] { unknown_part(*key, 2, {"stiffness", "friction"}); });
  EXPECT_EQ(message,
            "volcontact/material: unknown key; after 'volcontact/material/' comes a name, then "
            "'/' and one of stiffness, friction");
}

}  // namespace
}  // namespace volcontact::adaptor::scene_key_test
