// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "adaptor/keys/scene_keys.h"
#include "adaptor/mujoco/mjgeoms.h"

namespace volcontact::adaptor {

/// Why two geoms can touch.
enum class PairOrigin : int {
  kMasks = 0,     ///< contype and conaffinity
  kExplicit = 1,  ///< a <pair> of the model
  kListed = 2,    ///< a volcontact/pair/...
};
inline constexpr const char* kPairOriginWords[] = {"contype/conaffinity", "<pair>",
                                                   "volcontact/pair"};

/// Number of two geoms a < b of a model: a ngeom + b, so that pairs in ascending order of their
/// numbers are in that of (a, b).
using PairId = std::int64_t;

/// Two geoms that can touch; `a` has the lower id.
struct GeomPair {
  int a;
  int b;
  PairOrigin origin;
  int listed = -1;  ///< index into SceneKeys::pairs, -1 when no volcontact/pair names the two
  int native = -1;  ///< number of a <pair> of the model that names the two, -1 where none does
};

/// Which geoms can touch: MuJoCo's own rules (bit masks; not within one rigid body; not parent and
/// child; not excluded; explicit pairs whatever the masks say) and the scene's listed pairs, or the
/// latter alone. Holds what is said of each geom and body, and no list of pairs. Const once made.
class PairRules {
 public:
  /// `listed_only`: no others than those listed for volcontact.
  PairRules(const mjModel* m, const SceneKeys& keys, bool listed_only = false);

  int geoms() const noexcept { return static_cast<int>(geoms_.size()); }
  PairId id(int a, int b) const noexcept {
    return a < b ? PairId{a} * geoms() + b : PairId{b} * geoms() + a;
  }

  /// Whether the two can touch, whatever their order; fills in the pair.
  bool admit(int a, int b, GeomPair& pair) const noexcept;
  bool admits(int a, int b) const noexcept {
    GeomPair pair;
    return admit(a, b, pair);
  }
  /// The pair of a number; false where no two geoms with that number can touch.
  bool find(PairId id, GeomPair& pair) const noexcept;

  /// Whether the masks of two geoms let them touch; what else is said of them may forbid it.
  bool masks_match(int a, int b) const noexcept {
    return ((geoms_[at(a)].contype & geoms_[at(b)].conaffinity) |
            (geoms_[at(b)].contype & geoms_[at(a)].conaffinity)) != 0;
  }
  /// contype and conaffinity.
  std::pair<int, int> masks(int geom) const noexcept {
    return {geoms_[at(geom)].contype, geoms_[at(geom)].conaffinity};
  }
  /// Whether two geoms can touch the same ones for all that masks and bodies say.
  bool are_alike(int a, int b) const noexcept {
    return masks(a) == masks(b) && weld_of(a) == weld_of(b) && !is_named(a) && !is_named(b) &&
           !has_exclude_[at(body_of(a))] && !has_exclude_[at(body_of(b))];
  }
  /// Whether a <pair> or a volcontact/pair names a geom, or these two.
  bool is_named(int geom) const noexcept { return geoms_[at(geom)].is_named; }
  bool is_named(int a, int b) const noexcept {
    return is_named(a) && is_named(b) && named_.count(id(a, b)) > 0;
  }
  /// Whether the bodies of a geom cannot move against the world, as long as no mocap body does.
  bool is_static(int geom) const noexcept { return weld_of(geom) == 0 && !geoms_[at(geom)].mocap; }
  int weld_of(int geom) const noexcept { return welds_[at(body_of(geom))]; }
  int body_of(int geom) const noexcept { return geoms_[at(geom)].body; }

  /// How many pairs can touch, and with how many others a geom can.
  std::size_t count() const noexcept { return count_; }
  int partners(int geom) const noexcept { return partners_[at(geom)]; }
  bool can_touch(int geom) const noexcept { return partners(geom) > 0; }
  /// The geoms that can touch others, ascending.
  const std::vector<int>& touching() const noexcept { return touching_; }

  /// Calls `visit(pair)` for each pair that can touch, in ascending order, until it returns false.
  /// Asks of any two geoms that can touch others.
  template <typename Visit>
  void for_each(Visit&& visit) const {
    GeomPair pair;
    for (std::size_t i = 0; i < touching_.size(); ++i) {
      for (std::size_t j = i + 1; j < touching_.size(); ++j) {
        if (admit(touching_[i], touching_[j], pair) && !visit(pair)) return;
      }
    }
  }
  /// The pairs that a <pair> or a volcontact/pair names and that can touch, ascending.
  std::vector<GeomPair> named() const;

 private:
  struct OfGeom {
    int contype = 0, conaffinity = 0;
    int body = 0;
    bool is_solid = false, is_plane = false, is_named = false, mocap = false;
  };
  struct Naming {
    int listed = -1, native = -1;
  };
  static std::size_t at(int index) noexcept { return static_cast<std::size_t>(index); }
  bool is_parent_and_child(int weld_a, int weld_b) const noexcept;
  bool admits_by_masks(int a, int b) const noexcept;
  void count_pairs();
  void count_by_masks(std::vector<std::int64_t>& partners) const;

  bool listed_only_, by_masks_, filters_parents_;
  std::vector<OfGeom> geoms_;
  std::vector<int> welds_, parent_welds_;  // by body
  std::unordered_map<PairId, Naming> named_;
  std::unordered_set<PairId> excluded_;  // pairs of bodies, lower first
  std::vector<char> has_exclude_;        // by body
  std::size_t count_ = 0;
  std::vector<int> partners_, touching_;
};

}  // namespace volcontact::adaptor
