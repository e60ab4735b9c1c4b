// SPDX-License-Identifier: Apache-2.0
#include "adaptor/scene/law_classes.h"

#include <algorithm>
#include <set>

#include "adaptor/geoms/native_pairs.h"
#include "adaptor/keys/scene_key.h"
#include "adaptor/scene/pair_kinds.h"

namespace volcontact::adaptor {

LawClasses::LawClasses(const mjModel* m, const SceneKeys& keys) : keys_(&keys) {
  for (int geom = 0; geom < m->ngeom; ++geom) of_geom_.push_back(m->geom_friction[3 * geom]);
  for (int pair = 0; pair < m->npair; ++pair) of_pair_.push_back(m->pair_friction[5 * pair]);
}

LawClasses::Key LawClasses::key_of(const GeomPair& pair) const {
  return {material_of(pair.a), friction_of(pair.a, pair.native), material_of(pair.b),
          friction_of(pair.b, pair.native), pair.listed};
}

Side LawClasses::side(int geom, double friction) const {
  const int material = material_of(geom);
  return {"", friction,
          material < 0 ? nullptr : &keys_->materials[static_cast<std::size_t>(material)]};
}

const KeyedValues* LawClasses::listed(const GeomPair& pair) const {
  return pair.listed < 0 ? nullptr : &keys_->pairs[static_cast<std::size_t>(pair.listed)].keyed;
}

const LawClasses::Laws& LawClasses::of(const GeomPair& pair) const {
  const Key key = key_of(pair);
  const std::lock_guard lock(mutex_);
  const auto found = known_.find(key);
  if (found != known_.end()) return found->second;
  PairLaws made =
      combine(side(pair.a, std::get<1>(key)), side(pair.b, std::get<3>(key)), listed(pair));
  made.laws.formulation = keys_->options.formulation;
  return known_.emplace(key, Laws{std::move(made.laws), made.stiffness}).first->second;
}

PairLaws LawClasses::in_words(const mjModel* m, const GeomPair& pair) const {
  const auto named = [&](int geom) {
    Side of = side(geom, friction_of(geom, pair.native));
    of.name = label(m, mjOBJ_GEOM, geom);
    if (pair.native >= 0) of.friction_giver = native_pair_label(m, pair.native);
    return of;
  };
  PairLaws laws = combine(named(pair.a), named(pair.b), listed(pair));
  laws.laws.formulation = keys_->options.formulation;
  return laws;
}

bool LawClasses::has_few_kinds(const PairRules& rules) const {
  constexpr std::size_t kFew = 64;  // of which any two may meet
  std::set<std::pair<int, double>> kinds;
  for (const int geom : rules.touching()) {
    kinds.emplace(material_of(geom), friction_of(geom, -1));
    if (kinds.size() > kFew) return false;
  }
  return true;
}

std::vector<GeomPair> LawClasses::examples(const PairRules& rules) const {
  const bool with_friction = has_few_kinds(rules);
  const auto kinds = kinds_of<std::map<std::pair<int, double>, int>>(rules, [&](int geom) {
    return std::pair{material_of(geom), with_friction ? friction_of(geom, -1) : 0.0};
  });
  std::vector<GeomPair> pairs = pairs_of_kinds(rules, kinds);
  std::set<Key> seen;
  std::erase_if(pairs, [&](const GeomPair& pair) { return !seen.insert(key_of(pair)).second; });
  return pairs;
}

// What is in range at the ends is so between them.
void LawClasses::check_extremes(const mjModel* m, const PairRules& rules) const {
  if (has_few_kinds(rules)) return;
  std::map<int, std::pair<double, double>> ends;  // by material
  for (const int geom : rules.touching()) {
    const double friction = friction_of(geom, -1);
    auto& [least, largest] = ends.try_emplace(material_of(geom), friction, friction).first->second;
    least = std::min(least, friction);
    largest = std::max(largest, friction);
  }
  for (const GeomPair& pair : examples(rules)) {
    const auto &of_a = ends.at(material_of(pair.a)), &of_b = ends.at(material_of(pair.b));
    for (const double friction_a : {of_a.first, of_a.second}) {
      for (const double friction_b : {of_b.first, of_b.second}) {
        Side a = side(pair.a, friction_a), b = side(pair.b, friction_b);
        a.name = label(m, mjOBJ_GEOM, pair.a);
        b.name = label(m, mjOBJ_GEOM, pair.b);
        combine(a, b, listed(pair));
      }
    }
  }
}

}  // namespace volcontact::adaptor
