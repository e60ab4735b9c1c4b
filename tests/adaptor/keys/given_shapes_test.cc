// SPDX-License-Identifier: Apache-2.0
// volcontact/shape/...: solids that MuJoCo has no geom for, from the keys to the volumes.
#include <gtest/gtest.h>

#include <cmath>

#include "adaptor/scene/scene_contact.h"
#include "adaptor/support/models.h"

namespace volcontact::adaptor::given_shapes_test {
namespace {

using testing::ModelPointer;

std::string element(const std::string& geom, const std::string& prm = "0") {
  return "<element objtype=\"geom\" objname=\"" + geom + "\" prm=\"" + prm + "\"/>";
}
std::string numeric(const std::string& key, const std::string& numbers) {
  return "<numeric name=\"" + key + "\" data=\"" + numbers + "\"/>";
}
std::string shape(const std::string& geom, const std::string& word, const std::string& numbers) {
  const std::string key = "volcontact/shape/" + geom;
  return "<tuple name=\"" + key + "\">" + element(geom) + "</tuple>" +
         numeric(key + "/" + word, numbers);
}
std::string solid(const std::string& parts) {
  return "<tuple name=\"volcontact/solid/part\">" + parts + "</tuple>";
}

// A body on a plane whose first geom is a cylinder of 20 mm, 30 mm long.
std::string scene(const std::string& custom) {
  return "<mujoco><asset><mesh name=\"wedge\" vertex=\"-.1 -.1 0  .1 -.1 0  .1 .1 0  -.1 .1 0  "
         "-.1 -.1 .02  .1 -.1 .02\"/></asset><worldbody>"
         "<geom name=\"floor\" type=\"plane\" size=\"1 1 1\"/>"
         "<body name=\"thing\" pos=\"0 0 .015\"><freejoint/>"
         "<geom name=\"rod\" type=\"cylinder\" size=\".02 .015\"/>"
         "<geom name=\"tool\" type=\"cylinder\" size=\".01 .03\" pos=\"0 0 .005\"/>"
         "<geom name=\"cutter\" type=\"box\" size=\".02 .02 .03\" pos=\".01 0 0\"/>"
         "<geom name=\"wedge\" type=\"mesh\" mesh=\"wedge\"/>"
         "</body></worldbody><custom>" +
         custom + "</custom></mujoco>";
}

Shape solid_of(const std::string& custom, const char* geom = "rod") {
  const ModelPointer m = testing::compile(scene(custom));
  const SceneContact contact(m.get());
  return contact.solids()[static_cast<std::size_t>(mj_name2id(m.get(), mjOBJ_GEOM, geom))];
}

double volume_of(const std::string& custom) { return own_metrics_of(solid_of(custom)).volume; }

std::string message_of(const std::string& custom) {
  try {
    const ModelPointer m = testing::compile(scene(custom));
    read_scene_keys(m.get());
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

double frustum_volume(double r, double R, double length) {
  return kPi / 3.0 * length * (r * r + r * R + R * R);
}

TEST(GivenShapes, FrustumStandsWhereItsGeomIs) {
  const Shape solid = solid_of(shape("rod", "frustum", ".03 .01 .02"));
  EXPECT_STREQ(name_of(solid), "frustum");
  EXPECT_NEAR(own_metrics_of(solid).volume, frustum_volume(.03, .01, .04), 1e-17);
  EXPECT_LT(own_metrics_of(solid).centroid.z(), 0.0);  // its thick end is below
}

TEST(GivenShapes, TorusHasPappusVolume) {
  EXPECT_NEAR(volume_of(shape("rod", "torus", ".02 .005")), 2.0 * kPi * kPi * .02 * 25e-6, 1e-17);
}

TEST(GivenShapes, RoundedBoxHasTheSizeOfItsGeom) {
  const Shape given = solid_of(shape("cutter", "rounded_box", ".004"), "cutter");
  EXPECT_STREQ(name_of(given), "rounded_box");
  const Aabb box = bounds_of(solid_of("", "cutter"));
  EXPECT_EQ(bounds_of(given).max, box.max);
  EXPECT_EQ(std::get<RoundedBox>(given).radius(), .004);
  const std::string cut = solid(element("rod", "1") + element("cutter", "-1"));
  EXPECT_GT(volume_of(cut + shape("cutter", "rounded_box", ".004")), volume_of(cut));
}

// A conical seat, and a bore for comparison.
TEST(GivenShapes, FrustumIsCutOutOfARod) {
  const std::string bored = element("rod", "1") + element("tool", "-1");
  const double hole = kPi * 1e-4 * .03;
  EXPECT_NEAR(volume_of(solid(bored)), kPi * 4e-4 * .03 - hole, 1e-15);
  const std::string sunk = solid(element("rod", "1") + element("tool", "-1")) +
                           shape("tool", "frustum", ".002 .014 .01");
  // From 5 mm below to 15 mm above the rod's middle: all of the frustum lies in the rod.
  EXPECT_NEAR(volume_of(sunk), kPi * 4e-4 * .03 - frustum_volume(.002, .014, .02), 1e-15);
}

// prm="2": a shaft with a flat, 10 mm from its axis on both sides of a box 20 mm to either side of
// x = 10 mm: what lies at x > -10 mm.
TEST(GivenShapes, IntersectionKeepsWhatLiesInBoth) {
  const double segment = 4e-4 * (kPi / 3.0 - std::sin(2.0 * kPi / 3.0) / 2.0);
  EXPECT_NEAR(volume_of(solid(element("rod", "1") + element("cutter", "2"))),
              (kPi * 4e-4 - segment) * .03, 1e-15);
}

// A wedge of 20 cm by 20 cm whose height falls from 20 mm to nothing: half a box.
TEST(GivenShapes, HullOfAMeshIsAPolytopeThatCanBeComposed) {
  const std::string hull = shape("wedge", "convex_polytope", "1");
  const Shape alone = solid_of(hull, "wedge");
  EXPECT_STREQ(name_of(alone), "convex_polytope");
  EXPECT_NEAR(own_metrics_of(alone).volume, .5 * .2 * .2 * .02, 1e-9);
  EXPECT_STREQ(name_of(solid_of("", "wedge")), "mesh");
  const std::string cut = solid(element("wedge", "1") + element("rod", "-1"));
  EXPECT_STREQ(name_of(solid_of(cut + hull, "wedge")), "csg");
}

TEST(GivenShapes, ErrorsSayWhatWhereAndTheFix) {
  EXPECT_EQ(message_of(shape("rod", "frustum", ".03 .01")),
            "volcontact/shape/rod/frustum takes 3 numbers, bottom_radius, top_radius, half_length "
            "in metres, got 2");
  EXPECT_EQ(message_of(shape("rod", "frustum", ".03 -.01 .02")),
            "volcontact/shape/rod/frustum: frustum: top_radius = -0.01 [m] is out of range: must "
            "be >= 0");
  EXPECT_EQ(message_of(shape("rod", "torus", "0 0")),
            "volcontact/shape/rod/torus: it has no volume");
  EXPECT_EQ(message_of(shape("rod", "frustrum", ".03 .01 .02")),
            "volcontact/shape/rod/frustrum: unknown key; after 'volcontact/shape/rod/' comes one "
            "of frustum, torus, rounded_box, convex_polytope (did you mean "
            "'volcontact/shape/rod/frustum'?)");
  EXPECT_EQ(message_of(numeric("volcontact/shape/rod/torus", ".03 .01")),
            "volcontact/shape/rod/torus: there is no <tuple name=\"volcontact/shape/rod\"> that "
            "says which geoms it is for");
  EXPECT_EQ(message_of("<tuple name=\"volcontact/shape/rod\">" + element("rod") + "</tuple>"),
            "volcontact/shape/rod: no <numeric> says what it is: frustum, torus, rounded_box, "
            "convex_polytope comes after the name");
  EXPECT_EQ(message_of(shape("rod", "rounded_box", ".001")),
            "volcontact/shape/rod: geom 'rod' is of type cylinder; a box is what edges can be "
            "rounded of");
  EXPECT_EQ(message_of(shape("cutter", "rounded_box", ".002 .001")),
            "volcontact/shape/cutter/rounded_box takes 1 number, the radius of the edges in "
            "metres, got 2");
  EXPECT_EQ(message_of(shape("cutter", "rounded_box", ".03")),
            "volcontact/shape/cutter: geom 'cutter': rounded_box: radius = 0.03 [m] is out of "
            "range: must be no more than the smallest of half_sizes");
  EXPECT_EQ(message_of(shape("rod", "torus", ".03 .01") +
                       numeric("volcontact/shape/rod/frustum", ".03 .01 .02")),
            "volcontact/shape/rod/frustum: volcontact/shape/rod/torus is given already");
  EXPECT_EQ(message_of(shape("wedge", "torus", ".03 .01")),
            "volcontact/shape/wedge: geom 'wedge' is of type mesh, whose frame is not its "
            "author's; let a sphere, capsule, ellipsoid, cylinder or box stand where the torus is");
  EXPECT_EQ(message_of(shape("rod", "convex_polytope", "1")),
            "volcontact/shape/rod: geom 'rod' is of type cylinder; the convex hull of a mesh geom "
            "is a convex_polytope");
  EXPECT_EQ(message_of(shape("rod", "torus", ".03 .01") + "<tuple name=\"volcontact/shape/b\">" +
                       element("rod") + "</tuple>"),
            "volcontact/shape/b: geom 'rod' is listed already; a geom has one shape");
}

}  // namespace
}  // namespace volcontact::adaptor::given_shapes_test
