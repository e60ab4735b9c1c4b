// SPDX-License-Identifier: Apache-2.0
#include "adaptor/geoms/flush_groups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "volcontact/base/disjoint_sets.h"
#include "volcontact/base/sizes.h"

namespace volcontact::adaptor {
namespace {

// How far apart planes may be that are one, of the length of the smaller box, and axes that are
// parallel [-].
constexpr double kFlush = 1e-9;

Pose pose_at(const mjtNum* position, const mjtNum* quaternion) {
  mjtNum rotation[9];
  mju_quat2Mat(rotation, quaternion);
  return {Mat3::from_rows(rotation), Vec3::from(position)};
}

// The body against which a body cannot move, as all that is fixed to it: a mocap body or the world
// for what has no joints.
int rigid_root(const mjModel* m, int body) {
  if (m->body_weldid[body] != 0) return m->body_weldid[body];
  const int root = m->body_rootid[body];
  return m->body_mocapid[root] >= 0 ? root : 0;
}

Pose pose_in_rigid_root(const mjModel* m, int geom) {
  int body = m->geom_bodyid[geom];
  const int root = rigid_root(m, body);
  Pose X_RG = pose_at(m->geom_pos + 3 * geom, m->geom_quat + 4 * geom);
  for (; body != root; body = m->body_parentid[body]) {
    X_RG = pose_at(m->body_pos + 3 * body, m->body_quat + 4 * body) * X_RG;
  }
  return X_RG;
}

// The rotation by quarter turns that this one is but for rounding; none where it is another.
std::optional<Mat3> quarter_turns(const Mat3& rotation) {
  const Mat3 rounded = rotation.rounded();
  if ((rotation - rounded).cwiseAbs().maxCoeff() > kFlush) return {};
  return rounded;
}

using Block = FlushGroups::Block;

double length_of(const Aabb& box) { return (box.max - box.min).maxCoeff(); }

// Ends of the block along the axes of F, to which its own are parallel.
Aabb bounds_in(const Pose& X_RF, const Block& block, const Mat3& turns) {
  const Vec3 half = turns.cwiseAbs() * block.half_sizes;
  const Vec3 center = X_RF.rotation.transpose() * (block.X_RG.translation - X_RF.translation);
  return {center - half, center + half};
}

// Whether the two meet or overlap and a plane face of one goes on in the other.
bool continue_each_other(const Aabb& a, const Aabb& b) {
  const double room = kFlush * std::min(length_of(a), length_of(b));
  const auto overlap = [&](int i) {
    return std::min(a.max[i], b.max[i]) - std::max(a.min[i], b.min[i]);
  };
  const auto is_plane = [&](int i) {
    return std::abs(a.min[i] - b.min[i]) <= room || std::abs(a.max[i] - b.max[i]) <= room;
  };
  for (int i = 0; i < 3; ++i) {
    const int u = (i + 1) % 3, v = (i + 2) % 3;
    if (overlap(i) >= -room && overlap(u) > room && overlap(v) > room &&
        (is_plane(u) || is_plane(v))) {
      return true;
    }
  }
  return false;
}

// Along which the blocks are spread most.
int widest_axis(const std::vector<Block>& blocks) {
  Vec3 low = Vec3::Constant(kInfinity), high = Vec3::Constant(-kInfinity);
  for (const Block& block : blocks) {
    low = low.cwiseMin(block.bounds.min);
    high = high.cwiseMax(block.bounds.min);
  }
  return (high - low).largest();
}

// Joins blocks with parallel axes, by their bounds.
void join_neighbours(const std::vector<Block>& blocks, std::vector<int>& sets) {
  const int axis = widest_axis(blocks);
  std::vector<std::size_t> order(blocks.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto low = [&](std::size_t i) { return blocks[i].bounds.min[axis]; };
  std::sort(order.begin(), order.end(), [&](auto i, auto j) { return low(i) < low(j); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Aabb& one = blocks[order[i]].bounds;
    const double reach = one.max[axis] + kFlush * length_of(one);
    for (std::size_t j = i + 1; j < order.size() && low(order[j]) <= reach; ++j) {
      if (continue_each_other(one, blocks[order[j]].bounds)) {
        join_sets(sets, static_cast<int>(order[i]), static_cast<int>(order[j]));
      }
    }
  }
}

// Ends that lie in one plane become the same number.
void round_off(std::vector<Aabb*>& boxes) {
  double length = 0.0;
  for (const Aabb* box : boxes) length = std::max(length, length_of(*box));
  std::vector<double*> ends;
  for (int axis = 0; axis < 3; ++axis) {
    ends.clear();
    for (Aabb* box : boxes) ends.insert(ends.end(), {&box->min[axis], &box->max[axis]});
    std::sort(ends.begin(), ends.end(), [](const double* x, const double* y) { return *x < *y; });
    double plane = *ends.front();
    for (double* end : ends) {
      if (*end - plane > kFlush * length) plane = *end;
      *end = plane;
    }
  }
}

double largest_face_of(const Aabb& box) {
  std::array<double, 3> sides{};
  for (int i = 0; i < 3; ++i) sides[size(i)] = box.max[i] - box.min[i];
  std::sort(sides.begin(), sides.end());
  return sides[1] * sides[2];
}

}  // namespace

FlushGroups::FlushGroups(const mjModel* m, const SceneKeys& keys, const std::vector<Shape>& solids,
                         const PairRules& rules)
    : rules_(&rules) {
  find_groups(m, keys, solids);
  for (const std::vector<int>& group : groups_) {
    std::vector<int>& differing = differing_.emplace_back();
    for (const int geom : group) {
      const auto is_like = [&](int other) { return rules.are_alike(geom, other); };
      if (std::none_of(differing.begin(), differing.end(), is_like)) differing.push_back(geom);
    }
  }
}

void FlushGroups::find_groups(const mjModel* m, const SceneKeys& keys,
                              const std::vector<Shape>& solids) {
  // Boxes of one body, material and friction; in it, of parallel axes.
  std::map<std::tuple<int, int, double>, std::vector<std::vector<Block>>> alike;
  for (int geom = 0; geom < m->ngeom; ++geom) {
    const Box* box = std::get_if<Box>(&solids[size(geom)]);
    if (!box || !rules_->can_touch(geom)) continue;
    auto& sets = alike[{rigid_root(m, m->geom_bodyid[geom]), keys.material_of_geom[size(geom)],
                        m->geom_friction[3 * geom]}];
    Block block{geom, pose_in_rigid_root(m, geom), box->half_sizes(), {}};
    const auto is_parallel = [&](const std::vector<Block>& set) {
      const Pose& X_RF = set.front().X_RG;
      const auto turns = quarter_turns(X_RF.rotation.transpose() * block.X_RG.rotation);
      if (turns) block.bounds = bounds_in(X_RF, block, *turns);
      return turns.has_value();
    };
    const auto set = std::find_if(sets.begin(), sets.end(), is_parallel);
    if (set != sets.end()) {
      set->push_back(block);
    } else {
      block.bounds = {-block.half_sizes, block.half_sizes};
      sets.push_back({block});
    }
  }
  for (const auto& [key, sets] : alike) {
    for (const std::vector<Block>& blocks : sets) {
      if (blocks.size() < 2) continue;
      std::vector<int> parents;
      make_sets(parents, blocks.size());
      join_neighbours(blocks, parents);
      std::map<int, std::vector<const Block*>> members;
      for (std::size_t i = 0; i < blocks.size(); ++i) {
        members[root_of(parents, static_cast<int>(i))].push_back(&blocks[i]);
      }
      for (const auto& [root, tiles] : members) {
        if (tiles.size() > 1) add_group(m, tiles);
      }
    }
  }
}

// In the frame of its first geom.
void FlushGroups::add_group(const mjModel* m, const std::vector<const Block*>& blocks) {
  if (tiles_.empty()) {
    for (int geom = 0; geom < m->ngeom; ++geom) tiles_.push_back({geom, -1, {}, {}});
  }
  const auto number = static_cast<int>(groups_.size());
  std::vector<int>& group = groups_.emplace_back();
  const Pose& X_RF = blocks.front()->X_RG;
  std::vector<Aabb*> boxes;
  for (const Block* block : blocks) {
    const Mat3 turns = (X_RF.rotation.transpose() * block->X_RG.rotation).rounded();
    const Aabb bounds = bounds_in(X_RF, *block, turns);
    tiles_[size(block->geom)] = {blocks.front()->geom, number, {turns, bounds.center()}, bounds};
    boxes.push_back(&tiles_[size(block->geom)].bounds);
    group.push_back(block->geom);
  }
  round_off(boxes);
  Aabb all = *boxes.front();
  for (const Aabb* box : boxes) all = {all.min.cwiseMin(box->min), all.max.cwiseMax(box->max)};
  largest_faces_.push_back(largest_face_of(all));
}

FlushGroups::Family FlushGroups::family_of(const GeomPair& pair) const {
  if (empty()) return {};
  const int group_a = group_of(pair.a), group_b = group_of(pair.b);
  if (group_a < 0 && group_b < 0) return {};
  if (group_a == group_b) return {};
  const auto side = [&](const int& geom, int group) -> std::span<const int> {
    return group < 0 ? std::span(&geom, 1) : std::span(differing_[size(group)]);
  };
  const auto all_can = [&](const int& a) {
    const std::span<const int> others = side(pair.b, group_b);
    return std::all_of(others.begin(), others.end(), [&](int b) {
      GeomPair other;
      return rules_->admit(a, b, other) && other.listed == pair.listed && other.native < 0;
    });
  };
  const std::span<const int> ours = side(pair.a, group_a);
  if (!std::all_of(ours.begin(), ours.end(), all_can)) return {};
  const int first_a = group_a < 0 ? pair.a : groups_[size(group_a)].front();
  const int first_b = group_b < 0 ? pair.b : groups_[size(group_b)].front();
  return {rules_->id(first_a, first_b), first_a > first_b};
}

bool FlushGroups::can_touch_together(const std::vector<int>& group) const {
  const std::vector<int>& touching = rules_->touching();
  return std::any_of(touching.begin(), touching.end(), [&](int geom) {
    GeomPair pair;
    return rules_->admit(geom, group.front(), pair) && family_of(pair).number >= 0;
  });
}

}  // namespace volcontact::adaptor
