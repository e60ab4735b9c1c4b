// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/shape/box.h"
#include "volcontact/shape/convex_polytope.h"
#include "volcontact/shape/mesh.h"

namespace volcontact {

/// What the columns engine needs of a solid whose surface is made of triangles. It refers to the
/// solid and must not outlive it.
struct SurfaceView {
  const ObbTree* tree;
  const Mesh::Components* components;  ///< null where the surface is connected
  Aabb bounds;
  VolumeMetrics own;
  double surface_area;
  Vec3 point;  ///< on the surface

  int part_count() const {
    return components == nullptr ? 1 : static_cast<int>(components->size());
  }
  Mesh::Component part(int i) const {
    if (components != nullptr) return components->list[static_cast<std::size_t>(i)];
    return {own, surface_area, false, point, bounds};
  }
  int part_of_slot(int slot) const {
    return components == nullptr ? 0 : components->of_slot[static_cast<std::size_t>(slot)];
  }
};

/// The triangles of a box, which has no tree of its own.
void make_box_tree(const Vec3& half_sizes, ObbTree& tree);

inline SurfaceView surface_of(const Mesh& mesh, ObbTree&) {
  const Mesh::Components& parts = mesh.components();
  return {&mesh.tree(),        parts.size() > 1 ? &parts : nullptr,
          mesh.bounds(),       mesh.own_metrics(),
          mesh.surface_area(), mesh.topology().vertices[0]};
}

inline SurfaceView surface_of(const ConvexPolytope& solid, ObbTree&) {
  return {&solid.tree(),      nullptr, solid.bounds(), solid.own_metrics(), solid.surface_area(),
          solid.vertices()[0]};
}
inline SurfaceView surface_of(const Box& solid, ObbTree& tree) {
  make_box_tree(solid.half_sizes(), tree);
  const Vec3& half = solid.half_sizes();
  const double area = 8.0 * (half.x() * half.y() + half.y() * half.z() + half.z() * half.x());
  return {&tree, nullptr, solid.bounds(), solid.own_metrics(), area, half};
}

template <typename S>
concept HasTriangles = requires(const S& solid, ObbTree& tree) { surface_of(solid, tree); };

}  // namespace volcontact
