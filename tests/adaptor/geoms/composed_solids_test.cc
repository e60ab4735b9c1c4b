// SPDX-License-Identifier: Apache-2.0
// volcontact/solid/...: from the tuple to the forces.
#include <gtest/gtest.h>

#include "adaptor/scene/scene_contact.h"
#include "adaptor/scene_registry.h"
#include "adaptor/support/models.h"

namespace volcontact::adaptor::composed_solids_test {
namespace {

using testing::DataPointer;
using testing::ModelPointer;

std::string part(const std::string& geom, const std::string& prm) {
  return "<element objtype=\"geom\" objname=\"" + geom + "\" prm=\"" + prm + "\"/>";
}

// A block with a bore of 20 mm through it, its top at z = 0, and a ball or peg above.
std::string scene(const std::string& solids, const std::string& body,
                  const std::string& keys = "") {
  return "<mujoco><option timestep=\"1e-3\"/><worldbody>"
         "<geom name=\"floor\" type=\"plane\" size=\"1 1 1\" pos=\"0 0 -1\"/>"
         "<body name=\"fixture\">"
         "<geom name=\"block\" type=\"box\" size=\".1 .1 .05\" pos=\"0 0 -.05\"/>"
         "<geom name=\"hole\" type=\"cylinder\" size=\".02 .2\" pos=\"0 0 -.05\"/>"
         "<geom name=\"post\" type=\"sphere\" size=\".01\" pos=\".3 0 0\"/></body>" +
         body + "</worldbody><custom>" + solids + keys +
         "<numeric name=\"volcontact/material/all/stiffness\" data=\"1e8\"/>"
         "<numeric name=\"volcontact/material/all/damping\" data=\"2\"/>"
         "<tuple name=\"volcontact/material/all\"><element objtype=\"body\" objname=\"fixture\"/>"
         "<element objtype=\"body\" objname=\"thing\"/></tuple></custom></mujoco>";
}

std::string bored() {
  return "<tuple name=\"volcontact/solid/bored\">" + part("block", "1") + part("hole", "-1") +
         "</tuple>";
}
std::string ball() {
  return "<body name=\"thing\" pos=\"0 0 .025\"><freejoint/>"
         "<geom name=\"thing\" type=\"sphere\" size=\".03\" density=\"8000\"/></body>";
}
std::string peg() {
  return "<body name=\"thing\" pos=\"0 0 .01\"><freejoint/>"
         "<geom name=\"thing\" type=\"cylinder\" size=\".0198 .04\"/></body>";
}

std::string message_of(const std::string& mjcf) {
  try {
    read_scene_keys(testing::compile(mjcf).get());
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

std::string message_of_solid(const std::string& parts) {
  return message_of(scene("<tuple name=\"volcontact/solid/bored\">" + parts + "</tuple>", ball()));
}

TEST(ComposedSolids, TupleNamesPartsInOrder) {
  const ModelPointer m = testing::compile(scene(bored(), ball()));
  const SceneKeys keys = read_scene_keys(m.get());
  ASSERT_EQ(keys.solids.size(), 1u);
  const int block = mj_name2id(m.get(), mjOBJ_GEOM, "block");
  const int hole = mj_name2id(m.get(), mjOBJ_GEOM, "hole");
  ASSERT_EQ(keys.solids[0].parts.size(), 2u);
  EXPECT_EQ(keys.solids[0].parts[0].geom, block);
  EXPECT_EQ(keys.solids[0].parts[0].operation, Csg::Operation::kUnion);
  EXPECT_EQ(keys.solids[0].parts[1].operation, Csg::Operation::kDifference);
  EXPECT_TRUE(keys.is_solid(block));
  EXPECT_FALSE(keys.is_solid(hole));
}

TEST(ComposedSolids, ErrorsSayWhatWhereAndTheFix) {
  EXPECT_EQ(message_of_solid(part("block", "1") + part("hole", "0")),
            "volcontact/solid/bored: geom 'hole' has prm=\"0\"; write prm=\"1\" to add it, "
            "prm=\"-1\" to cut it out or prm=\"2\" to keep only what lies in it");
  EXPECT_EQ(message_of_solid(part("hole", "-1") + part("block", "1")),
            "volcontact/solid/bored: geom 'hole' is the first one and has not prm=\"1\": there "
            "is nothing yet to cut; begin with a geom that has prm=\"1\"");
  EXPECT_EQ(
      message_of_solid(part("block", "1") + part("thing", "-1")),
      "volcontact/solid/bored: geom 'thing' is on body 'thing' and 'block' on body 'fixture'; "
      "the geoms of a solid must be on one body: move it there");
  EXPECT_EQ(message_of_solid(part("block", "1") + part("block", "-1")),
            "volcontact/solid/bored: geom 'block' is listed already, in volcontact/solid/bored; a "
            "geom belongs to one solid, once");
  EXPECT_EQ(message_of(scene(bored() + "<tuple name=\"volcontact/solid/other\">" +
                                 part("post", "1") + part("hole", "-1") + "</tuple>",
                             ball())),
            "volcontact/solid/other: geom 'hole' is listed already, in volcontact/solid/bored; a "
            "geom belongs to one solid, once");
  EXPECT_EQ(message_of_solid(part("block", "1") + part("floor", "-1")),
            "volcontact/solid/bored: geom 'floor' is a plane; cut with a box that is large enough "
            "instead");
  EXPECT_EQ(message_of_solid("<element objtype=\"body\" objname=\"fixture\" prm=\"1\"/>"),
            "volcontact/solid/bored: element 1 is a body; a solid lists its geoms one by one");
  EXPECT_EQ(message_of(scene(bored(), ball(),
                             "<tuple name=\"volcontact/pair/p\">" + part("hole", "0") +
                                 part("thing", "0") + "</tuple>")),
            "volcontact/pair/p: geom 'hole' is a part of volcontact/solid/bored, which is named by "
            "its first geom; list 'block'");
  EXPECT_EQ(message_of(scene(bored(), ball(),
                             "<numeric name=\"volcontact/solid/bored/size\" data=\"1\"/>")),
            "volcontact/solid/bored/size: a solid has no numbers; its geoms are listed in a "
            "<tuple>, with prm=\"1\", \"-1\" or \"2\"");
}

TEST(ComposedSolids, PartsTouchNothingByThemselves) {
  const ModelPointer m = testing::compile(scene(bored(), ball()));
  const SceneContact contact(m.get());
  const int hole = mj_name2id(m.get(), mjOBJ_GEOM, "hole");
  EXPECT_GT(contact.rules().count(), 0u);
  EXPECT_FALSE(contact.rules().can_touch(hole));
}

// The block's volume less that of the bore.
TEST(ComposedSolids, SolidStandsInTheFrameOfItsFirstGeom) {
  const ModelPointer m = testing::compile(scene(bored(), ball()));
  const SceneContact contact(m.get());
  const int block = mj_name2id(m.get(), mjOBJ_GEOM, "block");
  const Shape& solid = contact.solids()[static_cast<std::size_t>(block)];
  EXPECT_NEAR(own_metrics_of(solid).volume, .2 * .2 * .1 - kPi * 4e-4 * .1, 1e-15);
  EXPECT_NEAR(own_metrics_of(solid).centroid.norm(), 0.0, 1e-15);
}

// What a ball of 30 mm whose centre is z over a rim of 20 mm sinks into the block: the ring between
// the wall of the bore and where the ball leaves the top.
double ring_volume(double z) {
  const auto primitive = [&](double rho) {
    return -kPi * rho * rho * z - 2.0 / 3.0 * kPi * std::pow(.03 * .03 - rho * rho, 1.5);
  };
  return primitive(std::sqrt(.03 * .03 - z * z)) - primitive(.02);
}

// At rest k V = m g, with the two materials in series. The spring is soft: it sinks in by 1.6 mm.
// Without friction, whose explicit step would rattle here.
TEST(ComposedSolids, BallRestsInTheMouthOfTheBore) {
  const ModelPointer m = testing::load(
      scene(bored(), ball(), "<numeric name=\"volcontact/material/all/friction\" data=\"0\"/>"));
  const testing::Attached attached(m);
  const DataPointer d = testing::make_data(m);
  for (int i = 0; i < 1500; ++i) mj_step(m.get(), d.get());
  const double weight = 8000.0 * 4.0 / 3.0 * kPi * .03 * .03 * .03 * -m->opt.gravity[2];
  EXPECT_NEAR(0.5e8 * ring_volume(d->qpos[2]), weight, 1e-4 * weight);
  EXPECT_NEAR(d->qpos[0], 0.0, 1e-4);
  EXPECT_LT(std::abs(d->qvel[2]), 1e-4);
}

// Clearance 0.2 mm all round: nothing touches, so it falls as in vacuum.
TEST(ComposedSolids, AlignedPegFallsFreelyThroughTheBore) {
  const ModelPointer m = testing::load(scene(bored(), peg()));
  const testing::Attached attached(m);
  const DataPointer d = testing::make_data(m);
  const double start = d->qpos[2], g = -m->opt.gravity[2];
  const int steps = 200;
  for (int i = 0; i < steps; ++i) mj_step(m.get(), d.get());
  // Semi-implicit Euler: h^2 g (1 + 2 + ... + n).
  const double h = m->opt.timestep;
  EXPECT_NEAR(start - d->qpos[2], g * h * h * steps * (steps + 1) / 2.0, 1e-12);
}

TEST(ComposedSolids, SizesAndPosesStayLive) {
  const ModelPointer m = testing::load(scene(bored(), ball()));
  const testing::Attached attached(m);
  const int block = mj_name2id(m.get(), mjOBJ_GEOM, "block");
  const int hole = mj_name2id(m.get(), mjOBJ_GEOM, "hole");
  const auto volume = [&] {
    return own_metrics_of(contact_of(m.get())->solids()[static_cast<std::size_t>(block)]).volume;
  };
  m->geom_size[3 * hole] = .03;
  EXPECT_NEAR(volume(), .2 * .2 * .1 - kPi * 9e-4 * .1, 1e-15);
  m->geom_pos[3 * hole] = .5;  // beside the block
  EXPECT_NEAR(volume(), .2 * .2 * .1, 1e-15);
}

}  // namespace
}  // namespace volcontact::adaptor::composed_solids_test
