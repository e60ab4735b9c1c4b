// SPDX-License-Identifier: Apache-2.0
#include "adaptor/geoms/cull.h"

#include <algorithm>
#include <numeric>

#include "volcontact/base/sizes.h"

namespace volcontact::adaptor {
namespace {

// Whether some of the solid at X_WG is below the plane geom's surface.
bool reaches_plane(const mjData* d, int plane, const Shape& solid, const Pose& X_WG) {
  const Pose X_WP = pose_of_geom(d, plane);
  const Vec3 normal = X_WP.rotation.col(2);
  const Vec3 down_G = -(X_WG.rotation.transpose() * normal);
  const double height = normal.dot(X_WG.translation - X_WP.translation);
  const double reach = std::visit([&](const auto& s) { return s.support_height(down_G); }, solid);
  return !(height >= reach);
}

// Bounds of a polytope look at all of its corners. These are of the box that holds it in its own
// frame, a little larger for the rounding of both.
Bounds rough_bounds(const Aabb& box, const Pose& X_WG) {
  constexpr double kRounding = 1e-9;
  const Vec3 center = X_WG * box.center();
  Bounds out;
  for (int i = 0; i < 3; ++i) {
    const double reach = X_WG.rotation.row(i).cwiseAbs().dot(box.half_sizes());
    const double about = reach + kRounding * (reach + std::abs(center[i]));
    out.set(i, center[i] - about, -center[i] - about);
  }
  return out;
}

}  // namespace

Cull::Cull(const PairRules& rules, const std::vector<Shape>& solids)
    : rules_(&rules), solids_(&solids) {
  std::size_t with_plane = 0;
  for (const int geom : rules.touching()) {
    const bool is_plane = std::holds_alternative<HalfSpace>(solid_of(geom));
    (is_plane ? planes_ : moving_).push_back(geom);
    if (is_plane) with_plane += size(rules.partners(geom));
  }
  constexpr std::size_t kFew = 250;  // comparisons that cost less than a sort
  is_swept_ = rules.count() > kFew + with_plane || rules.touching().size() > kFew;
  is_swept_ ? tell_fixed_apart() : list_pairs();
}

void Cull::list_pairs() {
  std::vector<int> place(size(rules_->geoms()), -1);
  for (std::size_t i = 0; i < moving_.size(); ++i) place[size(moving_[i])] = static_cast<int>(i);
  rules_->for_each([&](const GeomPair& pair) {
    const PairId id = rules_->id(pair.a, pair.b);
    const int a = place[size(pair.a)], b = place[size(pair.b)];
    if (a >= 0 && b >= 0) {
      between_.push_back({id, a, b});
    } else if (a >= 0 || b >= 0) {
      with_plane_.push_back({id, a < 0 ? pair.a : pair.b, std::max(a, b)});
    }
    return true;
  });
}

// Two solids that do not move never touch.
void Cull::tell_fixed_apart() {
  std::vector<int> fixed;
  const auto stays = [&](int geom) { return rules_->is_static(geom); };
  std::copy_if(moving_.begin(), moving_.end(), std::back_inserter(fixed), stays);
  std::erase_if(moving_, stays);
  is_one_body_ = std::all_of(moving_.begin(), moving_.end(), [&](int geom) {
    return rules_->weld_of(geom) == rules_->weld_of(moving_.front()) && !rules_->is_named(geom);
  });
  fixed_ = FixedSolids(*solids_, std::move(fixed));
}

const Bounds& Cull::exact_box(const mjData* d, int place, Scratch& scratch) const {
  Bounds& box = scratch.boxes[size(place)];
  if (scratch.rough[size(place)]) {
    const int geom = moving_[size(place)];
    box = world_bounds(solid_of(geom), pose_of_geom(d, geom));
    scratch.rough[size(place)] = 0;
  }
  return box;
}

void Cull::compare_all(const mjData* d, Scratch& scratch) const {
  for (const Listed& pair : with_plane_) {
    const int geom = moving_[size(pair.b)];
    if (reaches_plane(d, pair.a, solid_of(geom), pose_of_geom(d, geom))) {
      scratch.near.push_back(pair.id);
    }
  }
  for (const Listed& pair : between_) {
    if (are_apart(scratch.boxes[size(pair.a)], scratch.boxes[size(pair.b)])) continue;
    if (are_apart(exact_box(d, pair.a, scratch), exact_box(d, pair.b, scratch))) continue;
    scratch.near.push_back(pair.id);
  }
}

void Cull::reach_planes(const mjData* d, Scratch& scratch) const {
  for (const int plane : planes_) {
    const auto look_at = [&](int geom) {
      if (!rules_->masks_match(plane, geom) && !rules_->is_named(plane, geom)) return;
      if (!reaches_plane(d, plane, solid_of(geom), pose_of_geom(d, geom))) return;
      if (rules_->admits(plane, geom)) scratch.near.push_back(rules_->id(plane, geom));
    };
    std::for_each(moving_.begin(), moving_.end(), look_at);
    if (rules_->is_static(plane)) continue;
    std::for_each(fixed_.geoms().begin(), fixed_.geoms().end(), look_at);
  }
}

// By their lower ends along the axis on which they are spread most.
void Cull::sort_moving(Scratch& scratch) const {
  const std::size_t count = moving_.size();
  int axis = 0;
  double widest = -1.0;
  for (int k = 0; k < 3; ++k) {
    double low = kInfinity, high = -kInfinity;
    for (const Bounds& box : scratch.boxes) {
      low = std::min(low, box.low(k));
      high = std::max(high, box.low(k));
    }
    if (high - low > widest) widest = high - low, axis = k;
  }
  const auto ends_of = [&](std::size_t i) -> std::pair<double, double> {
    const double low = scratch.boxes[i].low(axis), high = scratch.boxes[i].high(axis);
    const bool are_numbers = low - low == 0.0 && high - high == 0.0;
    return are_numbers ? std::pair{low, high} : std::pair{-kInfinity, kInfinity};
  };
  scratch.low.resize(count);
  for (std::size_t i = 0; i < count; ++i) scratch.low[i] = ends_of(i).first;
  std::vector<int>& sorted = scratch.sorted;
  if (sorted.size() != count) {
    sorted.resize(count);
    std::iota(sorted.begin(), sorted.end(), 0);
  }
  const auto begins_before = [&](int i, int j) {
    return scratch.low[size(i)] < scratch.low[size(j)];
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
  scratch.ordered.resize(count);
  scratch.ends.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    scratch.ordered[i] = scratch.boxes[size(sorted[i])];
    scratch.ends[i] = ends_of(size(sorted[i]));
  }
}

// Each with those that begin before it ends.
void Cull::sweep(const mjData* d, Scratch& scratch) const {
  if (is_one_body_) return;
  sort_moving(scratch);
  const std::size_t count = moving_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Bounds box = scratch.ordered[i];
    const double end = scratch.ends[i].second;
    for (std::size_t j = i + 1; j < count && scratch.ends[j].first < end; ++j) {
      if (are_apart(box, scratch.ordered[j])) continue;
      const int first = scratch.sorted[i], second = scratch.sorted[j];
      if (are_apart(exact_box(d, first, scratch), exact_box(d, second, scratch))) continue;
      const int a = moving_[size(first)], b = moving_[size(second)];
      if (rules_->admits(a, b)) scratch.near.push_back(rules_->id(a, b));
    }
  }
}

void Cull::meet_fixed(const mjData* d, Scratch& scratch) const {
  fixed_.follow(d, scratch.fixed);
  if (fixed_.geoms().empty()) return;
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    const int a = moving_[i];
    fixed_.meet(d, i, scratch.boxes[i], scratch.fixed, [&](int b, const Bounds& bounds) {
      if (are_apart(exact_box(d, static_cast<int>(i), scratch), bounds)) return;
      if (rules_->admits(a, b)) scratch.near.push_back(rules_->id(a, b));
    });
  }
}

void Cull::run(const mjData* d, Scratch& scratch) const {
  scratch.near.clear();
  scratch.boxes.resize(moving_.size());
  scratch.rough.assign(moving_.size(), 0);
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    const Shape& solid = solid_of(moving_[i]);
    const Pose X_WG = pose_of_geom(d, moving_[i]);
    const auto* polytope = std::get_if<ConvexPolytope>(&solid);
    scratch.rough[i] = polytope ? 1 : 0;
    scratch.boxes[i] =
        polytope ? rough_bounds(polytope->bounds(), X_WG) : world_bounds(solid, X_WG);
  }
  if (is_swept_) {
    reach_planes(d, scratch);
    sweep(d, scratch);
    meet_fixed(d, scratch);
  } else {
    compare_all(d, scratch);
  }
  if (!std::is_sorted(scratch.near.begin(), scratch.near.end())) {
    std::sort(scratch.near.begin(), scratch.near.end());
  }
}

}  // namespace volcontact::adaptor
