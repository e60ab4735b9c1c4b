// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/engine_interface.h"
#include "volcontact/pair/octree/octree.h"

namespace volcontact {

/// Any two solids of which one is bounded, to a bound of the error.
struct Octree : EngineBase {
  static constexpr Engine kWord = Engine::kOctree;
  using Scratch = TypeList<OctreeScratch>;
  static constexpr bool kHasBounds = true;
  static constexpr bool stands_in_for(Engine) { return true; }

  template <typename A, typename B>
  static constexpr bool serves() {
    return !(std::is_same_v<A, HalfSpace> && std::is_same_v<B, HalfSpace>);
  }
  template <typename A, typename B>
  static Answer run(const Question<A, B>& q, OctreeScratch& scratch, Interference& out) noexcept {
    octree_interference(q.shape_a, q.shape_b, q.X_AB, q.options, scratch, out);
    return Answer::kGiven;
  }
};

}  // namespace volcontact
