// SPDX-License-Identifier: Apache-2.0
#include "adaptor/geoms/flush_groups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>

#include "adaptor/geoms/solids_of_geoms.h"
#include "adaptor/support/models.h"

namespace volcontact::adaptor::flush_groups_test {
namespace {

// The groups of a world with a ball in it.
class Scene {
 public:
  explicit Scene(const std::string& world, const std::string& more = "")
      : m(testing::compile("<mujoco><worldbody>" + world +
                           R"(<body name="ball" pos="0 0 9"><freejoint/>
        <geom name="ball" type="sphere" size=".1"/></body></worldbody>)" +
                           more + "</mujoco>")),
        keys(read_scene_keys(m.get())),
        rules(m.get(), keys) {
    for (int geom = 0; geom < m->ngeom; ++geom) {
      solids.push_back(simple_solid(m.get(), geom, keys));
    }
    groups = FlushGroups(m.get(), keys, solids, rules);
  }
  int geom(const char* name) const { return mj_name2id(m.get(), mjOBJ_GEOM, name); }
  std::size_t tiles() const {
    std::size_t count = 0;
    for (const auto& group : groups.groups()) count += group.size();
    return count;
  }

  testing::ModelPointer m;
  SceneKeys keys;
  PairRules rules;
  std::vector<Shape> solids;
  FlushGroups groups;
};

std::string box(const std::string& name, const std::string& pos, const std::string& more = "",
                const std::string& size = ".5 .5 .1") {
  return "<geom name=\"" + name + "\" type=\"box\" size=\"" + size + "\" pos=\"" + pos + "\" " +
         more + "/>";
}

TEST(FlushGroups, TilesOfTheWorldAreOneGroup) {
  const Scene scene(box("a", "0 0 0") + box("b", "1 0 0") + box("c", "1 1 0") +
                    box("far", "5 0 0"));
  ASSERT_EQ(scene.groups.groups().size(), 1u);
  EXPECT_EQ(scene.tiles(), 3u);
  EXPECT_FALSE(scene.groups.is_tile(scene.geom("far")));
  EXPECT_EQ(scene.groups.frame_of(scene.geom("far")), scene.geom("far"));
  for (const char* name : {"a", "b", "c"}) {
    EXPECT_TRUE(scene.groups.is_tile(scene.geom(name)));
    EXPECT_EQ(scene.groups.frame_of(scene.geom(name)), scene.geom("a"));
  }
  EXPECT_EQ(scene.groups.bounds(scene.geom("c")).min, Vec3(0.5, 0.5, -0.1));
  EXPECT_EQ(scene.groups.largest_face(scene.geom("b")), 4.0);
}

// They are sought along the axis on which they are spread most.
TEST(FlushGroups, RowsAlongAnyAxisAreOneGroup) {
  for (int axis = 0; axis < 3; ++axis) {
    std::string row;
    for (int i = 0; i < 40; ++i) {
      Vec3 at = Vec3::Zero();
      at[axis] = (axis == 2 ? 0.2 : 1.0) * (7 * i % 40);
      std::ostringstream place;
      place << at;
      row += box(std::to_string(i), place.str());
    }
    const Scene scene(row);
    ASSERT_EQ(scene.groups.groups().size(), 1u) << axis;
    EXPECT_EQ(scene.tiles(), 40u);
  }
}

TEST(FlushGroups, EndsInOnePlaneAreTheSameNumber) {
  // Places that no binary number has, and a seam that misses by rounding.
  const Scene scene(box("a", "0.1 0 0") + box("b", "1.1000000000000003 0 1e-17") +
                    box("c", "2.1 0 0"));
  ASSERT_EQ(scene.tiles(), 3u);
  const auto& groups = scene.groups;
  EXPECT_EQ(groups.bounds(scene.geom("a")).max.x(), groups.bounds(scene.geom("b")).min.x());
  EXPECT_EQ(groups.bounds(scene.geom("b")).max.x(), groups.bounds(scene.geom("c")).min.x());
  EXPECT_EQ(groups.bounds(scene.geom("a")).max.z(), groups.bounds(scene.geom("b")).max.z());
}

TEST(FlushGroups, AGapOfABillionthIsNone) {
  EXPECT_EQ(Scene(box("a", "0 0 0") + box("b", "1.0000000005 0 0")).tiles(), 2u);
  EXPECT_EQ(Scene(box("a", "0 0 0") + box("b", "1.000000005 0 0")).tiles(), 0u);
}

TEST(FlushGroups, OnlyWhatContinuesEachOther) {
  const auto tiles_beside = [](const std::string& other) {
    return Scene(box("a", "0 0 0") + other).tiles();
  };
  EXPECT_EQ(tiles_beside(box("b", "1 0 0")), 2u);
  EXPECT_EQ(tiles_beside(box("b", "1 0 0.05")), 2u) << "their sides are flush";
  EXPECT_EQ(tiles_beside(box("b", "1 0.2 0.05")), 0u) << "a step in both directions";
  EXPECT_EQ(tiles_beside(box("b", "1 1 0")), 0u) << "an edge is no seam";
  EXPECT_EQ(tiles_beside(box("b", "0 0 .4", "", ".2 .2 .3")), 0u) << "a block on it";
  EXPECT_EQ(tiles_beside(box("b", "1 0 0", "euler=\"0 0 90\"")), 2u) << "quarter turns";
  EXPECT_EQ(tiles_beside(box("b", "1 0 0", "euler=\"0 0 30\"")), 0u);
  EXPECT_EQ(tiles_beside(box("b", "1 0 0", "friction=\".3\"")), 0u) << "another surface";
  EXPECT_EQ(tiles_beside(box("b", "0.7 0 0")), 2u) << "overlapping";
  EXPECT_EQ(tiles_beside("<geom name=\"b\" type=\"cylinder\" size=\".5 .1\" pos=\"1 0 0\"/>"), 0u);
}

TEST(FlushGroups, OnlyBodiesThatCannotMoveAgainstEachOther) {
  const auto on = [](const std::string& attributes, const std::string& inner) {
    return "<body pos=\"1 0 0\" " + attributes + ">" + inner + box("b", "0 0 0") + "</body>";
  };
  const auto tiles_with = [](const std::string& body) {
    return Scene(box("a", "0 0 0") + body).tiles();
  };
  EXPECT_EQ(tiles_with(on("", "")), 2u) << "static";
  EXPECT_EQ(tiles_with(on("", "<joint type=\"slide\"/>")), 0u);
  EXPECT_EQ(tiles_with(on("mocap=\"true\"", "")), 0u);
  const std::string turned = "<body pos=\"0 1 0\" euler=\"0 0 90\"><body pos=\"-1 -1 0\">" +
                             box("b", "0 0 0") + "</body></body>";
  EXPECT_EQ(tiles_with(turned), 2u) << "by way of two bodies";
  const std::string slab = "<body pos=\"0 0 5\"><freejoint/>" + box("c", "0 0 0") +
                           "<body pos=\"1 0 0\">" + box("d", "0 0 0") + "</body></body>";
  EXPECT_EQ(tiles_with(slab), 2u) << "welded, and moving together";
  const std::string mocap =
      "<body pos=\"0 0 5\" mocap=\"true\">" + box("c", "0 0 0") + box("d", "1 0 0") + "</body>";
  EXPECT_EQ(tiles_with(mocap), 2u);
}

TEST(FlushGroups, FamiliesAreWhatTouchesTheSameSolids) {
  const Scene scene(box("a", "0 0 0") + box("b", "1 0 0") + "<body pos=\"0 0 5\"><freejoint/>" +
                    box("c", "0 0 0") + box("d", "1 0 0") + "</body>");
  std::map<PairId, int> sizes;
  scene.rules.for_each([&](const GeomPair& pair) {
    const FlushGroups::Family family = scene.groups.family_of(pair);
    ++sizes[family.number];
    EXPECT_FALSE(family.swapped);
    return true;
  });
  std::multiset<int> found;
  for (const auto& [family, size] : sizes) found.insert(size);
  // Ball with floor, floor with slab, ball with slab.
  EXPECT_EQ(found, (std::multiset<int>{2, 2, 4}));
}

TEST(FlushGroups, SidesOfAFamilyAreInOneOrder) {
  // A tile before the ball, and one behind it.
  const testing::ModelPointer m =
      testing::compile("<mujoco><worldbody>" + box("a", "0 0 0") +
                       "<body pos=\"0 0 9\"><freejoint/><geom name=\"ball\" size=\".1\"/></body>"
                       "<body>" +
                       box("b", "1 0 0") + "</body></worldbody></mujoco>");
  const SceneKeys keys = read_scene_keys(m.get());
  const PairRules rules(m.get(), keys);
  ASSERT_EQ(rules.count(), 2u);
  std::vector<Shape> solids;
  for (int geom = 0; geom < m->ngeom; ++geom) solids.push_back(simple_solid(m.get(), geom, keys));
  const FlushGroups groups(m.get(), keys, solids, rules);
  GeomPair first, second;
  ASSERT_TRUE(rules.admit(0, 1, first) && rules.admit(1, 2, second));
  EXPECT_GE(groups.family_of(first).number, 0);
  EXPECT_EQ(groups.family_of(first).number, groups.family_of(second).number);
  EXPECT_NE(groups.family_of(first).swapped, groups.family_of(second).swapped);
}

TEST(FlushGroups, AFamilyWithAPairOfItsOwnIsNone) {
  const auto are_touched_together = [](const std::string& tiles, const std::string& more = "") {
    const Scene scene(tiles, more);
    EXPECT_EQ(scene.tiles(), 2u);
    return scene.groups.can_touch_together(scene.groups.groups().front());
  };
  const std::string tiles = box("a", "0 0 0") + box("b", "1 0 0");
  EXPECT_TRUE(are_touched_together(tiles));
  EXPECT_FALSE(are_touched_together(
      tiles,
      "<contact><pair geom1=\"a\" geom2=\"ball\" friction=\".1 .1 .005 .0001 .0001\"/>"
      "</contact>"));
  // A second ball has one all the same.
  EXPECT_TRUE(are_touched_together(
      tiles + "<body pos=\"0 0 5\"><freejoint/><geom size=\".1\"/></body>",
      "<contact><pair geom1=\"a\" geom2=\"ball\" friction=\".1 .1 .005 .0001 .0001\"/>"
      "</contact>"));
  // One ball for each tile.
  EXPECT_FALSE(are_touched_together(box("a", "0 0 0") +
                                    box("b", "1 0 0", "contype=\"2\" conaffinity=\"2\"") +
                                    "<body pos=\"0 0 5\"><freejoint/><geom size=\".1\" "
                                    "contype=\"2\" conaffinity=\"2\"/></body>"));
}

}  // namespace
}  // namespace volcontact::adaptor::flush_groups_test
