// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/mesh/mesh_topology.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "core/support/meshes.h"

namespace volcontact::mesh_topology_test {
namespace {

using test::box_soup;
using test::Soup;

MeshDefects judged(const Soup& soup, MeshTopology& topology) {
  return make_topology(soup.vertices, soup.triangles, topology);
}
MeshDefects judged(const Soup& soup) {
  MeshTopology topology;
  return judged(soup, topology);
}
::testing::AssertionResult says(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "'" << text << "' does not say '" << part << "'";
}
Pose at(double x) { return {Mat3::Identity(), Vec3(x, 0.0, 0.0)}; }

TEST(MeshTopology, WeldsASoupAndPairsItsEdges) {
  MeshTopology cube;
  ASSERT_TRUE(judged(box_soup(Vec3(1.0, 2.0, 3.0), 3), cube).none());
  EXPECT_EQ(cube.triangles.size(), 108u);
  EXPECT_EQ(cube.vertices.size(), 56u);  // V = 2 + E - F with E = 3 F / 2
  EXPECT_EQ(cube.component_count, 1);
  EXPECT_FALSE(cube.turned);
  for (std::size_t h = 0; h < cube.twins.size(); ++h) {
    const auto twin = static_cast<std::size_t>(cube.twins[h]);
    EXPECT_EQ(cube.twins[twin], static_cast<int>(h));
    EXPECT_EQ(cube.triangles[h / 3][h % 3], cube.triangles[twin / 3][(twin % 3 + 1) % 3]);
  }
}

TEST(MeshTopology, WeldsWhatRoundingToFloatsHasParted) {
  Soup soup = box_soup(Vec3(1.0, 1.0, 1.0), 2);
  test::Random random(1);
  for (Vec3& v : soup.vertices) v += random.in_box(1e-8);
  MeshTopology topology;
  EXPECT_TRUE(judged(soup, topology).none());
  EXPECT_EQ(topology.vertices.size(), 26u);
}

TEST(MeshTopology, TurnsWhatIsInsideOutAsAWhole) {
  MeshTopology topology;
  EXPECT_TRUE(judged(box_soup(Vec3::Ones()).inside_out(), topology).none());
  EXPECT_TRUE(topology.turned);
}

TEST(MeshTopology, DropsTrianglesThatLoseACorner) {
  Soup soup = box_soup(Vec3::Ones());
  soup.vertices.push_back(soup.vertices[0]);
  soup.triangles.push_back({0, static_cast<int>(soup.vertices.size()) - 1, 1});
  MeshTopology topology;
  EXPECT_TRUE(judged(soup, topology).none());
  EXPECT_EQ(topology.triangles.size(), 12u);
}

TEST(MeshTopology, ACavityIsNoMistakeButAPartInsideOutIs) {
  const Soup block = box_soup(Vec3::Constant(2.0)),
             inside_out = box_soup(Vec3::Ones()).inside_out();
  MeshTopology hollow;
  EXPECT_TRUE(judged(block.with(inside_out), hollow).none());
  EXPECT_EQ(hollow.component_count, 2);
  const MeshDefects apart = judged(block.with(inside_out.moved(at(10.0))));
  EXPECT_EQ(apart.inverted_components, 1);
  EXPECT_TRUE(says(apart.message(), "1 part inside out"));
}

TEST(MeshTopology, SaysWhereASurfaceIsOpen) {
  Soup soup = box_soup(Vec3::Ones());
  soup.triangles.pop_back();
  const MeshDefects defects = judged(soup);
  EXPECT_EQ(defects.boundary_edges, 3);
  for (const Vec3& end : defects.where) EXPECT_EQ(end.z(), 1.0);  // the last face looks along z
  EXPECT_TRUE(says(defects.message(), "3 boundary edges, the first at ("));
  EXPECT_TRUE(says(defects.message(), "closed surface"));
}

TEST(MeshTopology, SaysWhereTrianglesDisagree) {
  Soup soup = box_soup(Vec3::Ones());
  std::swap(soup.triangles[5][0], soup.triangles[5][1]);
  EXPECT_EQ(judged(soup).inconsistent_edges, 3);
  soup = box_soup(Vec3::Ones());
  soup.triangles.push_back({0, 1, 7});
  EXPECT_GT(judged(soup).branching_edges, 0);
}

TEST(MeshTopology, RefusesWhatIsNoMesh) {
  const auto message = [](const std::vector<Vec3>& vertices, const std::vector<Triangle>& faces) {
    MeshTopology topology;
    try {
      make_topology(vertices, faces, topology);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const Soup cube = box_soup(Vec3::Ones());
  EXPECT_TRUE(says(message({}, {}), "no triangles; a closed surface has at least 4"));
  for (const Triangle& folded : {Triangle{4, 4, 1}, Triangle{4, 1, 4}, Triangle{1, 4, 4}}) {
    Soup twice = cube;
    twice.triangles.push_back(folded);
    EXPECT_TRUE(says(message(twice.vertices, twice.triangles),
                     "triangle 12 names vertex 4 twice; a triangle has three corners"));
  }
  Soup bad = cube;
  bad.vertices[7].y() = std::nan("");
  EXPECT_TRUE(says(message(bad.vertices, bad.triangles), "vertex 7 is (1, nan"));
  bad = cube;
  bad.triangles[3][1] = 24;
  EXPECT_TRUE(says(message(bad.vertices, bad.triangles),
                   "triangle 3 names vertex 24; there are 24, numbered from 0"));
  bad.triangles[3][1] = -1;
  EXPECT_TRUE(says(message(bad.vertices, bad.triangles), "names vertex -1"));
}

}  // namespace
}  // namespace volcontact::mesh_topology_test
