// SPDX-License-Identifier: Apache-2.0
#include "adaptor/geoms/pair_rules.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace volcontact::adaptor {
namespace {

// How many geoms of which masks, in the order of the masks' numbers.
using Census = std::vector<std::pair<int, std::int64_t>>;

void sort_and_merge(Census& census) {
  std::sort(census.begin(), census.end());
  std::size_t kept = 0;
  for (const auto& [masks, count] : census) {
    if (kept > 0 && census[kept - 1].first == masks) {
      census[kept - 1].second += count;
    } else {
      census[kept++] = {masks, count};
    }
  }
  census.resize(kept);
}

}  // namespace

PairRules::PairRules(const mjModel* m, const SceneKeys& keys, bool listed_only)
    : listed_only_(listed_only || keys.options.pairs == PairRule::kListed),
      by_masks_(collides_by_masks(m)),
      filters_parents_(!(m->opt.disableflags & mjDSBL_FILTERPARENT)),
      geoms_(at(m->ngeom)),
      welds_(m->body_weldid, m->body_weldid + m->nbody),
      has_exclude_(at(m->nbody), 0) {
  for (const int weld : welds_) parent_welds_.push_back(welds_[at(m->body_parentid[weld])]);
  for (int geom = 0; geom < m->ngeom; ++geom) {
    const int body = m->geom_bodyid[geom];
    geoms_[at(geom)] = {m->geom_contype[geom],
                        m->geom_conaffinity[geom],
                        body,
                        keys.is_solid(geom),
                        m->geom_type[geom] == mjGEOM_PLANE,
                        false,
                        m->body_mocapid[m->body_rootid[body]] >= 0};
  }
  for (const auto& [pair, listed] : keys.pair_of_geoms) {
    named_[id(pair.first, pair.second)].listed = listed;
  }
  for (int i = collides_by_pairs(m) ? m->npair - 1 : -1; i >= 0; --i) {  // of several the first
    if (m->pair_geom1[i] < 0 || m->pair_geom2[i] < 0) continue;
    named_[id(m->pair_geom1[i], m->pair_geom2[i])].native = i;
  }
  for (const auto& [pair, naming] : named_) {
    geoms_[at(static_cast<int>(pair / geoms()))].is_named = true;
    geoms_[at(static_cast<int>(pair % geoms()))].is_named = true;
  }
  for (int i = 0; i < m->nexclude; ++i) {
    const auto [low, high] = excluded_bodies(m->exclude_signature[i]);
    if (low < 0 || high >= m->nbody) continue;
    excluded_.insert(PairId{low} * m->nbody + high);
    has_exclude_[at(low)] = has_exclude_[at(high)] = 1;
  }
  count_pairs();
}

bool PairRules::is_parent_and_child(int weld_a, int weld_b) const noexcept {
  if (!filters_parents_ || weld_a == 0 || weld_b == 0) return false;
  return parent_welds_[at(weld_a)] == weld_b || parent_welds_[at(weld_b)] == weld_a;
}

// Of solids on two rigid bodies that are not both planes.
bool PairRules::admits_by_masks(int a, int b) const noexcept {
  if (!by_masks_ || !masks_match(a, b) || is_parent_and_child(weld_of(a), weld_of(b))) return false;
  const int body_a = body_of(a), body_b = body_of(b);
  if (!has_exclude_[at(body_a)] || !has_exclude_[at(body_b)]) return true;
  const auto bodies = static_cast<PairId>(welds_.size());
  return !excluded_.count(std::min(body_a, body_b) * bodies + std::max(body_a, body_b));
}

bool PairRules::admit(int a, int b, GeomPair& pair) const noexcept {
  if (a > b) std::swap(a, b);
  const OfGeom &of_a = geoms_[at(a)], &of_b = geoms_[at(b)];
  if (!of_a.is_solid || !of_b.is_solid) return false;
  pair = {a, b, PairOrigin::kMasks};
  if (of_a.is_named && of_b.is_named) {
    const auto found = named_.find(id(a, b));
    if (found != named_.end()) {
      pair.native = found->second.native;
      pair.listed = found->second.listed;
    }
  }
  if (pair.listed >= 0) {
    pair.origin = PairOrigin::kListed;
    return true;
  }
  if (listed_only_ || (of_a.is_plane && of_b.is_plane) || weld_of(a) == weld_of(b)) return false;
  if (pair.native >= 0) {
    pair.origin = PairOrigin::kExplicit;
    return true;
  }
  return admits_by_masks(a, b);
}

bool PairRules::find(PairId id, GeomPair& pair) const noexcept {
  if (id < 0 || geoms() == 0) return false;
  const PairId a = id / geoms(), b = id % geoms();
  return a < b && b < geoms() && a < geoms() &&
         admit(static_cast<int>(a), static_cast<int>(b), pair);
}

std::vector<GeomPair> PairRules::named() const {
  std::vector<PairId> ids;
  for (const auto& [id, naming] : named_) ids.push_back(id);
  std::sort(ids.begin(), ids.end());
  std::vector<GeomPair> pairs;
  GeomPair pair;
  for (const PairId id : ids) {
    if (find(id, pair)) pairs.push_back(pair);
  }
  return pairs;
}

// With how many others each geom can touch by the masks, pairs that are named left alone: of all
// whose masks match, those of the same rigid body, of its parent and children and of excluded
// bodies do not count. Counts geoms by their masks, so that no two geoms are compared.
void PairRules::count_by_masks(std::vector<std::int64_t>& partners) const {
  std::map<std::tuple<int, int, bool>, int> numbers;
  std::vector<int> masks_of(geoms_.size(), -1), first;
  std::vector<Census> of_body(welds_.size()), of_weld(welds_.size()), of_children(welds_.size());
  Census all;
  for (std::size_t i = 0; i < geoms_.size(); ++i) {
    const OfGeom& geom = geoms_[i];
    if (!geom.is_solid) continue;
    const auto [found, is_new] =
        numbers.try_emplace({geom.contype, geom.conaffinity, geom.is_plane}, std::ssize(first));
    if (is_new) first.push_back(static_cast<int>(i));
    masks_of[i] = found->second;
    of_body[at(geom.body)].emplace_back(found->second, 1);
  }
  for (std::size_t body = 0; body < welds_.size(); ++body) {
    sort_and_merge(of_body[body]);
    Census& weld = of_weld[at(welds_[body])];
    weld.insert(weld.end(), of_body[body].begin(), of_body[body].end());
    all.insert(all.end(), of_body[body].begin(), of_body[body].end());
  }
  sort_and_merge(all);
  for (std::size_t weld = 0; weld < of_weld.size(); ++weld) {
    sort_and_merge(of_weld[weld]);
    const int parent = parent_welds_[weld];
    if (!filters_parents_ || weld == 0 || parent == 0 || of_weld[weld].empty()) continue;
    Census& children = of_children[at(parent)];
    children.insert(children.end(), of_weld[weld].begin(), of_weld[weld].end());
  }
  for (Census& children : of_children) sort_and_merge(children);
  const auto matching = [&](int masks, const Census& census) {
    const int one = first[at(masks)];
    std::int64_t sum = 0;
    for (const auto& [others, count] : census) {
      const int other = first[at(others)];
      if (geoms_[at(one)].is_plane && geoms_[at(other)].is_plane) continue;
      if (masks_match(one, other)) sum += count;
    }
    return sum;
  };
  std::vector<std::int64_t> of_all;
  for (std::size_t masks = 0; masks < first.size(); ++masks) {
    of_all.push_back(matching(static_cast<int>(masks), all));
  }
  std::vector<std::vector<int>> excluded(welds_.size());
  for (const PairId pair : excluded_) {
    const auto bodies = static_cast<PairId>(welds_.size());
    const auto a = static_cast<int>(pair / bodies), b = static_cast<int>(pair % bodies);
    const int weld_a = welds_[at(a)], weld_b = welds_[at(b)];
    if (weld_a == weld_b || is_parent_and_child(weld_a, weld_b)) continue;
    excluded[at(a)].push_back(b);
    excluded[at(b)].push_back(a);
  }
  std::map<std::pair<int, int>, std::int64_t> known;  // by body and masks
  for (std::size_t i = 0; i < geoms_.size(); ++i) {
    if (masks_of[i] < 0) continue;
    const int body = geoms_[i].body, masks = masks_of[i];
    const auto [found, is_new] = known.try_emplace({body, masks}, 0);
    std::int64_t& count = found->second;
    if (is_new) {
      const int weld = welds_[at(body)], parent = parent_welds_[at(weld)];
      count = of_all[at(masks)] - matching(masks, of_weld[at(weld)]) -
              matching(masks, of_children[at(weld)]);
      if (filters_parents_ && weld != 0 && parent != 0) {
        count -= matching(masks, of_weld[at(parent)]);
      }
      for (const int other : excluded[at(body)]) count -= matching(masks, of_body[at(other)]);
    }
    partners[i] = count;
  }
}

void PairRules::count_pairs() {
  std::vector<std::int64_t> partners(geoms_.size(), 0);
  const bool has_masks = by_masks_ && !listed_only_;
  if (has_masks) count_by_masks(partners);
  for (const GeomPair& pair : named()) {
    const bool is_counted = has_masks && weld_of(pair.a) != weld_of(pair.b) &&
                            !(geoms_[at(pair.a)].is_plane && geoms_[at(pair.b)].is_plane) &&
                            admits_by_masks(pair.a, pair.b);
    if (is_counted) continue;
    ++partners[at(pair.a)];
    ++partners[at(pair.b)];
  }
  const auto sum = std::accumulate(partners.begin(), partners.end(), std::int64_t{0});
  count_ = static_cast<std::size_t>(sum / 2);
  partners_.assign(partners.begin(), partners.end());
  for (int geom = 0; geom < geoms(); ++geom) {
    if (can_touch(geom)) touching_.push_back(geom);
  }
}

}  // namespace volcontact::adaptor
