// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "adaptor/geoms/pair_rules.h"
#include "volcontact/shape/shapes.h"

namespace volcontact::adaptor {

/// Boxes of a scene that continue each other: tiles of a floor, a slab of two geoms. Boxes of one
/// group belong to bodies that cannot move against each other, have parallel axes, one material and
/// friction, and each meets or overlaps another of them so that a plane face goes on from one to
/// the other. What touches several of them touches one solid: docs/theory.md, "Flush solids".
/// Const once made.
class FlushGroups {
 public:
  /// A box of a scene that may be one of a group.
  struct Block {
    int geom;
    Pose X_RG;  ///< in the body against which its own cannot move
    Vec3 half_sizes;
    Aabb bounds;  ///< in a frame to which its axes are parallel
  };

  /// Of no scene: without groups.
  FlushGroups() = default;
  /// `solids` has one entry per geom. Refers to `rules`.
  FlushGroups(const mjModel* m, const SceneKeys& keys, const std::vector<Shape>& solids,
              const PairRules& rules);

  bool empty() const { return groups_.empty(); }

  /// Pairs of geoms whose solids on one side or on both are of one group: what touches one of them
  /// may touch others. A family is complete: each solid of one side can touch each of the other, by
  /// the same laws.
  struct Family {
    PairId number = -1;    ///< -1 for a pair that has none
    bool swapped = false;  ///< the sides of the pair change places, so that all are in one order
  };
  Family family_of(const GeomPair& pair) const;

  /// The geom in whose frame a geom's group is described; itself for one of no group.
  int frame_of(int geom) const {
    return empty() ? geom : tiles_[static_cast<std::size_t>(geom)].frame;
  }
  bool is_tile(int geom) const {
    return !empty() && tiles_[static_cast<std::size_t>(geom)].group >= 0;
  }
  /// Pose of the geom in that frame, and of a tile its ends there: ends that lie in one plane are
  /// the same number.
  const Pose& pose(int geom) const { return tiles_[static_cast<std::size_t>(geom)].X_FG; }
  const Aabb& bounds(int geom) const { return tiles_[static_cast<std::size_t>(geom)].bounds; }

  /// The largest face of the box around a tile's group [m^2].
  double largest_face(int geom) const {
    return largest_faces_[static_cast<std::size_t>(tiles_[static_cast<std::size_t>(geom)].group)];
  }

  /// Whether some solid can touch those of a group together.
  bool can_touch_together(const std::vector<int>& group) const;

  /// Geoms by group.
  const std::vector<std::vector<int>>& groups() const { return groups_; }

 private:
  struct Tile {
    int frame;
    int group = -1;
    Pose X_FG;
    Aabb bounds;
  };
  void find_groups(const mjModel* m, const SceneKeys& keys, const std::vector<Shape>& solids);
  void add_group(const mjModel* m, const std::vector<const Block*>& blocks);
  int group_of(int geom) const { return tiles_[static_cast<std::size_t>(geom)].group; }

  const PairRules* rules_ = nullptr;
  std::vector<Tile> tiles_;  // by geom
  std::vector<std::vector<int>> groups_;
  std::vector<std::vector<int>> differing_;  // of each group, without those that are alike
  std::vector<double> largest_faces_;        // by group
};

}  // namespace volcontact::adaptor
