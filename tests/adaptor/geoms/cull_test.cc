// SPDX-License-Identifier: Apache-2.0
#include "adaptor/geoms/pair_list.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <set>

#include "adaptor/geoms/solids_of_geoms.h"
#include "adaptor/support/models.h"

namespace volcontact::adaptor::pair_list_test {
namespace {

using Pairs = std::set<std::pair<int, int>>;

Pairs ours(const mjModel* m) {
  Pairs pairs;
  for (const GeomPair& pair : pairs_that_can_touch(m, read_scene_keys(m))) {
    EXPECT_LT(pair.a, pair.b);
    pairs.insert({pair.a, pair.b});
  }
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

TEST(PairList, RulesAreThoseOfMuJoCo) {
  const testing::ModelPointer m = testing::compile(pile(""));
  EXPECT_EQ(ours(m.get()), native(m));
}

TEST(PairList, ExcludedBodiesDoNotTouch) {
  const std::string exclude =
      "<contact><exclude body1=\"c\" body2=\"a\"/><exclude body1=\"b\" body2=\"c\"/>"
      "<exclude body1=\"world\" body2=\"c\"/></contact>";
  const testing::ModelPointer m = testing::compile(pile(exclude));
  EXPECT_EQ(ours(m.get()), native(m));
  EXPECT_LT(ours(m.get()).size(), ours(testing::compile(pile("")).get()).size());
}

TEST(PairList, ExplicitPairsTouchWhateverTheMasksSay) {
  const std::string pair =
      "<contact><pair geom1=\"ghost\" geom2=\"c\"/><pair geom1=\"a_child\" geom2=\"a1\"/>"
      "<exclude body1=\"c\" body2=\"b\"/></contact>";
  const testing::ModelPointer m = testing::compile(pile(pair));
  EXPECT_EQ(ours(m.get()), native(m));
}

TEST(PairList, ParentFilterCanBeOff) {
  const std::string option = "><flag filterparent=\"disable\"/></option><option ";
  const testing::ModelPointer m = testing::compile(pile("", option));
  EXPECT_EQ(ours(m.get()), native(m));
  EXPECT_GT(ours(m.get()).size(), ours(testing::compile(pile("")).get()).size());
}

TEST(PairList, ListedPairIsAddedToTheNativeOnes) {
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

TEST(PairList, ListedAloneWhenTheOptionSaysSo) {
  const std::string listed =
      "<custom><numeric name=\"volcontact/option/pairs/listed\" data=\"1\"/>"
      "<tuple name=\"volcontact/pair/p\"><element objtype=\"geom\" objname=\"ghost\"/>"
      "<element objtype=\"geom\" objname=\"c\"/></tuple></custom>";
  const testing::ModelPointer m = testing::compile(pile(listed));
  EXPECT_EQ(ours(m.get()).size(), 1u);
}

// Random poses of all shapes: whatever MuJoCo finds in contact must pass the cull.

constexpr const char* kShapes = R"(
<mujoco><size nconmax="500" njmax="2000"/><worldbody>
  <geom type="plane" size="1 1 1" euler="20 10 0"/>
  <body><freejoint/><geom type="sphere" size=".2"/></body>
  <body><freejoint/><geom type="capsule" size=".1 .3"/></body>
  <body><freejoint/><geom type="ellipsoid" size=".1 .2 .3"/></body>
  <body><freejoint/><geom type="cylinder" size=".15 .25"/></body>
  <body><freejoint/><geom type="box" size=".1 .2 .3"/></body>
  <body><freejoint/><geom type="box" size=".3 .02 .02"/></body>
</worldbody></mujoco>)";

class CullTest : public ::testing::Test {
 protected:
  CullTest() : m(testing::compile(kShapes)), d(testing::make_data(m)) {
    pairs = pairs_that_can_touch(m.get(), read_scene_keys(m.get()));
    for (int geom = 0; geom < m->ngeom; ++geom) solids.push_back(solid_of_geom(m.get(), geom));
  }
  void random_poses(std::mt19937& random) {
    std::normal_distribution<double> normal;
    for (int i = 0; i < m->nq; ++i) d->qpos[i] = (i % 7 < 3 ? 0.3 : 1.0) * normal(random);
    mj_forward(m.get(), d.get());
  }

  testing::ModelPointer m;
  testing::DataPointer d;
  std::vector<GeomPair> pairs;
  std::vector<Shape> solids;
  Cull::Scratch scratch;
};

TEST_F(CullTest, KeepsEveryPairThatTouches) {
  const Cull cull(pairs, solids);
  std::mt19937 random(7);
  int contacts = 0, left_out = 0;
  for (int trial = 0; trial < 300; ++trial) {
    random_poses(random);
    cull.run(d.get(), scratch);
    Pairs near;
    for (const int i : scratch.near) {
      const GeomPair& pair = pairs[static_cast<std::size_t>(i)];
      near.insert({pair.a, pair.b});
    }
    for (int i = 0; i < d->ncon; ++i) {
      if (d->contact[i].dist >= 0.0) continue;
      EXPECT_TRUE(near.count(std::minmax(d->contact[i].geom1, d->contact[i].geom2)));
      ++contacts;
    }
    left_out += static_cast<int>(pairs.size() - near.size());
  }
  EXPECT_GT(contacts, 300);
  EXPECT_GT(left_out, 300);
}

TEST_F(CullTest, LeavesOutPairsThatAreFarApart) {
  const Cull cull(pairs, solids);
  for (int i = 0; i < 6; ++i) {
    d->qpos[7 * i] = 3.0 * i;
    d->qpos[7 * i + 2] = 20.0;
  }
  mj_forward(m.get(), d.get());
  cull.run(d.get(), scratch);
  EXPECT_TRUE(scratch.near.empty());
}

TEST_F(CullTest, KeepsPosesThatAreNoNumbersForTheEngineToReport) {
  const Cull cull(pairs, solids);
  mj_forward(m.get(), d.get());
  d->geom_xpos[3] = std::numeric_limits<double>::quiet_NaN();
  cull.run(d.get(), scratch);
  int with_geom_1 = 0;
  for (const int i : scratch.near) {
    const GeomPair& pair = pairs[static_cast<std::size_t>(i)];
    with_geom_1 += pair.a == 1 || pair.b == 1;
  }
  EXPECT_EQ(with_geom_1, 6);
}

// So many pairs that they are swept, against the same in heaps of few, which are compared one by
// one.
TEST(Cull, SweptPairsAreThoseOfAComparisonOfAll) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform;
  std::string bodies = "<geom type=\"plane\" size=\"1 1 1\"/>";
  const char* shapes[] = {"type=\"sphere\" size=\".1\"", "type=\"box\" size=\".2 .05 .1\"",
                          "type=\"capsule\" size=\".05 .2\""};
  for (int i = 0; i < 90; ++i) {
    const std::string mask = i % 7 == 0 ? " contype=\"2\" conaffinity=\"2\"" : "";
    bodies += "<body><freejoint/><geom " + std::string(shapes[i % 3]) + mask + "/></body>";
  }
  const testing::ModelPointer m =
      testing::compile("<mujoco><worldbody>" + bodies + "</worldbody></mujoco>");
  const testing::DataPointer d = testing::make_data(m);
  const std::vector<GeomPair> pairs = pairs_that_can_touch(m.get(), read_scene_keys(m.get()));
  ASSERT_GT(pairs.size(), 2500u);
  std::vector<Shape> solids;
  for (int geom = 0; geom < m->ngeom; ++geom) solids.push_back(solid_of_geom(m.get(), geom));
  const Cull swept(pairs, solids);
  Cull::Scratch scratch, other;
  std::size_t found = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const double spread = trial % 2 == 0 ? 2.0 : 0.5;
    for (int i = 0; i < m->nq; ++i) {
      const double number = uniform(random) - 0.5;
      d->qpos[i] = trial % 10 > 6 ? d->qpos[i] + 0.01 * number : spread * number;
    }
    mj_forward(m.get(), d.get());
    if (trial % 50 == 49) d->geom_xpos[3 * 17 + 1] = std::numeric_limits<double>::quiet_NaN();
    swept.run(d.get(), scratch);
    std::vector<int> expected;
    constexpr std::size_t kHeap = 1000;
    for (std::size_t first = 0; first < pairs.size(); first += kHeap) {
      const std::vector<GeomPair> heap(
          pairs.begin() + static_cast<std::ptrdiff_t>(first),
          pairs.begin() + static_cast<std::ptrdiff_t>(std::min(first + kHeap, pairs.size())));
      Cull(heap, solids).run(d.get(), other);
      for (const int i : other.near) expected.push_back(i + static_cast<int>(first));
    }
    ASSERT_EQ(scratch.near, expected) << trial;
    found += expected.size();
  }
  EXPECT_GT(found, 1000u);
}

}  // namespace
}  // namespace volcontact::adaptor::pair_list_test
