// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "volcontact/base/thread_team.h"
#include "volcontact/pair/octree/cell.h"

namespace volcontact {

/// Memory of sort_by_site, reused from call to call.
struct SiteScratch {
  /// What is asked of a leaf again and again.
  struct Leaf {
    Aabb box;  ///< of the volume in it
    double volume;
    double certain;  ///< of which this much is certain
  };
  std::vector<Leaf> leaves;
  std::vector<int> parent;  ///< union-find over leaves
  std::vector<int> order;
  std::vector<int> sorted;
  std::vector<double> weight;   ///< by region: volume if it stands for itself, else 0
  std::vector<double> certain;  ///< by region
};

/// Sorts the leaves (indices of `cells`) by connected region, keeping their order within one, and
/// writes to `ends` where each region ends. Leaves whose contents share a part of a side, up to
/// `slack` [m], belong together when both hold volume. A speck of which no more volume is certain
/// than `rounding` [m^3] is no site of its own and goes with the nearest region that is.
/// docs/theory.md, "Sites".
void sort_by_site(ThreadTeam& team, std::span<const Cell> cells, double slack, double rounding,
                  std::vector<int>& leaves, std::vector<int>& ends, SiteScratch& scratch);

}  // namespace volcontact
