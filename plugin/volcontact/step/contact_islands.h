// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "volcontact/step/mechanism.h"

namespace volcontact {

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

/// The contact places of a scene by islands: what moves in one depends on no contact of another
/// within a step. Two places are of one island when a moving tree has both, or a chain of such
/// places is between them; what does not move joins nothing. Memory is reused from call to call.
class ContactIslands {
 public:
  /// `joined`: pairs of degrees of freedom that something else joins. An island may have trees of
  /// that alone and no place.
  void build(const MechanismTrees& trees, std::span<const ContactPlace> places,
             std::span<const std::pair<int, int>> joined = {});

  int count() const { return static_cast<int>(islands_.size()); }
  /// Indices of the places of an island, ascending.
  std::span<const int> places(int island) const;
  /// The trees of an island, so ordered that those which touch are near each other: by the method
  /// of Cuthill and McKee.
  std::span<const DofRange> trees(int island) const;
  /// Of all its trees [kg].
  double mass(int island) const { return islands_[size(island)].mass; }
  /// Where the trees of a place are in that list: of body a, of body b; negative when it does not
  /// move.
  std::pair<int, int> trees_of(int place) const;
  /// The island of a degree of freedom; negative when nothing joins or touches its tree.
  int island_of(int dof) const { return island_of_[size(trees_->tree_of_dof[size(dof)])]; }

 private:
  struct Island {
    int places_begin = 0;
    int places_end = 0;
    int trees_begin = 0;
    int trees_end = 0;
    double mass = 0.0;
  };
  void link(std::span<const ContactPlace> places, std::span<const std::pair<int, int>> joined);
  void visit_from(int tree);
  void add_island(int tree);
  void sort_places();

  const MechanismTrees* trees_ = nullptr;
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

}  // namespace volcontact
