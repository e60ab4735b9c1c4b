// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/pair/torus_pair/torus_patch.h"

namespace volcontact {

inline constexpr int kWholeCircle = -1;

/// The number of arcs; kWholeCircle for all of a circle.
inline int arc_count(const CircleArcs& arcs) { return arcs.whole ? kWholeCircle : arcs.count; }

/// Angles at which the section circles of `ring` change the number of their arcs in `other`, in
/// order [rad]: between samples that differ, by halving and, where one arc or gap comes or goes, by
/// Newton's method. `samples` stand in order.
void find_torus_events(const TorusSize& ring, const Pose& X, const TorusSize& other, bool fine,
                       const std::vector<TorusPatchScratch::Sample>& samples,
                       std::vector<double>& events);

}  // namespace volcontact
