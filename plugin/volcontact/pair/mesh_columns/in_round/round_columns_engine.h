// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/engine_interface.h"
#include "volcontact/pair/mesh_columns/in_round/round_columns.h"
#include "volcontact/pair/mesh_columns/mesh_columns.h"

namespace volcontact {

/// A mesh and a convex solid with a round face.
struct MeshAndRound : EngineBase {
  static constexpr Engine kWord = Engine::kColumns;
  using Scratch = TypeList<ColumnsScratch, RoundColumnsScratch>;
  static constexpr bool kExact = true;

  template <typename A, typename B>
  static constexpr bool serves() {
    return std::is_same_v<A, Mesh> && HasRoundFaces<B>;
  }
  template <typename A, typename B>
  static Answer run(const Question<A, B>& q, ColumnsScratch& columns, RoundColumnsScratch& scratch,
                    Interference& out) {
    return answer(round_columns(surface_of(q.a, columns.store[0]), ConvexView(q.b), q.X_AB,
                                q.options, scratch, out));
  }
};

}  // namespace volcontact
