// SPDX-License-Identifier: Apache-2.0
#include "volcontact/force/laws.h"

#include <gtest/gtest.h>

namespace volcontact::laws_test {
namespace {

std::string message_of(auto&& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no exception";
}

TEST(Laws, AreMadeByName) {
  const auto law = make_normal("hunt_crossley", {{"stiffness", {2e8}}, {"damping", {0.5}}});
  EXPECT_STREQ(law->name(), "hunt_crossley");
  EXPECT_DOUBLE_EQ(law->evaluate({.volume = 1e-8}, {}).magnitude, 2.0);
  EXPECT_STREQ(make_friction("regularized_coulomb", {})->name(), "regularized_coulomb");
}

TEST(Laws, UnknownNameOffersTheNearest) {
  EXPECT_EQ(message_of([] { make_normal("hunt_crosley", {}); }),
            "unknown normal law 'hunt_crosley': one of hunt_crossley, volume_spring "
            "(did you mean 'hunt_crossley'?)");
}

TEST(Laws, UnknownFieldOffersTheNearest) {
  EXPECT_EQ(message_of([] { make_normal("hunt_crossley", {{"stifness", {1.0}}}); }),
            "hunt_crossley has no field 'stifness' (did you mean 'stiffness'?)");
}

TEST(Laws, WrongCountIsSaid) {
  EXPECT_EQ(message_of([] { make_normal("hunt_crossley", {{"stiffness", {1.0, 2.0}}}); }),
            "hunt_crossley: stiffness takes 1 number, got 2");
}

TEST(Laws, ValuesComeBackByName) {
  const HuntCrossley::Params params{.stiffness = 3.0, .damping = 0.25};
  const FieldValues values = values_of<HuntCrossley>(params);
  EXPECT_EQ(values.at("stiffness"), std::vector<double>{3.0});
  EXPECT_EQ(values.at("damping"), std::vector<double>{0.25});
}

}  // namespace
}  // namespace volcontact::laws_test
