// SPDX-License-Identifier: Apache-2.0
#include "adaptor/geoms/cull.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <set>

#include "adaptor/geoms/solids_of_geoms.h"
#include "adaptor/support/models.h"

namespace volcontact::adaptor::cull_test {
namespace {

using Pairs = std::set<std::pair<int, int>>;

std::vector<Shape> solids_of(const mjModel* m) {
  std::vector<Shape> solids;
  for (int geom = 0; geom < m->ngeom; ++geom) solids.push_back(solid_of_geom(m, geom));
  return solids;
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
  CullTest()
      : m(testing::compile(kShapes)),
        d(testing::make_data(m)),
        rules(m.get(), read_scene_keys(m.get())),
        solids(solids_of(m.get())) {}
  void random_poses(std::mt19937& random) {
    std::normal_distribution<double> normal;
    for (int i = 0; i < m->nq; ++i) d->qpos[i] = (i % 7 < 3 ? 0.3 : 1.0) * normal(random);
    mj_forward(m.get(), d.get());
  }

  testing::ModelPointer m;
  testing::DataPointer d;
  Pairs near() const {
    Pairs found;
    GeomPair pair;
    for (const PairId id : scratch.near) {
      EXPECT_TRUE(rules.find(id, pair));
      found.insert({pair.a, pair.b});
    }
    return found;
  }

  PairRules rules;
  std::vector<Shape> solids;
  Cull::Scratch scratch;
};

TEST_F(CullTest, KeepsEveryPairThatTouches) {
  const Cull cull(rules, solids);
  std::mt19937 random(7);
  int contacts = 0, left_out = 0;
  for (int trial = 0; trial < 300; ++trial) {
    random_poses(random);
    cull.run(d.get(), scratch);
    const Pairs near = this->near();
    for (int i = 0; i < d->ncon; ++i) {
      if (d->contact[i].dist >= 0.0) continue;
      EXPECT_TRUE(near.count(std::minmax(d->contact[i].geom1, d->contact[i].geom2)));
      ++contacts;
    }
    left_out += static_cast<int>(rules.count() - near.size());
  }
  EXPECT_GT(contacts, 300);
  EXPECT_GT(left_out, 300);
}

TEST_F(CullTest, LeavesOutPairsThatAreFarApart) {
  const Cull cull(rules, solids);
  for (int i = 0; i < 6; ++i) {
    d->qpos[7 * i] = 3.0 * i;
    d->qpos[7 * i + 2] = 20.0;
  }
  mj_forward(m.get(), d.get());
  cull.run(d.get(), scratch);
  EXPECT_TRUE(scratch.near.empty());
}

TEST_F(CullTest, KeepsPosesThatAreNoNumbersForTheEngineToReport) {
  const Cull cull(rules, solids);
  mj_forward(m.get(), d.get());
  d->geom_xpos[3] = std::numeric_limits<double>::quiet_NaN();
  cull.run(d.get(), scratch);
  int with_geom_1 = 0;
  for (const auto& [a, b] : near()) with_geom_1 += a == 1 || b == 1;
  EXPECT_EQ(with_geom_1, 6);
}

// Bodies of all kinds in a heap, in a world of solids that do not move, with planes, masks, an
// exclude, a <pair> and a volcontact/pair: so many that they are swept.
std::string heap() {
  const char* shapes[] = {"type=\"sphere\" size=\".1\"", "type=\"box\" size=\".2 .05 .1\"",
                          "type=\"capsule\" size=\".05 .2\""};
  std::string world =
      "<geom type=\"plane\" size=\"1 1 1\" pos=\"0 0 -.4\"/>"
      "<body mocap=\"true\" name=\"hand\" pos=\"0 0 .2\"><geom type=\"box\" size=\".2 .1 "
      ".3\"/></body>"
      "<body mocap=\"true\"><geom type=\"plane\" size=\"1 1 1\" pos=\"0 0 -.3\" contype=\"2\" "
      "conaffinity=\"2\"/></body>";
  for (int i = 0; i < 120; ++i) {
    const std::string mask = i % 7 == 0 ? " contype=\"2\" conaffinity=\"2\"" : "";
    const std::string number = std::to_string(i);
    const std::string geom = "<geom name=\"g" + number + "\" " + std::string(shapes[i % 3]) + mask;
    if (i % 4 == 3) {
      world += geom + " pos=\"" + std::to_string(.02 * i - 1.2) + " " +
               std::to_string(.3 * (i % 5) - .6) + " " + std::to_string(.1 * (i % 9) - .4) + "\"/>";
    } else {
      world += "<body name=\"b" + number + "\"><freejoint/>" + geom + "/></body>";
    }
  }
  return "<mujoco><worldbody>" + world +
         "</worldbody><contact><exclude body1=\"b0\" body2=\"b14\"/>"
         "<pair geom1=\"g7\" geom2=\"g1\"/></contact><custom><tuple name=\"volcontact/pair/p\">"
         "<element objtype=\"geom\" objname=\"g14\"/><element objtype=\"geom\" objname=\"g11\"/>"
         "</tuple></custom></mujoco>";
}

// What a comparison of all leaves, with the bounds of each solid made for it.
std::vector<PairId> compared(const PairRules& rules, const std::vector<Shape>& solids,
                             const mjData* d) {
  std::vector<PairId> near;
  rules.for_each([&](const GeomPair& pair) {
    const auto solid = [&](int geom) { return solids[static_cast<std::size_t>(geom)]; };
    int a = pair.a, b = pair.b;
    if (std::holds_alternative<HalfSpace>(solid(b))) std::swap(a, b);
    const Pose X_WA = pose_of_geom(d, a), X_WB = pose_of_geom(d, b);
    bool apart = false;
    if (std::holds_alternative<HalfSpace>(solid(a))) {
      const Vec3 normal = X_WA.rotation.col(2), down = -(X_WB.rotation.transpose() * normal);
      const double reach =
          std::visit([&](const auto& s) { return s.support_height(down); }, solid(b));
      apart = normal.dot(X_WB.translation - X_WA.translation) >= reach;
    } else {
      apart = are_apart(world_bounds(solid(a), X_WA), world_bounds(solid(b), X_WB));
    }
    if (!apart) near.push_back(rules.id(a, b));
    return true;
  });
  return near;
}

TEST(Cull, SweptPairsAreThoseOfAComparisonOfAll) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform;
  const testing::ModelPointer m = testing::compile(heap());
  const testing::DataPointer d = testing::make_data(m);
  const PairRules rules(m.get(), read_scene_keys(m.get()));
  ASSERT_GT(rules.count(), 4000u);
  const std::vector<Shape> solids = solids_of(m.get());
  const Cull swept(rules, solids);
  Cull::Scratch scratch;
  std::size_t found = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const double spread = trial % 2 == 0 ? 2.0 : 0.5;
    for (int i = 0; i < m->nq; ++i) {
      const double number = uniform(random) - 0.5;
      d->qpos[i] = trial % 10 > 6 ? d->qpos[i] + 0.01 * number : spread * number;
    }
    d->mocap_pos[2] = uniform(random);
    if (trial % 40 == 39) m->geom_pos[3 * (m->ngeom - 1)] += 0.3;  // of the world
    mj_forward(m.get(), d.get());
    if (trial % 50 == 49) d->geom_xpos[3 * 17 + 1] = std::numeric_limits<double>::quiet_NaN();
    swept.run(d.get(), scratch);
    ASSERT_EQ(scratch.near, compared(rules, solids, d.get())) << trial;
    found += scratch.near.size();
  }
  EXPECT_GT(found, 1000u);
}

// One body of many geoms, of which none can touch another, slides and turns in steps through a
// world of solids.
TEST(Cull, OneBodyMeetsItsWorld) {
  std::string world, body = "<body><freejoint/>";
  for (int i = 0; i < 60; ++i) {
    world += "<geom type=\"box\" size=\".1 .2 .05\" pos=\"" + std::to_string(.15 * (i % 12)) + " " +
             std::to_string(.3 * (i / 12)) + " 0\"/>";
  }
  for (int i = 0; i < 8; ++i) {
    body += "<geom type=\"box\" size=\".1 .1 .1\" pos=\"" + std::to_string(.15 * i) + " 0 0\"/>";
  }
  const testing::ModelPointer m =
      testing::compile("<mujoco><worldbody>" + world + body + "</body></worldbody></mujoco>");
  const testing::DataPointer d = testing::make_data(m);
  const PairRules rules(m.get(), read_scene_keys(m.get()));
  ASSERT_EQ(rules.count(), 480u);
  const std::vector<Shape> solids = solids_of(m.get());
  const Cull cull(rules, solids);
  Cull::Scratch scratch;
  std::size_t found = 0;
  for (int step = 0; step < 300; ++step) {
    d->qpos[0] = 0.005 * step;
    d->qpos[1] = 0.6 + 0.4 * std::sin(0.02 * step);
    d->qpos[2] = 0.3 * std::cos(0.03 * step);
    d->qpos[3] = std::cos(0.01 * step);
    d->qpos[5] = std::sin(0.01 * step);
    mj_kinematics(m.get(), d.get());
    cull.run(d.get(), scratch);
    ASSERT_EQ(scratch.near, compared(rules, solids, d.get())) << step;
    found += scratch.near.size();
  }
  EXPECT_GT(found, 1000u);
}

// Memory that another scene left is that of another scene.
TEST(Cull, ScratchServesScenesInTurn) {
  const testing::ModelPointer one = testing::compile(heap()), two = testing::compile(heap());
  for (int i = 0; i < 3 * two->ngeom; ++i) two->geom_size[i] *= 1.5;
  Cull::Scratch scratch;
  std::vector<std::vector<PairId>> near;
  for (const auto& m : {one.get(), two.get(), one.get()}) {
    const std::unique_ptr<mjData, void (*)(mjData*)> d(mj_makeData(m), mj_deleteData);
    mj_forward(m, d.get());
    const PairRules rules(m, read_scene_keys(m));
    const std::vector<Shape> solids = solids_of(m);
    Cull(rules, solids).run(d.get(), scratch);
    EXPECT_EQ(scratch.near, compared(rules, solids, d.get()));
    near.push_back(scratch.near);
  }
  EXPECT_EQ(near[0], near[2]);
  EXPECT_NE(near[0], near[1]);
}

}  // namespace
}  // namespace volcontact::adaptor::cull_test
