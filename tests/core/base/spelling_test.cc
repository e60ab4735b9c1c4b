// SPDX-License-Identifier: Apache-2.0
#include "volcontact/base/spelling.h"

#include <gtest/gtest.h>

namespace volcontact::spelling_test {
namespace {

const std::vector<std::string> kWords{"stiffness", "damping", "friction", "static_friction"};

TEST(Spelling, FindsOneWrongLetterOfEachKind) {
  EXPECT_EQ(nearest_spelling("stifness", kWords), "stiffness");    // left out
  EXPECT_EQ(nearest_spelling("stifffness", kWords), "stiffness");  // too many
  EXPECT_EQ(nearest_spelling("stiffnass", kWords), "stiffness");   // replaced
  EXPECT_EQ(nearest_spelling("dapming", kWords), "damping");       // swapped
}

TEST(Spelling, TakesTheNearestOfSeveral) {
  EXPECT_EQ(nearest_spelling("frictoin", kWords), "friction");
  EXPECT_EQ(nearest_spelling("static_frction", kWords), "static_friction");
}

TEST(Spelling, OffersNothingFarFetched) {
  EXPECT_EQ(nearest_spelling("colour", kWords), "");
  EXPECT_EQ(nearest_spelling("", kWords), "");
  EXPECT_EQ(nearest_spelling("damping", {}), "");
}

TEST(Spelling, EndsAMessage) {
  EXPECT_EQ(did_you_mean("dampin", kWords), " (did you mean 'damping'?)");
  EXPECT_EQ(did_you_mean("colour", kWords), "");
}

}  // namespace
}  // namespace volcontact::spelling_test
