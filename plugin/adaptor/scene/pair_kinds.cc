// SPDX-License-Identifier: Apache-2.0
#include "adaptor/scene/pair_kinds.h"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

namespace volcontact::adaptor {
namespace {

// Geoms of one kind with the same masks, by rigid body.
struct Alike {
  int contype, conaffinity;
  std::vector<std::vector<int>> by_weld;
};

bool admits_by_masks(const PairRules& rules, int a, int b, GeomPair& pair) {
  return rules.admit(a, b, pair) && pair.origin == PairOrigin::kMasks;
}

// Few pairs of rigid bodies are refused, so that the first few tell.
std::optional<GeomPair> some_pair(const PairRules& rules, const Alike& these, const Alike& those) {
  GeomPair pair;
  if (!rules.masks_match(these.by_weld.front().front(), those.by_weld.front().front())) return {};
  for (const std::vector<int>& as : these.by_weld) {
    for (const std::vector<int>& bs : those.by_weld) {
      if (rules.weld_of(as.front()) == rules.weld_of(bs.front())) continue;
      for (const int a : as) {
        for (const int b : bs) {
          if (admits_by_masks(rules, a, b, pair)) return pair;
        }
      }
    }
  }
  return {};
}

}  // namespace

std::vector<GeomPair> pairs_of_kinds(const PairRules& rules, const std::vector<int>& kinds) {
  std::vector<GeomPair> pairs = rules.named();
  std::map<std::tuple<int, int, int, int>, std::vector<int>> bodies;  // the last: the rigid body
  for (const int geom : rules.touching()) {
    const auto [contype, conaffinity] = rules.masks(geom);
    bodies[{kinds[static_cast<std::size_t>(geom)], contype, conaffinity, rules.weld_of(geom)}]
        .push_back(geom);
  }
  std::vector<Alike> alike;
  int kind = -1;
  for (auto& [key, geoms] : bodies) {
    const auto [of_kind, contype, conaffinity, weld] = key;
    if (alike.empty() || of_kind != kind || alike.back().contype != contype ||
        alike.back().conaffinity != conaffinity) {
      alike.push_back({contype, conaffinity, {}});
      kind = of_kind;
    }
    alike.back().by_weld.push_back(std::move(geoms));
  }
  for (std::size_t i = 0; i < alike.size(); ++i) {
    for (std::size_t j = i; j < alike.size(); ++j) {
      if (const auto pair = some_pair(rules, alike[i], alike[j])) pairs.push_back(*pair);
    }
  }
  std::sort(pairs.begin(), pairs.end(), [](const GeomPair& x, const GeomPair& y) {
    return std::pair(x.a, x.b) < std::pair(y.a, y.b);
  });
  return pairs;
}

}  // namespace volcontact::adaptor
