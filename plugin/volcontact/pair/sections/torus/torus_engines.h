// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/engine_interface.h"
#include "volcontact/pair/sections/torus/torus_in_composed.h"
#include "volcontact/pair/sections/torus/torus_sections.h"

namespace volcontact {

/// A torus and a bounded convex solid.
struct TorusAndConvex : EngineBase {
  static constexpr Engine kWord = Engine::kLines;
  using Scratch = TypeList<TorusSectionsScratch, ComposedScratch>;

  template <typename A, typename B>
  static constexpr bool serves() {
    return std::is_same_v<A, Torus> && HasFaces<B> && !std::is_same_v<B, HalfSpace>;
  }
  template <typename A, typename B>
  static Answer run(const Question<A, B>& q, TorusSectionsScratch& ring, ComposedScratch& composed,
                    Interference& out) {
    return answer(
        torus_interference(q.a, ConvexView(q.b), q.X_AB, q.options, ring, composed.regions, out));
  }
};

/// A torus and a composed solid.
struct TorusAndComposed : EngineBase {
  static constexpr Engine kWord = Engine::kLines;
  using Scratch = TypeList<TorusSectionsScratch, ComposedScratch>;

  template <typename A, typename B>
  static constexpr bool serves() {
    return std::is_same_v<A, Torus> && std::is_same_v<B, Csg>;
  }
  template <typename A, typename B>
  static Answer run(const Question<A, B>& q, TorusSectionsScratch& ring, ComposedScratch& composed,
                    Interference& out) {
    if (!has_lines_pieces(q.b)) return Answer::kBeyond;
    composed.pieces[1].clear();
    add_lines_pieces(q.b, composed.pieces[1]);
    return answer(torus_in_composed(q.a, q.X_AB, q.options, ring, composed, out));
  }
};

}  // namespace volcontact
