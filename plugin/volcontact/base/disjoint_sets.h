// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace volcontact {

/// Disjoint sets of the numbers 0, 1, ... by a vector of parents: the least number of a set is its
/// root, whatever the order in which sets were joined. Tarjan, "Efficiency of a good but not linear
/// set union algorithm", J. ACM 22(2), 1975; paths are halved on the way.
inline void make_sets(std::vector<int>& parent, std::size_t count) {
  parent.resize(count);
  std::iota(parent.begin(), parent.end(), 0);
}

inline int root_of(std::vector<int>& parent, int i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

inline void join_sets(std::vector<int>& parent, int i, int j) {
  i = root_of(parent, i);
  j = root_of(parent, j);
  parent[i < j ? j : i] = i < j ? i : j;
}

}  // namespace volcontact
