// SPDX-License-Identifier: Apache-2.0
#include "adaptor/scene/pair_kinds.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "adaptor/support/models.h"

namespace volcontact::adaptor::pair_kinds_test {
namespace {

// Bodies on joints and on each other, with geoms of few masks and frictions; two are named.
std::string bodies(std::mt19937& random) {
  const auto below = [&](unsigned n) { return static_cast<int>(random() % n); };
  std::string world = "<geom name=\"first\" size=\".1\"/>";
  for (int i = 0; i < 12; ++i) {
    std::string ends;
    for (int level = below(3); level >= 0; --level) {
      world += "<body name=\"b" + std::to_string(3 * i + level) + "\">";
      if (below(4) > 0) world += "<joint axis=\"0 1 0\"/>";
      for (int k = below(2); k >= 0; --k) {
        world += "<geom size=\".1\" mass=\"1\" contype=\"" + std::to_string(below(4)) +
                 "\" conaffinity=\"" + std::to_string(below(3)) + "\" friction=\"." +
                 std::to_string(1 + below(3)) + " 0 0\"/>";
      }
      ends += "</body>";
    }
    world += ends;
  }
  return "<mujoco><worldbody>" + world +
         "<body><freejoint/><geom name=\"last\" size=\".1\" mass=\"1\"/></body></worldbody>"
         "<contact><pair geom1=\"first\" geom2=\"last\"/><exclude body1=\"b0\" body2=\"b3\"/>"
         "</contact></mujoco>";
}

// Against a look at all pairs.
TEST(PairKinds, ThereIsAPairOfEachTwoKindsThatCanTouch) {
  std::mt19937 random(17);
  std::size_t found = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const testing::ModelPointer m = testing::compile(bodies(random));
    const PairRules rules(m.get(), read_scene_keys(m.get()));
    const std::vector<int> kinds = kinds_of<std::map<double, int>>(
        rules, [&](int geom) { return m->geom_friction[3 * geom]; });
    const auto kinds_of_pair = [&](const GeomPair& pair) {
      const auto kind = [&](int geom) { return kinds[static_cast<std::size_t>(geom)]; };
      return std::minmax({kind(pair.a), kind(pair.b)});
    };
    std::set<std::pair<int, int>> expected, told;
    rules.for_each([&](const GeomPair& pair) {
      if (pair.origin == PairOrigin::kMasks) expected.insert(kinds_of_pair(pair));
      return true;
    });
    bool is_named = false;
    for (const GeomPair& pair : pairs_of_kinds(rules, kinds)) {
      EXPECT_TRUE(rules.admits(pair.a, pair.b));
      if (pair.origin == PairOrigin::kMasks) told.insert(kinds_of_pair(pair));
      is_named = is_named || pair.native == 0;
    }
    EXPECT_EQ(told, expected) << trial;
    EXPECT_TRUE(is_named);
    found += told.size();
  }
  EXPECT_GT(found, 100u);
}

}  // namespace
}  // namespace volcontact::adaptor::pair_kinds_test
