// SPDX-License-Identifier: Apache-2.0
#include "volcontact/step/contact_islands.h"

#include <algorithm>

namespace volcontact {
namespace {

constexpr int kNowhere = MechanismTrees::kNone;

}  // namespace

// The neighbours of each tree, one after the other; itself for a place that it has alone.
void ContactIslands::link(std::span<const ContactPlace> places,
                          std::span<const std::pair<int, int>> joined) {
  const auto tree_of = [this](int body) { return trees_->tree_of_body[size(body)]; };
  ends_.clear();
  pairs_.clear();
  for (const ContactPlace& place : places) {
    const auto& [a, b] = ends_.emplace_back(tree_of(place.body_a), tree_of(place.body_b));
    if (a != kNowhere || b != kNowhere)
      pairs_.emplace_back(a == kNowhere ? b : a, b == kNowhere ? a : b);
  }
  for (const auto& [a, b] : joined) {
    const int tree_a = trees_->tree_of_dof[size(a)], tree_b = trees_->tree_of_dof[size(b)];
    if (tree_a != tree_b) pairs_.emplace_back(tree_a, tree_b);
  }
  link_begin_.assign(trees_->trees.size() + 2, 0);
  for (const auto& [a, b] : pairs_) {
    ++link_begin_[size(a) + 2];
    ++link_begin_[size(b) + 2];
  }
  for (std::size_t i = 2; i < link_begin_.size(); ++i) link_begin_[i] += link_begin_[i - 1];
  links_.resize(size(link_begin_.back()));
  for (const auto& [a, b] : pairs_) {
    links_[size(link_begin_[size(a) + 1]++)] = b;
    links_[size(link_begin_[size(b) + 1]++)] = a;
  }
}

// Fills the queue with all trees that can be reached, near ones first.
void ContactIslands::visit_from(int tree) {
  queue_.clear();
  queue_.push_back(tree);
  seen_[size(tree)] = 1;
  for (std::size_t i = 0; i < queue_.size(); ++i) {
    const int at = queue_[i];
    for (int k = link_begin_[size(at)]; k < link_begin_[size(at) + 1]; ++k) {
      const int other = links_[size(k)];
      if (seen_[size(other)]) continue;
      seen_[size(other)] = 1;
      queue_.push_back(other);
    }
  }
}

void ContactIslands::add_island(int tree) {
  visit_from(tree);
  const int far = queue_.back();
  for (const int other : queue_) seen_[size(other)] = 0;
  visit_from(far);
  const int island = count();
  const int begin = static_cast<int>(ordered_trees_.size());
  double mass = 0.0;
  for (std::size_t i = queue_.size(); i-- > 0;) {
    const std::size_t member = size(queue_[i]);
    island_of_[member] = island;
    rank_[member] = static_cast<int>(ordered_trees_.size()) - begin;
    ordered_trees_.push_back(trees_->trees[member]);
    mass += trees_->mass[member];
  }
  islands_.push_back({0, 0, begin, static_cast<int>(ordered_trees_.size()), mass});
}

void ContactIslands::sort_places() {
  const auto island_of = [&](const std::pair<int, int>& ends) {
    const int tree = std::max(ends.first, ends.second);
    return tree == kNowhere ? kNowhere : island_of_[size(tree)];
  };
  for (const auto& ends : ends_) {
    if (const int island = island_of(ends); island != kNowhere) ++islands_[size(island)].places_end;
  }
  int count = 0;
  next_.clear();
  for (Island& island : islands_) {
    island.places_begin = count;
    island.places_end = count += island.places_end;
    next_.push_back(island.places_begin);
  }
  ordered_places_.resize(size(count));
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    const int island = island_of(ends_[i]);
    if (island != kNowhere) ordered_places_[size(next_[size(island)]++)] = static_cast<int>(i);
  }
}

void ContactIslands::build(const MechanismTrees& trees, std::span<const ContactPlace> places,
                           std::span<const std::pair<int, int>> joined) {
  trees_ = &trees;
  link(places, joined);
  islands_.clear();
  ordered_trees_.clear();
  const std::size_t count = trees.trees.size();
  seen_.assign(count, 0);
  island_of_.assign(count, kNowhere);
  rank_.assign(count, 0);
  for (int tree = 0; tree < static_cast<int>(count); ++tree) {
    const bool alone = link_begin_[size(tree)] == link_begin_[size(tree) + 1];
    if (!alone && !seen_[size(tree)]) add_island(tree);
  }
  sort_places();
}

std::span<const int> ContactIslands::places(int island) const {
  const Island& at = islands_[size(island)];
  return {ordered_places_.data() + at.places_begin, size(at.places_end - at.places_begin)};
}

std::span<const DofRange> ContactIslands::trees(int island) const {
  const Island& at = islands_[size(island)];
  return {ordered_trees_.data() + at.trees_begin, size(at.trees_end - at.trees_begin)};
}

std::pair<int, int> ContactIslands::trees_of(int place) const {
  const auto [a, b] = ends_[size(place)];
  return {a == kNowhere ? kNowhere : rank_[size(a)], b == kNowhere ? kNowhere : rank_[size(b)]};
}

}  // namespace volcontact
