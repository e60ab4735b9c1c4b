// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "volcontact/shape/mesh/mesh.h"

namespace volcontact {

/// Calls visit(p, q, r) with the corners, in the frame C, of every triangle of a mesh that may be
/// inside of a solid given in C. `outside(x)` is no more than the distance from that solid where
/// it is positive. X_CM is the pose of the mesh.
template <typename Outside, typename Visit>
void visit_triangles_near(const Mesh& mesh, const Pose& X_CM, std::vector<int>& stack,
                          Outside&& outside, Visit&& visit) {
  const ObbTree& tree = mesh.tree();
  const auto at = [](const auto& x, int lane) { return Vec3(x[0][lane], x[1][lane], x[2][lane]); };
  stack.assign(1, 0);
  while (!stack.empty()) {
    const int child = stack.back();
    stack.pop_back();
    if (child < 0) {
      const ObbTree::Leaf& leaf = tree.leaves[static_cast<std::size_t>(~child)];
      for (int lane = 0; lane < leaf.count; ++lane) {
        visit(X_CM * at(leaf.corner[0], lane), X_CM * at(leaf.corner[1], lane),
              X_CM * at(leaf.corner[2], lane));
      }
      continue;
    }
    const ObbTree::Node& node = tree.nodes[static_cast<std::size_t>(child)];
    for (int lane = 0; lane < node.count; ++lane) {
      if (outside(X_CM * at(node.center, lane)) <= at(node.half, lane).norm()) {
        stack.push_back(node.child[lane]);
      }
    }
  }
}

}  // namespace volcontact
