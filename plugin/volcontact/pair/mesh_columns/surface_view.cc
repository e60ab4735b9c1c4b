// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/surface_view.h"

#include <cmath>
#include <cstddef>

namespace volcontact {
namespace {

// The cube from -1 to 1.
ObbTree make_unit_cube() {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    corners.emplace_back((i & 1) ? 1.0 : -1.0, (i & 2) ? 1.0 : -1.0, (i & 4) ? 1.0 : -1.0);
  }
  MeshTopology cube;
  make_topology(corners,
                {{0, 2, 1},
                 {1, 2, 3},
                 {4, 5, 6},
                 {5, 7, 6},
                 {0, 1, 4},
                 {1, 5, 4},
                 {2, 6, 3},
                 {3, 6, 7},
                 {0, 4, 2},
                 {2, 4, 6},
                 {1, 3, 5},
                 {3, 7, 5}},
                cube);
  return make_obb_tree(cube);
}

}  // namespace

void make_box_tree(const Vec3& half_sizes, ObbTree& tree) {
  static const ObbTree cube = make_unit_cube();
  tree = cube;
  tree.size = half_sizes.sum();
  for (ObbTree::Leaf& leaf : tree.leaves) {
    for (auto& corner : leaf.corner) {
      for (int k = 0; k < 3; ++k) {
        for (double& x : corner[k]) x *= half_sizes[k];
      }
    }
  }
  for (ObbTree::Node& node : tree.nodes) {
    for (int lane = 0; lane < kLanes; ++lane) {
      Vec3 half = Vec3::Zero();
      for (int j = 0; j < 3; ++j) {
        for (int k = 0; k < 3; ++k) half[k] += std::abs(node.axis[j][k][lane]) * node.half[j][lane];
      }
      for (int k = 0; k < 3; ++k) {
        node.center[k][lane] *= static_cast<float>(half_sizes[k]);
        node.half[k][lane] = static_cast<float>(half[k] * half_sizes[k]);
        for (int j = 0; j < 3; ++j) node.axis[j][k][lane] = k == j ? 1.0f : 0.0f;
      }
    }
  }
}

double size_of(const Aabb& bounds) {
  return bounds.min.cwiseAbs().cwiseMax(bounds.max.cwiseAbs()).sum();
}

bool coincide(const SurfaceView& a, const SurfaceView& b, const Pose& X_BA, double reach,
              std::vector<int>& slots) {
  const auto near = [&](const Vec3& p_A, const Vec3& p_B) {
    return (X_BA * p_A - p_B).squaredNorm() <= reach * reach;
  };
  if (!near(a.own.centroid, b.own.centroid) ||
      std::abs(a.own.volume - b.own.volume) > reach * a.surface_area) {
    return false;
  }
  const std::vector<int>&of_a = a.tree->triangle_of_slot, &of_b = b.tree->triangle_of_slot;
  slots.assign(of_b.size(), -1);
  int triangles = 0, compared = 0;
  for (std::size_t slot = 0; slot < of_b.size(); ++slot) {
    if (of_b[slot] >= 0) slots[of_b[slot]] = static_cast<int>(slot), ++triangles;
  }
  for (std::size_t slot = 0; slot < of_a.size(); ++slot) {
    const int triangle = of_a[slot];
    if (triangle < 0) continue;
    if (triangle >= triangles) return false;
    for (int i = 0; i < 3; ++i) {
      const Vec3 p_A = a.tree->corner(static_cast<int>(slot), i);
      if (!near(p_A, b.tree->corner(slots[triangle], i))) return false;
    }
    ++compared;
  }
  return compared == triangles;
}

bool bounds_apart(const Aabb& a, const Aabb& b, const Pose& X_AB) {
  const Vec3 p = X_AB * b.center() - a.center();
  const Vec3 half_a = a.half_sizes(), half_b = b.half_sizes();
  if (p.cwiseAbs().exceeds(half_a + X_AB.rotation.cwiseAbs() * half_b)) return true;
  const Vec3 q = X_AB.rotation.transpose() * p;
  return q.cwiseAbs().exceeds(half_b + X_AB.rotation.transpose().cwiseAbs() * half_a);
}

}  // namespace volcontact
