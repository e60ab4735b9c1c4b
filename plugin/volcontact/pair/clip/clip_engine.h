// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/clip/clip.h"
#include "volcontact/pair/engine_interface.h"

namespace volcontact {

/// Convex solids of plane faces: clip(a, b, X_AB, scratch) is found by overload.
struct Clip : EngineBase {
  static constexpr Engine kWord = Engine::kClip;
  using Scratch = TypeList<ClipScratch>;
  static constexpr bool kOneSite = true, kExact = true;

  template <typename A, typename B>
  static constexpr bool serves() {
    return requires(const A& a, const B& b, const Pose& X_AB, ClipScratch& scratch) {
      clip(a, b, X_AB, scratch);
    };
  }
  template <typename A, typename B>
  static Answer run(const Question<A, B>& q, ClipScratch& scratch, Interference& out) {
    out.total = clip(q.a, q.b, q.X_AB, scratch);
    return Answer::kGiven;
  }
};

}  // namespace volcontact
