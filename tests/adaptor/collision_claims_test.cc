// SPDX-License-Identifier: Apache-2.0
#include "adaptor/collision_claims.h"

#include <gtest/gtest.h>

#include <set>

#include "adaptor/support/models.h"

namespace volcontact::adaptor::collision_claims_test {
namespace {

using testing::DataPointer;
using testing::ModelPointer;

// Two balls and a box on a floor, all touching it and, in a row, each other.
std::string scene(const std::string& custom, const std::string& more = "") {
  return "<mujoco><worldbody><geom name=\"floor\" type=\"plane\" size=\"1 1 1\"/>"
         "<body pos=\"0 0 .049\"><freejoint/><geom name=\"left\" type=\"sphere\" size=\".05\"/>"
         "</body><body pos=\".099 0 .049\"><freejoint/>"
         "<geom name=\"right\" type=\"sphere\" size=\".05\"/></body>"
         "<body pos=\".198 0 .049\"><freejoint/><geom name=\"box\" type=\"box\" "
         "size=\".05 .05 .05\"/></body></worldbody>" +
         more + "<custom>" + custom + "</custom></mujoco>";
}

std::string listed(const std::string& a, const std::string& b) {
  return "<tuple name=\"volcontact/pair/" + a + "_" + b +
         "\"><element objtype=\"geom\" objname=\"" + a +
         "\"/><element objtype=\"geom\" objname=\"" + b + "\"/></tuple>";
}

const std::string kListed = "<numeric name=\"volcontact/option/pairs/listed\" data=\"1\"/>";

std::set<std::pair<int, int>> native_pairs(const DataPointer& d) {
  std::set<std::pair<int, int>> pairs;
  for (int i = 0; i < d->ncon; ++i) {
    pairs.insert(std::minmax(d->contact[i].geom1, d->contact[i].geom2));
  }
  return pairs;
}

std::set<std::pair<int, int>> volumetric_pairs(const ModelPointer& m, const DataPointer& d) {
  volcontact_site sites[20];
  std::set<std::pair<int, int>> pairs;
  const int count = volcontact_sites(m.get(), d.get(), sites, 20);
  for (int i = 0; i < count; ++i) pairs.insert({sites[i].geom_a, sites[i].geom_b});
  return pairs;
}

TEST(CollisionClaims, ListedPairsAreVolumetricAndTheRestStaysNative) {
  const ModelPointer m =
      testing::load(scene(kListed + listed("floor", "left") + listed("right", "box")));
  const DataPointer d = testing::make_data(m);
  mj_forward(m.get(), d.get());
  auto rest = native_pairs(d);
  ASSERT_EQ(rest.size(), 5u);
  const std::set<std::pair<int, int>> claimed{{0, 1}, {2, 3}};
  for (const auto& pair : claimed) rest.erase(pair);
  {
    const testing::Attached attached(m);
    mj_forward(m.get(), d.get());
    EXPECT_EQ(native_pairs(d), rest);
    EXPECT_EQ(volumetric_pairs(m, d), claimed);
  }
  mj_forward(m.get(), d.get());
  EXPECT_EQ(native_pairs(d).size(), 5u);
}

TEST(CollisionClaims, ExplicitPairsCanBeClaimedToo) {
  const std::string pair =
      "<contact><pair geom1=\"left\" geom2=\"right\"/><pair geom1=\"right\" geom2=\"box\"/>"
      "</contact>";
  const ModelPointer m = testing::load(scene(kListed + listed("left", "right"), pair));
  const DataPointer d = testing::make_data(m);
  const testing::Attached attached(m);
  mj_forward(m.get(), d.get());
  EXPECT_FALSE(native_pairs(d).count({1, 2}));
  EXPECT_TRUE(native_pairs(d).count({2, 3}));
}

TEST(CollisionClaims, OtherModelsCollideAsBefore) {
  const ModelPointer m = testing::load(scene(kListed + listed("floor", "left")));
  const ModelPointer same = testing::load(scene(kListed + listed("floor", "left")));
  const DataPointer d = testing::make_data(same);
  const testing::Attached attached(m);
  mj_forward(same.get(), d.get());
  EXPECT_EQ(native_pairs(d).size(), 5u);
}

TEST(CollisionClaims, CopiesOfAnAttachedModelAreMixedToo) {
  const ModelPointer m = testing::load(scene(kListed + listed("floor", "left")));
  const testing::Attached attached(m);
  const ModelPointer copy(mj_copyModel(nullptr, m.get()));
  const DataPointer d = testing::make_data(copy);
  mj_forward(copy.get(), d.get());
  EXPECT_EQ(native_pairs(d).size(), 4u);
  EXPECT_GT(d->qfrc_applied[2], 0.0);
}

TEST(CollisionClaims, MixedSceneComesToRest) {
  // The left ball rests on volumetric contact, the right one on native contact.
  const ModelPointer m = testing::load(
      "<mujoco><worldbody><geom name=\"floor\" type=\"plane\" size=\"1 1 1\"/>"
      "<body pos=\"0 0 .05\"><freejoint/><geom name=\"left\" type=\"sphere\" size=\".05\" "
      "mass=\".1\"/></body><body pos=\".5 0 .05\"><freejoint/><geom name=\"right\" "
      "type=\"sphere\" size=\".05\" mass=\".1\"/></body></worldbody><custom>" +
      kListed + listed("floor", "left") + "</custom></mujoco>");
  const DataPointer d = testing::make_data(m);
  const testing::Attached attached(m);
  for (int i = 0; i < 3000; ++i) mj_step(m.get(), d.get());
  EXPECT_EQ(native_pairs(d), (std::set<std::pair<int, int>>{{0, 2}}));
  // Weight on each: by the generalized forces that hold them.
  EXPECT_NEAR(d->qfrc_applied[2], 0.981, 1e-3);
  EXPECT_NEAR(d->qfrc_constraint[8], 0.981, 1e-3);
}

}  // namespace
}  // namespace volcontact::adaptor::collision_claims_test
