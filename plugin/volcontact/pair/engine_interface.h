// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

#include "volcontact/pair/overlap.h"
#include "volcontact/shape/shapes.h"

namespace volcontact {

/// What an engine is asked: the overlap of A and B at X_AB, the pose of B in A. Each solid comes as
/// itself and as a shape.
template <typename A, typename B>
struct Question {
  const A& a;
  const B& b;
  const Shape& shape_a;
  const Shape& shape_b;
  const Pose& X_AB;
  const InterferenceOptions& options;
};

enum class Answer {
  kGiven,   ///< `out` has the overlap
  kBeyond,  ///< the solids or their pose are beyond the engine: the next one is asked
};
constexpr Answer answer(bool given) { return given ? Answer::kGiven : Answer::kBeyond; }

/// What is usual of an engine, for engines to inherit. An engine is one type without members:
///
///  kWord            its public word; several engines may share one
///  Scratch          a TypeList of what it keeps from call to call to allocate nothing; types that
///                   several engines name are shared
///  serves<A, B>()   whether it integrates these types of solids in this order; the mirror image is
///                   made for it
///  run(question, scratch..., out)   metrics in A's frame about A's origin, or kBeyond;
///                                  throws std::bad_alloc alone
///
/// and what of this base is not usual for it. `dispatch.h` does all the rest once for all engines,
/// `engines.h` has the list of them.
struct EngineBase {
  /// One formula gives all numbers, in the time that it takes to look at them: V alone is looked
  /// at, and depth is taken as it is.
  static constexpr bool kByFormula = false;
  /// Writes `out.total` alone, of one site. Where that cannot be, engines with bounds are asked.
  static constexpr bool kOneSite = false;
  /// Exact to rounding. What is no number here, or was cut short by the budget, is given to another
  /// engine, but not to one with bounds: nothing better would follow.
  static constexpr bool kExact = false;
  /// Answers at some poses alone, and is asked by kAuto alone: the pair is not said to be of it.
  static constexpr bool kSomePoses = false;
  /// Bounds its own error, serves all, and comes last.
  static constexpr bool kHasBounds = false;

  /// Whether `auto` asks this engine for solids that it serves.
  template <typename A, typename B>
  static constexpr bool in_auto() {
    return true;
  }
  /// Whether it answers as well where the engine `asked` for is beyond.
  static constexpr bool stands_in_for(Engine asked) {
    static_cast<void>(asked);
    return false;
  }
  /// Whether it serves these very solids, of types that it serves; a bool where it has to look.
  template <typename A, typename B>
  static std::true_type reaches(const A&, const B&) noexcept {
    return {};
  }
};

}  // namespace volcontact
