// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/mesh/obb_tree.h"

#include <gtest/gtest.h>

#include "core/support/meshes.h"

namespace volcontact::obb_tree_test {
namespace {

MeshTopology topology_of(const test::Soup& soup) {
  MeshTopology topology;
  EXPECT_TRUE(make_topology(soup.vertices, soup.triangles, topology).none());
  return topology;
}

// Counts the triangles below a box, all of whose corners must lie in it.
int check_box(const ObbTree& tree, const ObbTree::Node& node, int lane, int child,
              std::vector<int>& seen) {
  const auto inside = [&](const Vec3& p) {
    for (int k = 0; k < 3; ++k) {
      double x = 0.0;
      for (int i = 0; i < 3; ++i) x += node.axis[k][i][lane] * (p[i] - node.center[i][lane]);
      if (std::abs(x) > node.half[k][lane]) return false;
    }
    return true;
  };
  int count = 0;
  if (child < 0) {
    const ObbTree::Leaf& leaf = tree.leaves[~child];
    for (int i = 0; i < leaf.count; ++i) {
      for (int c = 0; c < 3; ++c) {
        EXPECT_TRUE(inside({leaf.corner[c][0][i], leaf.corner[c][1][i], leaf.corner[c][2][i]}));
      }
      ++seen[tree.triangle_of_slot[~child * kLanes + i]];
    }
    return leaf.count;
  }
  for (int i = 0; i < tree.nodes[child].count; ++i) {
    count += check_box(tree, tree.nodes[child], i, tree.nodes[child].child[i], seen);
  }
  return count;
}

TEST(ObbTree, HoldsEveryTriangleOnceInsideItsBoxes) {
  // The last one lies far from its origin: its boxes are kept in floats.
  for (const test::Soup& soup :
       {test::box_soup(Vec3::Ones()), test::bumpy_soup(3, 1), test::ring_soup(0.5, 1.0, 2.0, 50),
        test::bumpy_soup(3, 1).moved(test::shifted(3e3, -2e4, 1e2))}) {
    const MeshTopology mesh = topology_of(soup);
    const ObbTree tree = make_obb_tree(mesh);
    std::vector<int> seen(mesh.triangles.size(), 0);
    int count = 0;
    for (int i = 0; i < tree.nodes[0].count; ++i) {
      count += check_box(tree, tree.nodes[0], i, tree.nodes[0].child[i], seen);
    }
    EXPECT_EQ(count, static_cast<int>(mesh.triangles.size()));
    for (int times : seen) EXPECT_EQ(times, 1);
  }
}

TEST(ObbTree, KnowsTheNeighborsOfItsSlots) {
  const MeshTopology mesh = topology_of(test::bumpy_soup(2, 1));
  const ObbTree tree = make_obb_tree(mesh);
  for (std::size_t s = 0; s < tree.triangle_of_slot.size(); ++s) {
    const int t = tree.triangle_of_slot[s];
    for (int i = 0; t >= 0 && i < 3; ++i) {
      const int twin = tree.twins[3 * s + i];
      EXPECT_EQ(tree.triangle_of_slot[twin / 3], mesh.twins[3 * t + i] / 3);
      EXPECT_EQ(twin % 3, mesh.twins[3 * t + i] % 3);
    }
  }
}

}  // namespace
}  // namespace volcontact::obb_tree_test
