// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

#include "volcontact/pair/convex/separation.h"
#include "volcontact/pair/engine_interface.h"
#include "volcontact/pair/sections/convex_sections.h"
#include "volcontact/shape/capsule.h"
#include "volcontact/shape/sphere.h"

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
    if constexpr (is_capsule<A> && is_capsule<B>) {
      if (capsules_apart(half_length(q.a), q.a.radius(), half_length(q.b), q.b.radius(), q.X_AB)) {
        out.total = VolumeMetrics{};
        out.sites.clear();
        return Answer::kGiven;
      }
    }
    return answer(
        lines_interference(ConvexView(q.a), ConvexView(q.b), q.X_AB, q.options, scratch, out));
  }

 private:
  // Balls are capsules without a length.
  template <typename Solid>
  static constexpr bool is_capsule =
      std::is_same_v<Solid, Capsule> || std::is_same_v<Solid, Sphere>;
  static double half_length(const Capsule& capsule) { return capsule.half_length(); }
  static double half_length(const Sphere&) { return 0.0; }
};

}  // namespace volcontact
