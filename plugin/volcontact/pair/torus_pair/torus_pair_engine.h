// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/engine_interface.h"
#include "volcontact/pair/torus_pair/torus_pair.h"

namespace volcontact {

/// Two tori.
struct TorusPair : EngineBase {
  static constexpr Engine kWord = Engine::kLines;
  using Scratch = TypeList<TorusPairScratch>;

  template <typename A, typename B>
  static constexpr bool serves() {
    return std::is_same_v<A, Torus> && std::is_same_v<B, Torus>;
  }
  template <typename A, typename B>
  static Answer run(const Question<A, B>& q, TorusPairScratch& scratch, Interference& out) {
    return answer(torus_pair(q.a, q.b, q.X_AB, q.options, scratch, out));
  }
};

}  // namespace volcontact
