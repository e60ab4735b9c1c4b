// SPDX-License-Identifier: Apache-2.0
#include "adaptor/geoms/flush_groups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "adaptor/mujoco/sizes.h"
#include "volcontact/base/disjoint_sets.h"

namespace volcontact::adaptor {
namespace {

// How far apart planes may be that are one, of the length of the smaller box, and axes that are
// parallel [-].
constexpr double kFlush = 1e-9;

Pose pose_at(const mjtNum* position, const mjtNum* quaternion) {
  mjtNum rotation[9];
  mju_quat2Mat(rotation, quaternion);
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  return {Eigen::Map<const RowMajor>(rotation), Eigen::Map<const Vec3>(position)};
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
  const Mat3 rounded = rotation.array().round();
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

// Joins blocks with parallel axes, by their bounds.
void join_neighbours(const std::vector<Block>& blocks, std::vector<int>& sets) {
  std::vector<std::size_t> order(blocks.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto low = [&](std::size_t i) { return blocks[i].bounds.min.x(); };
  std::sort(order.begin(), order.end(), [&](auto i, auto j) { return low(i) < low(j); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Aabb& one = blocks[order[i]].bounds;
    const double reach = one.max.x() + kFlush * length_of(one);
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
                         const std::vector<GeomPair>& pairs) {
  find_groups(m, keys, solids, pairs);
  if (!groups_.empty()) find_families(pairs);
}

void FlushGroups::find_groups(const mjModel* m, const SceneKeys& keys,
                              const std::vector<Shape>& solids,
                              const std::vector<GeomPair>& pairs) {
  std::vector<char> can_touch(solids.size(), 0);
  for (const GeomPair& pair : pairs) can_touch[size(pair.a)] = can_touch[size(pair.b)] = 1;
  // Boxes of one body, material and friction; in it, of parallel axes.
  std::map<std::tuple<int, int, double>, std::vector<std::vector<Block>>> alike;
  for (int geom = 0; geom < m->ngeom; ++geom) {
    const Box* box = std::get_if<Box>(&solids[size(geom)]);
    if (!box || !can_touch[size(geom)]) continue;
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
    const Mat3 turns = (X_RF.rotation.transpose() * block->X_RG.rotation).array().round();
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

// A family is complete: each solid of one side can touch each of the other, by the same laws.
void FlushGroups::find_families(const std::vector<GeomPair>& pairs) {
  struct Seen {
    int side_a;  // of the first pair
    std::size_t pairs_wanted;
    int listed;
    bool is_plain = true;
    std::vector<int> pairs{};
  };
  const auto geoms = static_cast<int>(tiles_.size());
  const auto side_of = [&](int geom) {
    const int group = tiles_[size(geom)].group;
    return group < 0 ? geom : geoms + group;
  };
  const auto solids_of = [&](int side) {
    return side < geoms ? std::size_t{1} : groups_[size(side - geoms)].size();
  };
  std::map<std::pair<int, int>, Seen> found;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const int a = side_of(pairs[i].a), b = side_of(pairs[i].b);
    if (a < geoms && b < geoms) continue;
    const auto [at, is_new] =
        found.try_emplace(std::minmax(a, b), Seen{a, solids_of(a) * solids_of(b), pairs[i].listed});
    Seen& seen = at->second;
    seen.is_plain = seen.is_plain && pairs[i].listed == seen.listed && pairs[i].native < 0;
    seen.pairs.push_back(static_cast<int>(i));
  }
  int number = 0;
  for (const auto& [sides, seen] : found) {
    if (!seen.is_plain || seen.pairs.size() != seen.pairs_wanted) continue;
    if (families_.empty()) families_.resize(pairs.size());
    for (const int pair : seen.pairs) {
      families_[size(pair)] = {number, side_of(pairs[size(pair)].a) != seen.side_a};
    }
    ++number;
  }
}

}  // namespace volcontact::adaptor
