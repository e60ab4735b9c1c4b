// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include "volcontact/base/types.h"
#include "volcontact/pair/convex/convex_view.h"

namespace volcontact {

/// Where a ring may meet a body, as angles about its axis [rad].
struct TorusArcs {
  struct Arc {
    double low, high;
  };
  static constexpr double kNothing = 1e-9;  ///< an arc this short holds nothing
  double start = 0.0;                       ///< all of the turn is start - pi to start + pi
  std::vector<Arc> doubtful;                ///< no plane parts these from the body
  std::vector<double> met;  ///< half-planes in which the ring and the body have a common place
  std::vector<Arc> open;    ///< memory of the search
};

/// The same angle, no more than half a turn from another.
inline double turned_near(double angle, double to) {
  return angle - 2.0 * kPi * std::floor((angle - to) / (2.0 * kPi) + 0.5);
}

/// Finds where a ring of these radii, about the z axis, may meet a bounded convex body with the
/// pose X. A ring is a union of balls: a plane that parts the body from one of them parts it from
/// all on an arc. docs/theory.md, "Tori".
void find_torus_arcs(const ConvexView& body, const Pose& X, double major, double minor,
                     TorusArcs& arcs);

}  // namespace volcontact
