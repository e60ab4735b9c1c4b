// SPDX-License-Identifier: Apache-2.0
#include "adaptor/geoms/pair_rules.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <vector>

#include "adaptor/support/models.h"

namespace volcontact::adaptor::pair_rules_test {
namespace {

using Pairs = std::set<std::pair<int, int>>;

Pairs ours(const mjModel* m) {
  Pairs pairs;
  PairRules(m, read_scene_keys(m)).for_each([&](const GeomPair& pair) {
    EXPECT_LT(pair.a, pair.b);
    return pairs.insert({pair.a, pair.b}).second;
  });
  return pairs;
}

// The pairs MuJoCo itself collides: the scenes below pile all geoms onto one place.
Pairs native(const testing::ModelPointer& m) {
  const testing::DataPointer d = testing::make_data(m);
  mj_forward(m.get(), d.get());
  Pairs pairs;
  for (int i = 0; i < d->ncon; ++i) {
    pairs.insert(std::minmax(d->contact[i].geom1, d->contact[i].geom2));
  }
  return pairs;
}

// Bodies of spheres that all overlap: what does not collide is left out by a rule.
std::string pile(const std::string& more, const std::string& option = "") {
  return "<mujoco><size nconmax=\"500\" njmax=\"2000\"/><option " + option +
         R"(/><default><geom type="sphere" size=".5"/></default><worldbody>
    <geom name="floor" type="plane" size="1 1 1"/>
    <geom name="wall" type="plane" size="1 1 1" euler="90 0 0"/>
    <geom name="stone" pos=".01 0 0"/>
    <body name="shelf" pos="0 .01 0"><geom name="shelf"/></body>
    <body name="a" pos="0 0 .02"><freejoint/>
      <geom name="a1" contype="2" conaffinity="1"/><geom name="a2" pos=".03 0 0"/>
      <body name="a_child" pos="0 .04 0"><joint/><geom name="a_child"/>
        <body name="a_welded" pos="0 0 .03"><geom name="a_welded"/></body>
        <body name="a_grandchild" pos="0 .02 0"><joint axis="1 0 0"/><geom name="a_grandchild"/>
        </body></body></body>
    <body name="b" pos="0 0 -.02"><freejoint/>
      <geom name="b1" contype="4" conaffinity="2"/><geom name="ghost" contype="0" conaffinity="0"/>
    </body>
    <body name="c" pos=".05 0 -.02"><joint type="slide"/><geom name="c"/></body>
  </worldbody>)" +
         more + "</mujoco>";
}

TEST(PairRules, RulesAreThoseOfMuJoCo) {
  const testing::ModelPointer m = testing::compile(pile(""));
  EXPECT_EQ(ours(m.get()), native(m));
}

TEST(PairRules, ExcludedBodiesDoNotTouch) {
  const std::string exclude =
      "<contact><exclude body1=\"c\" body2=\"a\"/><exclude body1=\"b\" body2=\"c\"/>"
      "<exclude body1=\"world\" body2=\"c\"/></contact>";
  const testing::ModelPointer m = testing::compile(pile(exclude));
  EXPECT_EQ(ours(m.get()), native(m));
  EXPECT_LT(ours(m.get()).size(), ours(testing::compile(pile("")).get()).size());
}

TEST(PairRules, ExplicitPairsTouchWhateverTheMasksSay) {
  const std::string pair =
      "<contact><pair geom1=\"ghost\" geom2=\"c\"/><pair geom1=\"a_child\" geom2=\"a1\"/>"
      "<exclude body1=\"c\" body2=\"b\"/></contact>";
  const testing::ModelPointer m = testing::compile(pile(pair));
  EXPECT_EQ(ours(m.get()), native(m));
}

TEST(PairRules, ParentFilterCanBeOff) {
  const std::string option = "><flag filterparent=\"disable\"/></option><option ";
  const testing::ModelPointer m = testing::compile(pile("", option));
  EXPECT_EQ(ours(m.get()), native(m));
  EXPECT_GT(ours(m.get()).size(), ours(testing::compile(pile("")).get()).size());
}

TEST(PairRules, ListedPairIsAddedToTheNativeOnes) {
  const std::string listed =
      "<custom><tuple name=\"volcontact/pair/p\"><element objtype=\"geom\" objname=\"ghost\"/>"
      "<element objtype=\"geom\" objname=\"c\"/></tuple></custom>";
  const testing::ModelPointer m = testing::compile(pile(listed));
  Pairs expected = ours(testing::compile(pile("")).get());
  const std::pair<int, int> added =
      std::minmax(mj_name2id(m.get(), mjOBJ_GEOM, "ghost"), mj_name2id(m.get(), mjOBJ_GEOM, "c"));
  EXPECT_FALSE(expected.count(added));
  expected.insert(added);
  EXPECT_EQ(ours(m.get()), expected);
}

TEST(PairRules, ListedAloneWhenTheOptionSaysSo) {
  const std::string listed =
      "<custom><numeric name=\"volcontact/option/pairs/listed\" data=\"1\"/>"
      "<tuple name=\"volcontact/pair/p\"><element objtype=\"geom\" objname=\"ghost\"/>"
      "<element objtype=\"geom\" objname=\"c\"/></tuple></custom>";
  const testing::ModelPointer m = testing::compile(pile(listed));
  EXPECT_EQ(ours(m.get()).size(), 1u);
}

// Trees of bodies with geoms of few masks, excludes, pairs of both kinds.
std::string trees(std::mt19937& random) {
  const auto below = [&](unsigned n) { return static_cast<int>(random() % n); };
  std::string bodies, contact, custom;
  int geoms = 0, count = 0;
  std::vector<int> root_of_geom;
  int root = -1;
  const auto geom = [&] {
    root_of_geom.push_back(root);
    return "<geom name=\"g" + std::to_string(geoms++) + "\" size=\".1\" contype=\"" +
           std::to_string(below(4)) + "\" conaffinity=\"" + std::to_string(below(4)) + "\"/>";
  };
  const std::string of_world = geom();
  for (root = 0; root < 6; ++root) {
    std::string ends;
    const int depth = 1 + below(4);
    for (int level = 0; level < depth; ++level) {
      bodies += "<body name=\"b" + std::to_string(count++) + "\">";
      if (level == 0 || below(3) > 0) bodies += "<joint axis=\"0 1 0\"/>";
      for (int i = below(3); i >= 0; --i) bodies += geom();
      ends += "</body>";
    }
    bodies += ends;
  }
  std::set<std::pair<int, int>> named, excluded;
  for (int i = 0; i < 6; ++i) {
    const int a = below(static_cast<unsigned>(geoms)), b = below(static_cast<unsigned>(geoms));
    // Not "g" + ...: GCC 12 then warns of a copy that cannot be.
    const std::string g = "g", first = g + std::to_string(a), second = g + std::to_string(b);
    const bool is_new = a != b && named.insert(std::minmax(a, b)).second;
    if (is_new && i < 3) {
      contact += "<pair geom1=\"" + first + "\" geom2=\"" + second + "\"/>";
    } else if (is_new && root_of_geom[static_cast<std::size_t>(a)] !=
                             root_of_geom[static_cast<std::size_t>(b)]) {
      custom += "<tuple name=\"volcontact/pair/p" + std::to_string(i) +
                "\"><element objtype=\"geom\" objname=\"" + first +
                "\"/><element objtype=\"geom\" objname=\"" + second + "\"/></tuple>";
    }
    const int c = below(static_cast<unsigned>(count)), e = below(static_cast<unsigned>(count));
    if (c != e && excluded.insert(std::minmax(c, e)).second) {
      contact +=
          "<exclude body1=\"b" + std::to_string(c) + "\" body2=\"b" + std::to_string(e) + "\"/>";
    }
  }
  return "<mujoco><compiler autolimits=\"true\"/><default><geom mass=\"1\"/></default><worldbody>"
         "<geom type=\"plane\" size=\"1 1 1\"/><geom type=\"plane\" size=\"1 1 1\"/>" +
         of_world + bodies + "</worldbody><contact>" + contact + "</contact><custom>" + custom +
         "</custom></mujoco>";
}

// Counted by masks and bodies, against one by one.
TEST(PairRules, CountsAreThoseOfAllPairs) {
  std::mt19937 random(5);
  std::size_t total = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const testing::ModelPointer m = testing::compile(trees(random));
    if (trial % 3 == 0) m->opt.disableflags |= mjDSBL_FILTERPARENT;
    const SceneKeys keys = read_scene_keys(m.get());
    for (const bool listed_only : {false, true}) {
      const PairRules rules(m.get(), keys, listed_only);
      std::vector<int> partners(static_cast<std::size_t>(m->ngeom), 0);
      std::size_t count = 0;
      for (int a = 0; a < m->ngeom; ++a) {
        for (int b = a + 1; b < m->ngeom; ++b) {
          GeomPair pair, again;
          ASSERT_EQ(rules.admit(a, b, pair), rules.admits(b, a));
          ASSERT_EQ(rules.find(rules.id(b, a), again), rules.admits(a, b));
          if (!rules.admits(a, b)) continue;
          EXPECT_EQ(std::pair(again.a, again.b), std::pair(a, b));
          ++count;
          ++partners[static_cast<std::size_t>(a)];
          ++partners[static_cast<std::size_t>(b)];
        }
      }
      ASSERT_EQ(rules.count(), count) << trial;
      for (int geom = 0; geom < m->ngeom; ++geom) {
        ASSERT_EQ(rules.partners(geom), partners[static_cast<std::size_t>(geom)]) << trial;
      }
      total += count;
    }
  }
  EXPECT_GT(total, 1000u);
}

TEST(PairRules, NumbersThatAreNoPairsAreNotFound) {
  const testing::ModelPointer m = testing::compile(pile(""));
  const PairRules rules(m.get(), read_scene_keys(m.get()));
  const PairId geoms = rules.geoms();
  GeomPair pair;
  for (const PairId id : {PairId{-1}, geoms * geoms, geoms + 0, geoms + 1, PairId{1} << 60}) {
    EXPECT_FALSE(rules.find(id, pair)) << id;
  }
}

}  // namespace
}  // namespace volcontact::adaptor::pair_rules_test
