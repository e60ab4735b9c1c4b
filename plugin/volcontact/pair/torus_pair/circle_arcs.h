// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/torus_pair/torus_size.h"

namespace volcontact {

/// Parts of a circle that lie in a ring, by their angles [rad].
struct CircleArcs {
  static constexpr int kMost = 8;
  int count = 0;
  bool whole = false;              ///< all of the circle; `count` is zero then
  double low[kMost], high[kMost];  ///< one after the other; low from 0 to 2 pi, high above it
  int minima = 0;                  ///< places inside that are nearest to the circle of the ring
  double nearest[kMost];           ///< when asked for

  bool none() const { return !whole && count == 0; }
};

enum class ArcSearch { kCount, kArcs, kWithMinima };  ///< kCount: not where they begin and end

/// Arcs of a circle in a ring. Places closer to the surface of the ring than rounding are on
/// neither side: a circle that only touches has no arc, and one that leaves no more than that has
/// no gap. `fine` looks at twice as many places; for
/// the minima there are three times as many. docs/theory.md, "Two tori".
void find_arcs(const Circle& circle, const TorusSize& ring, ArcSearch search, bool fine,
               CircleArcs& arcs);

}  // namespace volcontact
