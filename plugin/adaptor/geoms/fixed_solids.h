// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "adaptor/geoms/bounds_tree.h"
#include "adaptor/mujoco/mujoco_compat.h"

namespace volcontact::adaptor {

/// The solids of a scene that MuJoCo does not move, in a tree. A program may move them all the
/// same: in each call their positions are compared with those that the tree was made of. Of many,
/// orientations are compared only of those that something comes near: the tree is then one of the
/// boxes around the balls in which the solids can turn. Const once made.
class FixedSolids {
 public:
  /// What is kept from call to call. It changes no result.
  struct Kept {
    std::uint64_t owner = 0;  ///< whose it is
    std::uint64_t call = 0;
    std::vector<mjtNum> positions, rotations;
    std::vector<std::uint64_t> compared;  ///< by solid, the call in which its rotation was compared
    std::vector<Bounds> boxes;            ///< of the solids, at the rotations that are kept
    bool may_turn = false;                ///< whether the tree is one of balls
    BoundsTree tree;
    /// By who asks: which of the solids meet bounds somewhat wider than those asked with once, so
    /// that the tree is not asked again while they stay within.
    struct Near {
      Bounds around;
      std::vector<int> places;
      bool is_known = false;
    };
    std::vector<Near> near;
  };

  FixedSolids() = default;
  /// `geoms`: those that do not move, ascending; `solids` has one entry per geom of the model, and
  /// is referred to.
  FixedSolids(const std::vector<Shape>& solids, std::vector<int> geoms);

  const std::vector<int>& geoms() const { return geoms_; }

  /// To be called before `meet`, once for the poses of `d`.
  void follow(const mjData* d, Kept& kept) const;

  /// Calls `visit(geom, bounds)` for each whose bounds are not apart from the given ones, which are
  /// those of number `asker`.
  template <typename Visit>
  void meet(const mjData* d, std::size_t asker, const Bounds& with, Kept& kept,
            Visit&& visit) const {
    const auto look_at = [&](int place) {
      const auto i = static_cast<std::size_t>(place);
      if (!are_apart(with, kept.boxes[i])) visit(geoms_[i], kept.boxes[i]);
    };
    if (!kept.may_turn) {
      for (const int place : near_to(asker, with, kept)) look_at(place);
      return;
    }
    kept.tree.find(with, [&](int place) {
      const auto i = static_cast<std::size_t>(place);
      if (kept.compared[i] != kept.call) follow_turn(d, i, kept);
      look_at(place);
    });
  }

 private:
  const std::vector<int>& near_to(std::size_t asker, const Bounds& with, Kept& kept) const;
  void build(const mjData* d, Kept& kept) const;
  void follow_turn(const mjData* d, std::size_t place, Kept& kept) const;
  Bounds box_of(const mjData* d, std::size_t place) const;
  Bounds ball_of(const mjData* d, std::size_t place) const;

  const std::vector<Shape>* solids_ = nullptr;
  std::uint64_t number_ = 0;  // no other one has it
  std::vector<int> geoms_;
  std::vector<double> radii_;              // about the origins of the geoms [m]
  std::vector<std::pair<int, int>> runs_;  // neighbours among the geoms: first, count
};

}  // namespace volcontact::adaptor
