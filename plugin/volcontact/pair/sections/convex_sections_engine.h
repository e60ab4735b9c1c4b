// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/engine_interface.h"
#include "volcontact/pair/sections/convex_sections.h"

namespace volcontact {

/// Two convex solids of which at least one is round.
struct ConvexSections : EngineBase {
  static constexpr Engine kWord = Engine::kLines;
  using Scratch = TypeList<LinesScratch>;

  template <typename A, typename B>
  static constexpr bool serves() {
    return HasFaces<A> && HasFaces<B> && (HasRoundFaces<A> || HasRoundFaces<B>);
  }
  template <typename A, typename B>
  static Answer run(const Question<A, B>& q, LinesScratch& scratch, Interference& out) {
    return answer(
        lines_interference(ConvexView(q.a), ConvexView(q.b), q.X_AB, q.options, scratch, out));
  }
};

}  // namespace volcontact
