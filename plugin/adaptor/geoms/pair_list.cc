// SPDX-License-Identifier: Apache-2.0
#include "adaptor/geoms/pair_list.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace volcontact::adaptor {
namespace {

bool masks_match(const mjModel* m, int a, int b) {
  return (m->geom_contype[a] & m->geom_conaffinity[b]) != 0 ||
         (m->geom_contype[b] & m->geom_conaffinity[a]) != 0;
}

bool are_parent_and_child(const mjModel* m, int weld_a, int weld_b) {
  if (m->opt.disableflags & mjDSBL_FILTERPARENT) return false;
  if (weld_a == 0 || weld_b == 0) return false;
  const auto parent = [m](int weld) { return m->body_weldid[m->body_parentid[weld]]; };
  return parent(weld_a) == weld_b || parent(weld_b) == weld_a;
}

std::map<std::pair<int, int>, int> explicit_pairs(const mjModel* m) {
  std::map<std::pair<int, int>, int> pairs;
  if (!collides_by_pairs(m)) return pairs;
  for (int i = 0; i < m->npair; ++i) {
    pairs.emplace(std::minmax(m->pair_geom1[i], m->pair_geom2[i]), i);
  }
  return pairs;
}

class PairRules {
 public:
  PairRules(const mjModel* m, const SceneKeys& keys, bool listed_only)
      : m_(m),
        keys_(keys),
        listed_only_(listed_only),
        explicit_(explicit_pairs(m)),
        excluded_(m->exclude_signature, m->exclude_signature + m->nexclude) {}

  // Whether the two can touch; fills in why.
  bool admit(GeomPair& pair) const {
    const int a = pair.a, b = pair.b;
    if (!keys_.is_solid(a) || !keys_.is_solid(b)) return false;
    const auto native = explicit_.find({a, b});
    if (native != explicit_.end()) pair.native = native->second;
    const auto listed = keys_.pair_of_geoms.find({a, b});
    if (listed != keys_.pair_of_geoms.end()) {
      pair.listed = listed->second;
      pair.origin = PairOrigin::kListed;
      return true;
    }
    if (listed_only_) return false;
    if (m_->geom_type[a] == mjGEOM_PLANE && m_->geom_type[b] == mjGEOM_PLANE) return false;
    const int body_a = m_->geom_bodyid[a], body_b = m_->geom_bodyid[b];
    const int weld_a = m_->body_weldid[body_a], weld_b = m_->body_weldid[body_b];
    if (weld_a == weld_b) return false;
    pair.origin = PairOrigin::kExplicit;
    if (pair.native >= 0) return true;
    pair.origin = PairOrigin::kMasks;
    return collides_by_masks(m_) && masks_match(m_, a, b) &&
           !are_parent_and_child(m_, weld_a, weld_b) &&
           !excluded_.count(exclude_signature(body_a, body_b));
  }

 private:
  const mjModel* m_;
  const SceneKeys& keys_;
  bool listed_only_;
  std::map<std::pair<int, int>, int> explicit_;
  std::set<int> excluded_;
};

// With -max instead of max both ends are lower bounds of the same kind.
Cull::Box world_bounds(const Shape& solid, const Pose& X_WG) {
  return std::visit(
      [&](const auto& s) {
        Cull::Box box;
        for (int i = 0; i < 3; ++i) {
          const Vec3 axis = X_WG.rotation.row(i).transpose();
          const double min = X_WG.translation[i] - s.support_height(-axis);
          const double minus_max = -X_WG.translation[i] - s.support_height(axis);
          box.ends[static_cast<std::size_t>(i)] = Cull::Two{min, minus_max};
          box.reverse[static_cast<std::size_t>(i)] = Cull::Two{minus_max, min};
        }
        return box;
      },
      solid);
}

// Apart along an axis when min_a >= max_b or min_b >= max_a. Comparisons with NaN are false, so
// that a pose that is no number reaches the engine, which reports it.
bool are_apart(const Cull::Box& a, const Cull::Box& b) {
  const auto apart = (a.ends[0] + b.reverse[0] >= 0.0) | (a.ends[1] + b.reverse[1] >= 0.0) |
                     (a.ends[2] + b.reverse[2] >= 0.0);
  return (apart[0] | apart[1]) != 0;
}

// Whether some of the solid at X_WG is below the plane geom's surface.
bool reaches_plane(const mjData* d, int plane, const Shape& solid, const Pose& X_WG) {
  const Pose X_WP = pose_of_geom(d, plane);
  const Vec3 normal = X_WP.rotation.col(2);
  const Vec3 down_G = -(X_WG.rotation.transpose() * normal);
  const double height = normal.dot(X_WG.translation - X_WP.translation);
  const double reach = std::visit([&](const auto& s) { return s.support_height(down_G); }, solid);
  return !(height >= reach);
}

}  // namespace

std::vector<GeomPair> pairs_that_can_touch(const mjModel* m, const SceneKeys& keys,
                                           bool listed_only) {
  const PairRules rules(m, keys, listed_only || keys.options.pairs == PairRule::kListed);
  std::vector<GeomPair> pairs;
  for (int a = 0; a < m->ngeom; ++a) {
    for (int b = a + 1; b < m->ngeom; ++b) {
      GeomPair pair{a, b, PairOrigin::kMasks, -1};
      if (rules.admit(pair)) pairs.push_back(pair);
    }
  }
  return pairs;
}

Cull::Cull(const std::vector<GeomPair>& pairs, const std::vector<Shape>& solids)
    : pairs_(&pairs), row_(solids.size() + 1, 0), bounded_of_geom_(solids.size(), -1) {
  const auto is_plane = [&](int geom) {
    return std::holds_alternative<HalfSpace>(solids[static_cast<std::size_t>(geom)]);
  };
  const auto index_of = [&](int geom) {
    int& index = bounded_of_geom_[static_cast<std::size_t>(geom)];
    if (index < 0) {
      index = static_cast<int>(bounded_.size());
      bounded_.push_back({geom, solids[static_cast<std::size_t>(geom)]});
    }
    return index;
  };
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const GeomPair& pair = pairs[i];
    ++row_[static_cast<std::size_t>(pair.a) + 1];
    const auto index = static_cast<int>(i);
    if (is_plane(pair.a)) {
      with_plane_.push_back({index, pair.a, index_of(pair.b)});
    } else if (is_plane(pair.b)) {
      with_plane_.push_back({index, pair.b, index_of(pair.a)});
    } else {
      index_of(pair.a);
      index_of(pair.b);
    }
  }
  std::partial_sum(row_.begin(), row_.end(), row_.begin());
  constexpr std::size_t kFew = 2000;  // comparisons that cost less than a sort
  is_swept_ = pairs.size() - with_plane_.size() > kFew;
}

// The pair of two geoms, -1 where they cannot touch.
int Cull::pair_of(int a, int b) const {
  if (a > b) std::swap(a, b);
  const auto begin = pairs_->begin() + row_[static_cast<std::size_t>(a)];
  const auto end = pairs_->begin() + row_[static_cast<std::size_t>(a) + 1];
  const auto found =
      std::lower_bound(begin, end, b, [](const GeomPair& pair, int geom) { return pair.b < geom; });
  return found != end && found->b == b ? static_cast<int>(found - pairs_->begin()) : -1;
}

void Cull::find_all(Scratch& scratch) const {
  for (std::size_t i = 0; i < pairs_->size(); ++i) {
    const GeomPair& pair = (*pairs_)[i];
    const int a = bounded_of_geom_[static_cast<std::size_t>(pair.a)];
    const int b = bounded_of_geom_[static_cast<std::size_t>(pair.b)];
    if (a < 0 || b < 0) continue;
    if (are_apart(scratch.boxes[static_cast<std::size_t>(a)],
                  scratch.boxes[static_cast<std::size_t>(b)])) {
      continue;
    }
    scratch.near.push_back(static_cast<int>(i));
  }
}

// Along the axis on which the solids are spread most: each with those that begin before it ends.
void Cull::sweep(Scratch& scratch) const {
  const std::size_t count = bounded_.size();
  int axis = 0;
  double widest = -1.0;
  for (int k = 0; k < 3; ++k) {
    double low = kInfinity, high = -kInfinity;
    for (const Box& box : scratch.boxes) {
      const double end = box.ends[static_cast<std::size_t>(k)][0];
      low = std::min(low, end);
      high = std::max(high, end);
    }
    if (high - low > widest) widest = high - low, axis = k;
  }
  scratch.low.resize(count);
  scratch.high.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Two ends = scratch.boxes[i].ends[static_cast<std::size_t>(axis)];
    const bool is_number = ends[0] - ends[0] == 0.0 && ends[1] - ends[1] == 0.0;
    scratch.low[i] = is_number ? ends[0] : -kInfinity;
    scratch.high[i] = is_number ? -ends[1] : kInfinity;
  }
  std::vector<int>& sorted = scratch.sorted;
  if (sorted.size() != count) {
    sorted.resize(count);
    std::iota(sorted.begin(), sorted.end(), 0);
  }
  const auto begins_before = [&](int i, int j) {
    return scratch.low[static_cast<std::size_t>(i)] < scratch.low[static_cast<std::size_t>(j)];
  };
  // They are nearly in order as a rule: bodies move little in a step.
  std::size_t moves = 0;
  for (std::size_t i = 1; i < count && moves <= 4 * count; ++i) {
    const int solid = sorted[i];
    std::size_t k = i;
    for (; k > 0 && begins_before(solid, sorted[k - 1]); --k, ++moves) sorted[k] = sorted[k - 1];
    sorted[k] = solid;
  }
  if (moves > 4 * count) std::sort(sorted.begin(), sorted.end(), begins_before);
  for (std::size_t i = 0; i < count; ++i) {
    const auto one = static_cast<std::size_t>(sorted[i]);
    for (std::size_t j = i + 1; j < count; ++j) {
      const auto other = static_cast<std::size_t>(sorted[j]);
      if (!(scratch.low[other] < scratch.high[one])) break;
      if (are_apart(scratch.boxes[one], scratch.boxes[other])) continue;
      const int pair = pair_of(bounded_[one].geom, bounded_[other].geom);
      if (pair >= 0) scratch.near.push_back(pair);
    }
  }
}

void Cull::run(const mjData* d, Scratch& scratch) const {
  scratch.boxes.resize(bounded_.size());
  for (std::size_t i = 0; i < bounded_.size(); ++i) {
    scratch.boxes[i] = world_bounds(bounded_[i].solid, pose_of_geom(d, bounded_[i].geom));
  }
  scratch.near.clear();
  for (const WithPlane& pair : with_plane_) {
    const Bounded& other = bounded_[static_cast<std::size_t>(pair.other)];
    if (reaches_plane(d, pair.plane, other.solid, pose_of_geom(d, other.geom))) {
      scratch.near.push_back(pair.pair);
    }
  }
  is_swept_ ? sweep(scratch) : find_all(scratch);
  std::sort(scratch.near.begin(), scratch.near.end());
}

}  // namespace volcontact::adaptor
