// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/pair/convex/convex_view.h"
#include "volcontact/pair/sections/torus/torus_arcs.h"
#include "volcontact/pair/sections/torus/torus_exits.h"
#include "volcontact/pair/sections/torus/torus_section.h"

namespace volcontact {

/// A range of half-planes through the axis of a ring that meet an overlap [rad].
struct TorusRange {
  double low, high;            ///< nothing beyond
  double full_low, full_high;  ///< columns that far out at least
  bool whole;                  ///< all of the turn
};

/// Memory of the search.
struct TorusSites {
  std::vector<TorusRange> ranges;  ///< what was found, one for every connected part
  TorusArcs arcs;
  struct Sample {
    double angle, length;
    bool met = false;  ///< a ball meets the body there
  };
  std::vector<Sample> samples;
};

/// Finds where a ring meets a bounded convex body with the pose X in the ring's frame. What no
/// plane parts from it is looked through half-plane by half-plane, with those where a ball meets
/// the body among them, so that no overlap is too small to be found, and those of the exits at
/// which all of the ring is outside, so that no gap is. docs/theory.md, "Tori".
void find_torus_sites(const ConvexView& body, const Pose& X, SimdPath path,
                      const std::vector<TorusExit>& exits, TorusSection& sections,
                      TorusSites& sites);

}  // namespace volcontact
