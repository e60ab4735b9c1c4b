// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "adaptor/geoms/fixed_solids.h"
#include "adaptor/geoms/pair_rules.h"

namespace volcontact::adaptor {

/// Leaves out, step by step, the pairs whose bounds are apart: of few by comparison of all, of many
/// by a sweep of the solids that move along one axis, and a tree of those that do not. Const once
/// made.
class Cull {
 public:
  /// `solids` has one entry per geom of the model; those of no pair are not looked at. Refers to
  /// `rules` and `solids`.
  Cull(const PairRules& rules, const std::vector<Shape>& solids);

  /// Memory of one call, reused. What it holds changes no result.
  struct Scratch {
    std::vector<Bounds> boxes;    ///< of the solids that move
    std::vector<char> rough;      ///< whether they are larger than need be
    std::vector<int> sorted;      ///< them by their lower ends, as they were sorted last
    std::vector<double> low;      ///< by solid, along the axis of the sweep
    std::vector<Bounds> ordered;  ///< in the order of the sweep
    std::vector<std::pair<double, double>> ends;
    FixedSolids::Kept fixed;   ///< of the solids that do not move
    std::vector<PairId> near;  ///< result, ascending
  };

  void run(const mjData* d, Scratch& scratch) const;

 private:
  struct Listed {
    PairId id;
    int a, b;  // a plane and a place in moving_; else two places in moving_
  };
  const Shape& solid_of(int geom) const { return (*solids_)[static_cast<std::size_t>(geom)]; }
  const Bounds& exact_box(const mjData* d, int place, Scratch& scratch) const;
  void list_pairs();
  void tell_fixed_apart();
  void compare_all(const mjData* d, Scratch& scratch) const;
  void reach_planes(const mjData* d, Scratch& scratch) const;
  void sort_moving(Scratch& scratch) const;
  void sweep(const mjData* d, Scratch& scratch) const;
  void meet_fixed(const mjData* d, Scratch& scratch) const;

  const PairRules* rules_;
  const std::vector<Shape>* solids_;
  bool is_swept_ = false;
  bool is_one_body_ = false;          // all that moves, so that none of it can touch another
  std::vector<int> planes_, moving_;  // geoms that can touch others, ascending
  FixedSolids fixed_;                 // the rest of them, where there are many
  std::vector<Listed> with_plane_, between_;  // where there are few
};

}  // namespace volcontact::adaptor
