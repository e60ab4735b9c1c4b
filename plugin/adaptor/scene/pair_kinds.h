// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "adaptor/geoms/pair_rules.h"

namespace volcontact::adaptor {

/// One pair for every two kinds of geoms of which some can touch by their masks, and all pairs that
/// are named; ascending. What is said of pairs by kind is asked of these alone, so that nobody goes
/// through all pairs. `kinds`: by geom.
std::vector<GeomPair> pairs_of_kinds(const PairRules& rules, const std::vector<int>& kinds);

/// Kinds for pairs_of_kinds: geoms with equal keys are of one kind. `key_of(geom)` is ordered.
template <typename Map, typename KeyOf>
std::vector<int> kinds_of(const PairRules& rules, KeyOf&& key_of) {
  Map numbers;
  std::vector<int> kinds(static_cast<std::size_t>(rules.geoms()), -1);
  for (const int geom : rules.touching()) {
    const auto next = static_cast<int>(numbers.size());
    kinds[static_cast<std::size_t>(geom)] = numbers.emplace(key_of(geom), next).first->second;
  }
  return kinds;
}

}  // namespace volcontact::adaptor
