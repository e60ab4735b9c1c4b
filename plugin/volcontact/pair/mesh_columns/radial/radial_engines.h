// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/engine_interface.h"
#include "volcontact/pair/mesh_columns/mesh_columns.h"
#include "volcontact/pair/mesh_columns/radial/composed_columns.h"
#include "volcontact/pair/mesh_columns/radial/torus_columns.h"

namespace volcontact {

/// A mesh and a torus.
struct MeshAndTorus : EngineBase {
  static constexpr Engine kWord = Engine::kColumns;
  using Scratch = TypeList<ColumnsScratch, TorusColumnsScratch>;
  static constexpr bool kExact = true;

  template <typename A, typename B>
  static constexpr bool serves() {
    return std::is_same_v<A, Mesh> && std::is_same_v<B, Torus>;
  }
  template <typename A, typename B>
  static Answer run(const Question<A, B>& q, ColumnsScratch& columns, TorusColumnsScratch& scratch,
                    Interference& out) {
    return answer(
        torus_columns(surface_of(q.a, columns.store[0]), q.b, q.X_AB, q.options, scratch, out));
  }
};

/// A solid of triangles and a composed solid: also a mesh in a bore.
struct MeshAndComposed : EngineBase {
  static constexpr Engine kWord = Engine::kColumns;
  using Scratch = TypeList<ColumnsScratch, RoundColumnsScratch, ComposedColumnsScratch>;
  static constexpr bool kExact = true;

  template <typename A, typename B>
  static constexpr bool serves() {
    return HasTriangles<A> && std::is_same_v<B, Csg>;
  }
  /// Of a box there are few faces, and sections are quicker.
  template <typename A, typename B>
  static constexpr bool in_auto() {
    return !std::is_same_v<A, Box>;
  }
  /// Not every composed solid can be written as pieces.
  template <typename A>
  static bool reaches(const A&, const Csg& b) noexcept {
    return has_columns_pieces(b);
  }
  template <typename A, typename B>
  static Answer run(const Question<A, B>& q, ColumnsScratch& columns, RoundColumnsScratch& round,
                    ComposedColumnsScratch& scratch, Interference& out) {
    return answer(composed_columns(surface_of(q.a, columns.store[0]), q.b, q.X_AB, q.options,
                                   columns, round, scratch, out));
  }
};

}  // namespace volcontact
