// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "volcontact/pair/cell.h"

namespace volcontact {

/// Memory of sort_by_site, reused from call to call.
struct SiteScratch {
  std::vector<Aabb> boxes;  ///< of the volume in the leaves
  std::vector<int> parent;  ///< union-find over leaves
  std::vector<int> order;
  std::vector<int> sorted;
  std::vector<double> weight;  ///< by region: volume if it stands for itself, else 0
};

/// Sorts the leaves (indices of `cells`) by connected region, keeping their order within one, and
/// writes to `ends` where each region ends. Leaves whose contents share a part of a side, up to
/// `slack` [m], belong together when both hold volume. A speck of which no volume is certain is no
/// site of its own and goes with the nearest region that is. docs/theory.md, "Sites".
void sort_by_site(std::span<const Cell> cells, double slack, std::vector<int>& leaves,
                  std::vector<int>& ends, SiteScratch& scratch);

}  // namespace volcontact
