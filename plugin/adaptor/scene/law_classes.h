// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <mutex>
#include <tuple>
#include <vector>

#include "adaptor/geoms/pair_rules.h"
#include "adaptor/keys/materials.h"

namespace volcontact::adaptor {

/// The laws of a scene: made once for all pairs of the same materials, frictions and
/// volcontact/pair, when the first of them is asked for. Any number of threads may ask.
class LawClasses {
 public:
  struct Laws {
    ContactLaws laws;
    double stiffness;  ///< PairLaws::stiffness [N/m^3]
  };

  /// Refers to `keys`.
  LawClasses(const mjModel* m, const SceneKeys& keys);

  const Laws& of(const GeomPair& pair) const;

  /// In words, with where each number comes from.
  PairLaws in_words(const mjModel* m, const GeomPair& pair) const;

  /// Reads the laws of all pairs: one after the other those of each two materials and frictions, of
  /// very many frictions those of the least and the largest. Throws what combine() throws. Calls
  /// `visit(pair, laws)` with one pair of each.
  template <typename Visit>
  void read_all(const mjModel* m, const PairRules& rules, Visit&& visit) const {
    for (const GeomPair& pair : examples(rules)) visit(pair, in_words(m, pair));
    check_extremes(m, rules);
  }

 private:
  using Key = std::tuple<int, double, int, double, int>;
  int material_of(int geom) const {
    return keys_->material_of_geom[static_cast<std::size_t>(geom)];
  }
  double friction_of(int geom, int native) const {
    return native < 0 ? of_geom_[static_cast<std::size_t>(geom)]
                      : of_pair_[static_cast<std::size_t>(native)];
  }
  Key key_of(const GeomPair& pair) const;
  Side side(int geom, double friction) const;
  const KeyedValues* listed(const GeomPair& pair) const;
  bool has_few_kinds(const PairRules& rules) const;
  std::vector<GeomPair> examples(const PairRules& rules) const;
  void check_extremes(const mjModel* m, const PairRules& rules) const;

  const SceneKeys* keys_;
  std::vector<double> of_geom_, of_pair_;  // sliding friction
  mutable std::mutex mutex_;
  mutable std::map<Key, Laws> known_;
};

}  // namespace volcontact::adaptor
