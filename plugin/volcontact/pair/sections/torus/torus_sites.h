// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/pair/convex/convex_view.h"
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
  struct Arc {
    double low, high;
  };
  std::vector<Arc> arcs, doubtful;
  struct Sample {
    double angle, length;
    bool met = false;  ///< a ball meets the body there
  };
  std::vector<Sample> samples;
};

/// Finds where a ring meets a bounded convex body with the pose X in the ring's frame. A ring is a
/// union of balls: a plane that parts the body from one of them parts it from all on an arc. What
/// such arcs leave is looked through half-plane by half-plane, with those where a ball meets the
/// body among them, so that no overlap is too small to be found. docs/theory.md, "Tori".
void find_torus_sites(const ConvexView& body, const Pose& X, SimdPath path, TorusSection& sections,
                      TorusSites& sites);

}  // namespace volcontact
