// SPDX-License-Identifier: Apache-2.0
#include "adaptor/geoms/fixed_solids.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>
#include <utility>

#include "adaptor/geoms/solids_of_geoms.h"
#include "adaptor/mujoco/mjgeoms.h"
#include "adaptor/support/models.h"

namespace volcontact::adaptor::fixed_solids_test {
namespace {

// Boxes, flat or long, a sphere between them, and one geom between that is not asked for.
std::string world(int count, const char* box) {
  std::string geoms;
  for (int i = 0; i < count; ++i) {
    const std::string shape = i % 5 == 4 ? "type=\"sphere\" size=\".1\"" : box;
    geoms += "<geom " + shape + " pos=\"" + std::to_string(.3 * (i % 25)) + " " +
             std::to_string(.3 * (i / 25)) + " 0\" euler=\"" + std::to_string(7 * i) + " 0 0\"/>";
  }
  return "<mujoco><worldbody>" + geoms + "</worldbody></mujoco>";
}

class FixedSolidsTest : public ::testing::TestWithParam<const char*> {
 protected:
  FixedSolidsTest() : m(testing::compile(world(600, GetParam()))), d(testing::make_data(m)) {
    mj_forward(m.get(), d.get());
    for (int geom = 0; geom < m->ngeom; ++geom) {
      solids.push_back(solid_of_geom(m.get(), geom));
      if (geom != 300) geoms.push_back(geom);
    }
  }

  Bounds box_of(int geom) const {
    return world_bounds(solids[static_cast<std::size_t>(geom)], pose_of_geom(d.get(), geom));
  }
  std::vector<int> met(const FixedSolids& fixed, const Bounds& with, std::size_t asker = 0) {
    std::vector<int> found;
    fixed.meet(d.get(), asker, with, kept, [&](int geom, const Bounds&) { found.push_back(geom); });
    std::sort(found.begin(), found.end());
    return found;
  }
  std::vector<int> expected(const Bounds& with) const {
    std::vector<int> found;
    for (const int geom : geoms) {
      if (!are_apart(with, box_of(geom))) found.push_back(geom);
    }
    return found;
  }

  testing::ModelPointer m;
  testing::DataPointer d;
  std::vector<Shape> solids;
  std::vector<int> geoms;
  FixedSolids::Kept kept;
};

// Whatever a program moves, turns or spoils between calls, the same are met as in a comparison of
// all with their present bounds.
TEST_P(FixedSolidsTest, MeetsThoseWhosePresentBoundsMeet) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform;
  const FixedSolids fixed(solids, geoms);
  std::size_t found = 0;
  for (int call = 0; call < 60; ++call) {
    const int geom = static_cast<int>(uniform(random) * 600);
    if (call % 3 == 1) {
      mjtNum quaternion[4] = {uniform(random), uniform(random), uniform(random), uniform(random)};
      mju_normalize4(quaternion);
      mju_quat2Mat(d->geom_xmat + 9 * geom, quaternion);
    }
    if (call % 10 == 5) d->geom_xpos[3 * geom + 1] += 1.0;
    if (call == 50) d->geom_xpos[3 * geom] = std::numeric_limits<double>::quiet_NaN();
    fixed.follow(d.get(), kept);
    for (int trial = 0; trial < 20; ++trial) {
      // Those around the geom that was turned, and some elsewhere.
      const Vec3 at = trial < 10 ? Vec3(vec3_at(d->geom_xpos, geom))
                                 : Vec3(7.5 * uniform(random), 7.5 * uniform(random), 0.0);
      const Pose X_WS{Mat3::Identity(),
                      at + 0.3 * Vec3(uniform(random), uniform(random), uniform(random))};
      const Bounds with = world_bounds(Sphere({.radius = 0.1}), X_WS);
      ASSERT_EQ(met(fixed, with), expected(with)) << call;
      found += met(fixed, with).size();
    }
  }
  EXPECT_GT(found, 600u);
}

// What was found for wider bounds serves while these hold, and no longer than nothing has moved.
TEST_P(FixedSolidsTest, WhoMovesLittleMeetsWhatItComesTo) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform;
  const FixedSolids fixed(solids, geoms);
  Vec3 at[2] = {Vec3(1.0, 1.0, 0.0), Vec3(4.0, 3.0, 0.1)};
  int changes = 0, kept_around = 0;
  std::vector<int> last;
  for (int call = 0; call < 1600; ++call) {
    if (call % 400 == 399) d->geom_xpos[3 * (call / 8) + 1] += 0.5;
    fixed.follow(d.get(), kept);
    for (std::size_t asker = 0; asker < 2; ++asker) {
      at[asker] += 0.001 * Vec3(uniform(random), uniform(random), uniform(random) - 0.5);
      const Bounds with = world_bounds(Sphere({.radius = 0.1}), {Mat3::Identity(), at[asker]});
      const double before = kept.near.size() > asker ? kept.near[asker].around.low(0) : 0.0;
      const std::vector<int> found = met(fixed, with, asker);
      ASSERT_EQ(found, expected(with)) << call;
      kept_around += kept.near.size() > asker && kept.near[asker].around.low(0) == before;
      if (asker == 0) changes += std::exchange(last, found) != found;
    }
  }
  EXPECT_GT(changes, 3);
  EXPECT_TRUE(kept.may_turn || kept_around > 2000) << kept_around;
}

// Long ones reach so far when they turn that their tree is that of their present bounds.
TEST_P(FixedSolidsTest, LongSolidsAreComparedAtOnce) {
  const FixedSolids fixed(solids, geoms);
  fixed.follow(d.get(), kept);
  EXPECT_EQ(kept.may_turn, std::string(GetParam()).find("3 .02") == std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Shapes, FixedSolidsTest,
                         ::testing::Values("type=\"box\" size=\".1 .15 .05\"",
                                           "type=\"box\" size=\"3 .02 .02\""));

TEST_P(FixedSolidsTest, WhatAnotherLeftIsNotTaken) {
  const FixedSolids fixed(solids, geoms);
  std::vector<Shape> larger(solids.size(), Sphere({.radius = 0.4}));
  const FixedSolids others(larger, geoms);
  const Bounds with = box_of(7);
  fixed.follow(d.get(), kept);
  const std::vector<int> before = met(fixed, with);
  others.follow(d.get(), kept);
  EXPECT_GT(met(others, with).size(), before.size());
  fixed.follow(d.get(), kept);
  EXPECT_EQ(met(fixed, with), before);
}

}  // namespace
}  // namespace volcontact::adaptor::fixed_solids_test
