// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/engine_interface.h"
#include "volcontact/pair/mesh_columns/mesh_columns.h"

namespace volcontact {

/// A mesh and a solid of triangles, or a half-space.
struct MeshAndMesh : EngineBase {
  static constexpr Engine kWord = Engine::kColumns;
  using Scratch = TypeList<ColumnsScratch>;
  static constexpr bool kExact = true;

  template <typename A, typename B>
  static constexpr bool serves() {
    return std::is_same_v<A, Mesh> && (HasTriangles<B> || std::is_same_v<B, HalfSpace>);
  }
  template <typename A, typename B>
  static Answer run(const Question<A, B>& q, ColumnsScratch& scratch, Interference& out) {
    const SurfaceView a = surface_of(q.a, scratch.store[0]);
    if constexpr (HasTriangles<B>) {
      const SurfaceView b = surface_of(q.b, scratch.store[1]);
      columns_interference(a, b, q.X_AB, q.options, scratch, out);
    } else {
      columns_interference(a, q.b, q.X_AB, q.options, scratch, out);
    }
    return Answer::kGiven;
  }
};

}  // namespace volcontact
