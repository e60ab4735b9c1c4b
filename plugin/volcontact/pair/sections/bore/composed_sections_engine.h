// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/engine_interface.h"
#include "volcontact/pair/sections/bore/composed_sections.h"

namespace volcontact {

/// A composed solid and another one, or a convex one: also a pin in a bore.
struct ComposedSections : EngineBase {
  static constexpr Engine kWord = Engine::kLines;
  using Scratch = TypeList<LinesScratch, ComposedScratch>;

  template <typename A, typename B>
  static constexpr bool serves() {
    constexpr bool a_composed = std::is_same_v<A, Csg>, b_composed = std::is_same_v<B, Csg>;
    return (a_composed && (b_composed || HasFaces<B>)) || (HasFaces<A> && b_composed);
  }
  template <typename A, typename B>
  static Answer run(const Question<A, B>& q, LinesScratch& lines, ComposedScratch& scratch,
                    Interference& out) {
    if (!has_lines_pieces(q.a) || !has_lines_pieces(q.b)) return Answer::kBeyond;
    for (auto& pieces : scratch.pieces) pieces.clear();
    add_lines_pieces(q.a, scratch.pieces[0]);
    add_lines_pieces(q.b, scratch.pieces[1]);
    return answer(composed_lines(q.X_AB, q.options, lines, scratch, out));
  }
};

}  // namespace volcontact
