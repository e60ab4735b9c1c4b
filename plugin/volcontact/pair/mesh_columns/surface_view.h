// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/shape/box.h"
#include "volcontact/shape/mesh/mesh.h"
#include "volcontact/shape/polytope/convex_polytope.h"

namespace volcontact {

/// normal . x <= offset, the normal of unit length.
struct SurfacePlane {
  Vec3 normal;
  double offset;
};

/// What the columns engine needs of a solid whose surface is made of triangles. It refers to the
/// solid and must not outlive it.
struct SurfaceView {
  const ObbTree* tree;
  const Mesh::Components* components;  ///< null where the surface is connected
  Aabb bounds;
  VolumeMetrics own;
  double surface_area;
  Vec3 point;                                         ///< on the surface
  const std::vector<SurfacePlane>* planes = nullptr;  ///< of a convex solid

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

/// What a view refers to and the solid does not hold itself.
struct SurfaceStore {
  ObbTree tree;  ///< of a box
  std::vector<SurfacePlane> planes;
};

/// The triangles of a box, which has no tree of its own.
void make_box_tree(const Vec3& half_sizes, ObbTree& tree);

inline SurfaceView surface_of(const Mesh& mesh, SurfaceStore&) {
  const Mesh::Components& parts = mesh.components();
  return {&mesh.tree(),        parts.size() > 1 ? &parts : nullptr,
          mesh.bounds(),       mesh.own_metrics(),
          mesh.surface_area(), mesh.topology().vertices[0]};
}

inline SurfaceView surface_of(const ConvexPolytope& solid, SurfaceStore& store) {
  store.planes.clear();
  for (const ConvexPolytope::Face& face : solid.faces()) {
    store.planes.push_back({face.normal, face.offset});
  }
  return {
      &solid.tree(),       nullptr,      solid.bounds(), solid.own_metrics(), solid.surface_area(),
      solid.vertices()[0], &store.planes};
}
inline SurfaceView surface_of(const Box& solid, SurfaceStore& store) {
  make_box_tree(solid.half_sizes(), store.tree);
  const Vec3& half = solid.half_sizes();
  store.planes.clear();
  for (int i = 0; i < 3; ++i) {
    store.planes.push_back({Vec3::Unit(i), half[i]});
    store.planes.push_back({-Vec3::Unit(i), half[i]});
  }
  const double area = 8.0 * (half.x() * half.y() + half.y() * half.z() + half.z() * half.x());
  return {&store.tree, nullptr, solid.bounds(), solid.own_metrics(), area, half, &store.planes};
}

/// About how large the coordinates in some bounds get [m].
double size_of(const Aabb& bounds);

/// Whether the bounds of A, and of B posed in A, have a side with nothing in common.
bool bounds_apart(const Aabb& a, const Aabb& b, const Pose& X_AB);

/// Whether the surfaces consist of the same triangles in the same order, no corner farther from its
/// like than `reach` [m]. `X_BA` is the pose of A in B; `slots` is memory.
bool coincide(const SurfaceView& a, const SurfaceView& b, const Pose& X_BA, double reach,
              std::vector<int>& slots);

template <typename S>
concept HasTriangles = requires(const S& solid, SurfaceStore& store) { surface_of(solid, store); };

}  // namespace volcontact
