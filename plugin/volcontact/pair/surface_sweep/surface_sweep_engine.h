// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/convex/face_set.h"
#include "volcontact/pair/engine_interface.h"
#include "volcontact/pair/surface_sweep/surface_sweep.h"

namespace volcontact {

/// What sections serve, from the surface of the overlap: the next to be asked where they are
/// beyond.
struct SurfaceSweep : EngineBase {
  static constexpr Engine kWord = Engine::kSurfaceSweep;
  using Scratch = TypeList<SurfaceSweepScratch>;

  template <typename S>
  static constexpr bool kMadeOfSimple = HasFaces<S> || HasParts<S> || std::is_same_v<S, Csg>;
  template <typename S>
  static constexpr bool kHasPlanesOnly = HasFaces<S> && !HasRoundFaces<S>;

  /// One with a formula.
  template <typename A, typename B>
  static constexpr bool kTorusOnPlane = std::is_same_v<A, Torus> && std::is_same_v<B, HalfSpace>;

  static constexpr bool stands_in_for(Engine asked) { return asked == Engine::kLines; }
  template <typename A, typename B>
  static constexpr bool serves() {
    return kMadeOfSimple<A> && kMadeOfSimple<B> && !(kHasPlanesOnly<A> && kHasPlanesOnly<B>) &&
           !kTorusOnPlane<A, B> && !kTorusOnPlane<B, A>;
  }
  /// Of many parts: the octree, which has their exact faces, is as quick, and bounds its error. But
  /// a torus is none of its exact faces.
  template <typename A, typename B>
  static constexpr bool in_auto() {
    constexpr bool has_rounded = std::is_same_v<A, RoundedBox> || std::is_same_v<B, RoundedBox>;
    return !has_rounded || std::is_same_v<A, Torus> || std::is_same_v<B, Torus>;
  }
  template <typename A, typename B>
  static Answer run(const Question<A, B>& q, SurfaceSweepScratch& scratch, Interference& out) {
    return answer(surface_sweep(q.shape_a, q.shape_b, q.X_AB, q.options, scratch, out));
  }
};

}  // namespace volcontact
