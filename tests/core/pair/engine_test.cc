// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/engine.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace volcontact::engine_test {
namespace {

TEST(Engine, WordsAndEnginesAreEachOthersInverse) {
  for (Engine engine : kEngines) EXPECT_EQ(engine_from(to_string(engine)), engine);
  EXPECT_EQ(engine_from("closed_form"), Engine::kClosedForm);
  EXPECT_EQ(engine_from("octree"), Engine::kOctree);
}

TEST(Engine, AnUnknownWordIsAnErrorThatTeaches) {
  try {
    engine_from("octre");
    FAIL() << "no error";
  } catch (const std::invalid_argument& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("unknown engine 'octre'"), std::string::npos) << message;
    EXPECT_NE(message.find("did you mean 'octree'?"), std::string::npos) << message;
    for (Engine engine : kEngines) {
      EXPECT_NE(message.find(to_string(engine)), std::string::npos) << message;
    }
  }
}

}  // namespace
}  // namespace volcontact::engine_test
