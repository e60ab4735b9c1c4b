// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "adaptor/mujoco/mujoco_compat.h"
#include "volcontact/base/types.h"

namespace volcontact::adaptor {

/// Where two bodies meet: six coordinates of the relative motion of a against b, along n, about
/// t_1, about t_2, along t_1, along t_2, about n.
struct ContactPlace {
  int body_a = 0;
  int body_b = 0;
  Vec3 point = Vec3::Zero();     ///< of the world [m]
  Mat3 axes = Mat3::Identity();  ///< t_1, t_2, n by columns, in the world
  /// Of a against b, the motion at the point that no degree of freedom makes.
  Twist driven = {};
};

/// A kinematic tree: its degrees of freedom, which stand together.
struct DofRange {
  int begin = 0;
  int end = 0;

  int size() const { return end - begin; }
};

/// The contact places of a scene by islands: what moves in one depends on no contact of another
/// within a step. Two places are of one island when a moving tree has both, or a chain of such
/// places is between them; what does not move joins nothing. Memory is reused from call to call.
class ContactIslands {
 public:
  /// `joined`: pairs of degrees of freedom that something else joins. An island may have trees of
  /// that alone and no place.
  void build(const mjModel* m, std::span<const ContactPlace> places,
             std::span<const std::pair<int, int>> joined = {});

  int count() const { return static_cast<int>(islands_.size()); }
  /// Indices of the places of an island, ascending.
  std::span<const int> places(int island) const;
  /// The trees of an island, so ordered that those which touch are near each other: by the method
  /// of Cuthill and McKee.
  std::span<const DofRange> trees(int island) const;
  /// Where the trees of a place are in that list: of body a, of body b; negative when it does not
  /// move.
  std::pair<int, int> trees_of(int place) const;
  /// The island of a degree of freedom; negative when nothing joins or touches its tree.
  int island_of(const mjModel* m, int dof) const;

 private:
  struct Island {
    int places_begin = 0;
    int places_end = 0;
    int trees_begin = 0;
    int trees_end = 0;
  };
  int tree_of(const mjModel* m, int body) const;
  void find_trees(const mjModel* m);
  void link(const mjModel* m, std::span<const ContactPlace> places,
            std::span<const std::pair<int, int>> joined);
  void visit_from(int tree);
  void add_island(int tree);
  void sort_places();

  std::vector<DofRange> trees_;
  std::vector<int> tree_of_root_;           // by root body
  std::vector<std::pair<int, int>> ends_;   // of each place, its two trees or negative
  std::vector<std::pair<int, int>> pairs_;  // of trees that are linked
  std::vector<int> link_begin_, links_;     // neighbours of each tree
  std::vector<int> queue_;                  // of one search through neighbours
  std::vector<char> seen_;
  std::vector<int> island_of_, rank_;  // of each tree; its place in the island
  std::vector<DofRange> ordered_trees_;
  std::vector<int> ordered_places_, next_;
  std::vector<Island> islands_;
};

}  // namespace volcontact::adaptor
