// SPDX-License-Identifier: Apache-2.0
#include "adaptor/evaluation/joined_pairs.h"

#include <algorithm>
#include <cmath>

#include "adaptor/geoms/overlap_bounds.h"
#include "adaptor/mujoco/mjgeoms.h"
#include "volcontact/base/sizes.h"

namespace volcontact::adaptor {
namespace {

constexpr int kNone = -1;

// How far the solids of some geoms reach in the frame of another geom; may be infinite.
Aabb reach_of(const SceneContact& contact, const mjData* d, std::span<const int> geoms, int frame) {
  const Pose X_FW = pose_of_geom(d, frame).inverse();
  Aabb reach{Vec3::Constant(kInfinity), Vec3::Constant(-kInfinity)};
  for (const int geom : geoms) {
    const Pose X_FG = X_FW * pose_of_geom(d, geom);
    std::visit(
        [&](const auto& solid) {
          for (int i = 0; i < 3; ++i) {
            const Vec3 axis = X_FG.rotation.row(i);
            const double at = X_FG.translation[i];
            reach.min[i] = std::min(reach.min[i], at - solid.support_height(-axis));
            reach.max[i] = std::max(reach.max[i], at + solid.support_height(axis));
          }
        },
        contact.solids()[size(geom)]);
  }
  return reach;
}

bool are_numbers(const mjData* d, std::span<const int> geoms) {
  return std::all_of(geoms.begin(), geoms.end(),
                     [d](int geom) { return pose_of_geom(d, geom).is_finite(); });
}

double squared_distance(const Aabb& box, const Vec3& p) {
  return (p - p.cwiseMax(box.min).cwiseMin(box.max)).squaredNorm();
}

}  // namespace

SiteMemory JoinedPair::memory(const SitePool<const double>& pool, double elapsed) {
  SiteMemory found{nullptr, 0, 0, elapsed};
  rows.clear();
  for (const PairId pair : pairs) {
    const SiteMemory more = pool.rows_of(pair, elapsed);
    if (more.count == 0) continue;
    const auto copy = [&](const SiteMemory& from) {
      const std::size_t numbers = size(from.count) * size(from.stride) - 1;
      rows.insert(rows.end(), from.rows, from.rows + numbers);
      rows.push_back(0.0);
    };
    if (found.count > 0 && rows.empty()) copy(found);
    if (found.count > 0) copy(more);
    found = {found.count > 0 ? rows.data() : more.rows, found.count + more.count, more.stride,
             elapsed};
  }
  return found;
}

void JoinedPair::place_sites(const SceneContact& contact, const BodyMotion& motion,
                             const ContactReport& report) {
  site_pairs.clear();
  const FlushGroups& flush = contact.flush();
  const Pose X_AW = motion.X_WA.inverse(), X_BW = motion.X_WB.inverse();
  for (const SiteReport& site : report.sites) {
    const Vec3 c_A = X_AW * site.metrics.centroid, c_B = X_BW * site.metrics.centroid;
    PairId nearest = pairs.front();
    double least = HUGE_VAL;
    for (const PairId pair : pairs) {
      const GeomPair& geoms = contact.pair(pair).geoms;
      double distance = 0.0;
      if (flush.is_tile(geoms.a)) distance += squared_distance(flush.bounds(geoms.a), c_A);
      if (flush.is_tile(geoms.b)) distance += squared_distance(flush.bounds(geoms.b), c_B);
      if (distance < least) least = distance, nearest = pair;
    }
    site_pairs.push_back(nearest);
  }
}

int JoinedPairs::Side::part_of(int geom) const {
  if (!has_several()) return 0;
  const auto found = std::lower_bound(geoms.begin(), geoms.end(), geom);
  return tiles.of(static_cast<std::size_t>(found - geoms.begin()));
}

JoinedPair& JoinedPairs::next() {
  if (count_ == joined_.size()) joined_.emplace_back();
  JoinedPair& joined = joined_[count_++];
  joined.pairs.clear();
  joined.site_pairs.clear();
  return joined;
}

// Where the bounds of the other solid let tiles stand apart, those of the overlap may not.
void JoinedPairs::look_closer(const SceneContact& contact, const mjData* d, Side& side,
                              const Side& other) {
  if (!side.has_several() || other.count() != 1 || !side.tiles.may_join_in_less()) return;
  Aabb all = side.bounds.front();
  for (const Aabb& tile : side.bounds) {
    all.min = all.min.cwiseMin(tile.min);
    all.max = all.max.cwiseMax(tile.max);
  }
  GeometricPair pair{Box({.half_sizes = all.half_sizes()}), Sphere({}),
                     Pose{Mat3::Identity(), all.center()}, Pose{}};
  set_solid(contact, other, 0, pair.b, pair.X_Bb);
  const SolidView solid = view_of(pair.b);
  if (!solid.convex) return;
  const Pose X_Wb = pose_of_geom(d, other.frame) * pair.X_Bb;
  const Pose X_Fb = pose_of_geom(d, side.frame).inverse() * X_Wb;
  if (solid.bounds.bounded()) {
    const Box* const box = std::get_if<Box>(&pair.b);
    side.tiles.build(side.bounds,
                     box ? overlap_bounds(*box, X_Fb, all) : overlap_bounds(solid, X_Fb, all));
    return;
  }
  const SolidView tiles = view_of(pair.a);
  const OverlapWindow window =
      find_window(tiles, solid, pair.X_Aa.inverse() * X_Fb, hull_, scratch_);
  if (window.apart) return;
  Aabb region{Vec3::Constant(kInfinity), Vec3::Constant(-kInfinity)};
  for (const Vec3& point : hull_.points()) {
    const Vec3 p = pair.X_Aa * (window.X_AW * point);
    region.min = region.min.cwiseMin(p);
    region.max = region.max.cwiseMax(p);
  }
  side.tiles.build(side.bounds, region);
}

// False where a pose is no number.
bool JoinedPairs::join_sides(const SceneContact& contact, const mjData* d) {
  if (!are_numbers(d, a_.geoms) || !are_numbers(d, b_.geoms)) return false;
  for (Side* side : {&a_, &b_}) {
    if (!side->has_several()) continue;
    const Aabb region = reach_of(contact, d, (side == &a_ ? b_ : a_).geoms, side->frame);
    side->bounds.clear();
    for (const int geom : side->geoms) side->bounds.push_back(contact.flush().bounds(geom));
    side->tiles.build(side->bounds, region);
  }
  look_closer(contact, d, a_, b_);
  look_closer(contact, d, b_, a_);
  return true;
}

void JoinedPairs::set_solid(const SceneContact& contact, const Side& side, int part, Shape& solid,
                            Pose& X) {
  int geom = side.geoms.front();
  if (side.has_several()) {
    int members = 0;
    for (std::size_t i = 0; i < side.geoms.size(); ++i) {
      if (side.tiles.of(i) != part) continue;
      geom = side.geoms[i];
      ++members;
    }
    if (members > 1) {
      const Aabb& whole = side.tiles.box(part);
      solid = Box({.half_sizes = whole.half_sizes()});
      X = {Mat3::Identity(), whole.center()};
      return;
    }
  }
  solid = contact.solids()[size(geom)];
  X = contact.flush().is_tile(geom) ? contact.flush().pose(geom) : Pose{};
}

void JoinedPairs::add_family(const SceneContact& contact, const mjData* d,
                             std::span<const PairId> pairs) {
  a_.geoms.clear();
  b_.geoms.clear();
  for (const PairId pair : pairs) {
    const PairContact& at = contact.pair(pair);
    a_.geoms.push_back(at.geoms.a);
    b_.geoms.push_back(at.geoms.b);
    a_.frame = at.frame_a;
    b_.frame = at.frame_b;
  }
  for (Side* side : {&a_, &b_}) {
    std::sort(side->geoms.begin(), side->geoms.end());
    side->geoms.erase(std::unique(side->geoms.begin(), side->geoms.end()), side->geoms.end());
  }
  const bool has_poses = join_sides(contact, d);
  part_.assign(has_poses ? size(a_.count() * b_.count()) : 0, kNone);
  for (const PairId pair : pairs) {
    const GeomPair& geoms = contact.pair(pair).geoms;
    if (!has_poses) {  // for the engine to tell
      JoinedPair& joined = next();
      joined.pairs.push_back(pair);
      joined.solids = {contact.solids()[size(geoms.a)], contact.solids()[size(geoms.b)], Pose{},
                       Pose{}};
      continue;
    }
    const int a = a_.part_of(geoms.a), b = b_.part_of(geoms.b);
    if (a == BoxUnion::kOutside || b == BoxUnion::kOutside) continue;
    int& part = part_[size(a * b_.count() + b)];
    if (part == kNone) {
      part = static_cast<int>(count_);
      GeometricPair& solids = next().solids;
      set_solid(contact, a_, a, solids.a, solids.X_Aa);
      set_solid(contact, b_, b, solids.b, solids.X_Bb);
    }
    joined_[size(part)].pairs.push_back(pair);
  }
}

void JoinedPairs::build(const SceneContact& contact, const mjData* d, std::vector<PairId>& near) {
  count_ = 0;
  const FlushGroups& flush = contact.flush();
  if (flush.empty()) return;
  of_families_.clear();
  leads_.clear();
  for (const PairId pair : near) {
    const PairId family = contact.pair(pair).family;
    if (family >= 0) {
      of_families_.emplace_back(family, pair);
    } else {
      leads_.emplace_back(pair, kNone);
    }
  }
  if (of_families_.empty()) return;
  std::sort(of_families_.begin(), of_families_.end());
  for (auto first = of_families_.begin(); first != of_families_.end();) {
    pairs_.clear();
    const PairId family = first->first;
    for (; first != of_families_.end() && first->first == family; ++first) {
      pairs_.push_back(first->second);
    }
    add_family(contact, d, pairs_);
  }
  for (std::size_t i = 0; i < count_; ++i) {
    leads_.emplace_back(joined_[i].pairs.front(), static_cast<int>(i));
  }
  std::sort(leads_.begin(), leads_.end());
  near.clear();
  joined_at_.clear();
  for (const auto& [pair, joined] : leads_) {
    near.push_back(pair);
    joined_at_.push_back(joined);
  }
}

}  // namespace volcontact::adaptor
