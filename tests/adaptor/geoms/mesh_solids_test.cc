// SPDX-License-Identifier: Apache-2.0
#include "adaptor/geoms/mesh_solids.h"

#include <gtest/gtest.h>

#include "adaptor/geoms/solids_of_geoms.h"
#include "adaptor/scene/scene_contact.h"
#include "adaptor/support/models.h"

namespace volcontact::adaptor::mesh_solids_test {
namespace {

// An L of three unit cubes, 1 deep: its hull holds half a cube more.
constexpr const char* kCorners =
    "0 0 0  2 0 0  2 1 0  1 1 0  1 2 0  0 2 0  0 0 1  2 0 1  2 1 1  1 1 1  1 2 1  0 2 1";
constexpr const char* kFaces =
    "0 2 1 0 3 2 0 4 3 0 5 4  6 7 8 6 8 9 6 9 10 6 10 11 "
    "0 1 7 0 7 6 1 2 8 1 8 7 2 3 9 2 9 8 3 4 10 3 10 9 4 5 11 4 11 10 5 0 6 5 6 11";

std::string scene(const std::string& faces, const std::string& custom = "",
                  const std::string& scale = "1 1 1") {
  return std::string("<mujoco><asset><mesh name=\"ell\" vertex=\"") + kCorners + "\" face=\"" +
         faces + "\" scale=\"" + scale +
         "\"/></asset><worldbody><geom name=\"floor\" type=\"plane\" size=\"9 9 1\"/>"
         "<body pos=\"0 0 2\"><freejoint/><inertial pos=\".8 .8 .5\" mass=\"3\" "
         "diaginertia=\"1 1 1\"/><geom name=\"ell\" type=\"mesh\" mesh=\"ell\"/></body>"
         "</worldbody>" +
         custom + "</mujoco>";
}

TEST(MeshSolids, AreTheTrianglesAsGivenWhereTheModelPutsThem) {
  const testing::ModelPointer m = testing::compile(scene(kFaces));
  const testing::DataPointer d = testing::make_data(m);
  mj_forward(m.get(), d.get());
  const Shape solid = solid_of_geom(m.get(), 1);
  ASSERT_TRUE(std::holds_alternative<Mesh>(solid));
  EXPECT_NEAR(own_metrics_of(solid).volume, 3.0, 1e-5);  // coordinates are floats
  const Vec3 middle = pose_of_geom(d.get(), 1) * own_metrics_of(solid).centroid;
  EXPECT_LT((middle - Vec3(2.5 / 3.0, 2.5 / 3.0, 2.5)).norm(), 1e-6);
}

TEST(MeshSolids, AreTheHullWhenTheSceneSaysSo) {
  const testing::ModelPointer m =
      testing::compile(scene(kFaces, testing::numeric("volcontact/option/mesh/hull", "1")));
  const SceneContact contact(m.get());
  EXPECT_NEAR(own_metrics_of(contact.solids()[1]).volume, 3.5, 1e-5);
}

TEST(MeshSolids, AreNotMadeAgainForOtherNumbers) {
  const testing::ModelPointer m =
      testing::compile(scene(kFaces, testing::material("m", {{"stiffness", "2e8"}}, {"ell"})));
  const SceneContact before(m.get());
  m->numeric_data[0] = 1e8;
  m->geom_friction[0] = 0.3;
  const SceneContact now(m.get(), {}, &before);
  const auto tree = [](const SceneContact& contact) {
    return &std::get<Mesh>(contact.solids()[1]).tree();
  };
  EXPECT_EQ(tree(now), tree(before));
  EXPECT_NE(tree(SceneContact(m.get())), tree(before));
}

TEST(MeshSolids, MirroredMeshIsTurned) {
  const testing::ModelPointer m = testing::compile(scene(kFaces, "", "-1 1 1"));
  EXPECT_NEAR(own_metrics_of(solid_of_geom(m.get(), 1)).volume, 3.0, 1e-5);
}

TEST(MeshSolids, OpenMeshIsRefusedByNameAndPlace) {
  const std::string open = std::string(kFaces).substr(0, std::string(kFaces).size() - 7);
  const testing::ModelPointer m = testing::compile(scene(open));
  const std::string text = testing::message_of([&] { solid_of_geom(m.get(), 1); });
  EXPECT_TRUE(testing::contains(text, "geom 'ell', mesh 'ell'"));
  EXPECT_TRUE(testing::contains(text, "3 boundary edges, the first at ("));
  EXPECT_TRUE(testing::contains(text, "volcontact mesh repair"));
  EXPECT_TRUE(testing::contains(text, "volcontact/option/mesh/hull"));
}

TEST(MeshSolids, HullStandsForAnOpenMeshWhereThatIsAskedFor) {
  const std::string open = std::string(kFaces).substr(0, std::string(kFaces).size() - 7);
  const std::string key = testing::numeric("volcontact/option/mesh/exact_or_hull", "1");
  const SceneContact of_open(testing::compile(scene(open, key)).get());
  EXPECT_TRUE(std::holds_alternative<ConvexPolytope>(of_open.solids()[1]));
  ASSERT_EQ(of_open.alerts().size(), 1U);
  EXPECT_TRUE(testing::contains(of_open.alerts()[0], "meshes that bound no solid: ell"));
  const SceneContact of_closed(testing::compile(scene(kFaces, key)).get());
  EXPECT_TRUE(std::holds_alternative<Mesh>(of_closed.solids()[1]));
  EXPECT_TRUE(of_closed.alerts().empty());
}

TEST(MeshSolids, HeightFieldIsWhatIsBetweenItAndItsBase) {
  const testing::ModelPointer m = testing::compile(
      "<mujoco><asset><hfield name=\"hill\" nrow=\"4\" ncol=\"3\" size=\"1 2 .5 .1\"/></asset>"
      "<worldbody><geom name=\"hill\" type=\"hfield\" hfield=\"hill\"/></worldbody></mujoco>");
  for (int i = 0; i < 12; ++i) m->hfield_data[i] = i == 4 ? 1.0F : 0.0F;  // row 1, column 1
  const Shape solid = solid_of_geom(m.get(), 0);
  // A pyramid over the six triangles around a vertex: each a third of its height times its area.
  const double triangle = 0.5 * 1.0 * (4.0 / 3.0);
  EXPECT_NEAR(own_metrics_of(solid).volume, 2.0 * 4.0 * 0.1 + 6.0 * triangle * 0.5 / 3.0, 1e-12);
  EXPECT_EQ(bounds_of(solid).min.z(), -0.1);
  EXPECT_EQ(bounds_of(solid).max.z(), 0.5);
  // As in MuJoCo's collision, the diagonal of each cell runs from its first to its last corner.
  const auto& surface = std::get<Mesh>(solid);
  EXPECT_LT(surface.signed_distance(Vec3(-0.5, -4.0 / 3.0, 0.2)), 0.0);
  EXPECT_GT(surface.signed_distance(Vec3(0.5, -4.0 / 3.0, 0.2)), 0.0);
}

TEST(MeshSolids, RestOnAFloorByTheirWeight) {
  const testing::ModelPointer m =
      testing::load(scene(kFaces, testing::numeric("volcontact/option/implicit/off", "1")));
  const testing::Attached attached(m);
  const testing::DataPointer d = testing::make_data(m);
  d->qpos[2] = -1e-4;
  mj_forward(m.get(), d.get());
  // V = 3 m^2 x 0.1 mm at the default stiffness, at the centroid of the L.
  const mjtNum force = d->qfrc_applied[2];
  EXPECT_GT(force, 0.0);
  const double arm = 2.5 / 3.0;  // from the joint
  EXPECT_NEAR(d->qfrc_applied[3], force * arm, 1e-4 * force);
  EXPECT_NEAR(d->qfrc_applied[4], -force * arm, 1e-4 * force);
}

}  // namespace
}  // namespace volcontact::adaptor::mesh_solids_test
