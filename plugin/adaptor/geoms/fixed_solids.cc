// SPDX-License-Identifier: Apache-2.0
#include "adaptor/geoms/fixed_solids.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>

#include "adaptor/mujoco/mjgeoms.h"
#include "volcontact/base/sizes.h"

namespace volcontact::adaptor {
namespace {

// Of fewer than these, all poses are compared.
constexpr std::size_t kFew = 256;

// How many more boxes a solid may meet in a tree of balls, on average, so that it pays.
constexpr std::size_t kMostMore = 16;

std::uint64_t next_number() {
  static std::atomic<std::uint64_t> last{0};
  return last.fetch_add(1) + 1;
}

double radius_of(const Shape& solid) {
  const Aabb bounds = bounds_of(solid);
  return bounds.min.cwiseAbs().cwiseMax(bounds.max.cwiseAbs()).norm();
}

bool are_same(const mjtNum* now, const mjtNum* then, std::size_t count) {
  return std::memcmp(now, then, count * sizeof(mjtNum)) == 0;
}

// How many of the boxes in a tree one of those given is looked at with, on average.
std::size_t count_met(const BoundsTree& tree, const std::vector<Bounds>& boxes) {
  constexpr std::size_t kSample = 64;
  std::size_t met = 0;
  for (std::size_t i = 0; i < kSample; ++i) {
    tree.find(boxes[i * boxes.size() / kSample], [&](int) { ++met; });
  }
  return met / kSample;
}

}  // namespace

FixedSolids::FixedSolids(const std::vector<Shape>& solids, std::vector<int> geoms)
    : solids_(&solids), number_(next_number()), geoms_(std::move(geoms)) {
  for (const int geom : geoms_) {
    radii_.push_back(radius_of(solids[size(geom)]));
    if (runs_.empty() || runs_.back().first + runs_.back().second != geom) {
      runs_.emplace_back(geom, 0);
    }
    ++runs_.back().second;
  }
}

Bounds FixedSolids::box_of(const mjData* d, std::size_t place) const {
  return world_bounds((*solids_)[size(geoms_[place])], pose_of_geom(d, geoms_[place]));
}

// However the solid is turned; a little larger, for the rounding of its own bounds. Infinite where
// the pose is no number.
Bounds FixedSolids::ball_of(const mjData* d, std::size_t place) const {
  const Vec3 center = vec3_at(d->geom_xpos, geoms_[place]);
  const bool are_numbers = pose_of_geom(d, geoms_[place]).is_finite();
  Bounds box;
  for (int i = 0; i < 3; ++i) {
    const double about = radii_[place] + 1e-9 * (radii_[place] + std::abs(center[i]));
    const double reach = are_numbers ? about : kInfinity;
    box.set(i, center[i] - reach, -center[i] - reach);
  }
  return box;
}

void FixedSolids::build(const mjData* d, Kept& kept) const {
  kept.owner = number_;
  kept.positions.clear();
  kept.rotations.clear();
  kept.boxes.clear();
  for (std::size_t i = 0; i < geoms_.size(); ++i) {
    const mjtNum *p = d->geom_xpos + 3 * size(geoms_[i]), *r = d->geom_xmat + 9 * size(geoms_[i]);
    kept.positions.insert(kept.positions.end(), p, p + 3);
    kept.rotations.insert(kept.rotations.end(), r, r + 9);
    kept.boxes.push_back(box_of(d, i));
  }
  kept.tree.build(kept.boxes);
  for (Kept::Near& near : kept.near) near.is_known = false;
  kept.may_turn = false;
  kept.compared.assign(geoms_.size(), 0);
  if (geoms_.size() < kFew) return;
  const std::size_t met = count_met(kept.tree, kept.boxes);
  std::vector<Bounds> balls;
  for (std::size_t i = 0; i < geoms_.size(); ++i) balls.push_back(ball_of(d, i));
  BoundsTree tree;
  tree.build(balls);
  if (count_met(tree, kept.boxes) > met + kMostMore) return;
  kept.tree = std::move(tree);
  kept.may_turn = true;
}

void FixedSolids::follow(const mjData* d, Kept& kept) const {
  if (geoms_.empty()) return;
  ++kept.call;
  const auto all_same = [&](const mjtNum* now, const std::vector<mjtNum>& then, int numbers) {
    const mjtNum* place = then.data();
    return std::all_of(runs_.begin(), runs_.end(), [&](const auto& run) {
      const std::size_t length = size(numbers) * size(run.second);
      const bool same = are_same(now + size(numbers) * size(run.first), place, length);
      place += length;
      return same;
    });
  };
  const bool have_stayed = kept.owner == number_ && all_same(d->geom_xpos, kept.positions, 3);
  if (have_stayed && (kept.may_turn || all_same(d->geom_xmat, kept.rotations, 9))) return;
  build(d, kept);
}

// The places that may meet these bounds.
const std::vector<int>& FixedSolids::near_to(std::size_t asker, const Bounds& with,
                                             Kept& kept) const {
  constexpr double kMargin = 1.0 / 64.0;  // on each side, of the largest extent
  if (asker >= kept.near.size()) kept.near.resize(asker + 1);
  Kept::Near& near = kept.near[asker];
  if (near.is_known && are_within(with, near.around)) return near.places;
  near.is_known = true;
  near.around = with;
  const double margin = kMargin * std::max({with.high(0) - with.low(0), with.high(1) - with.low(1),
                                            with.high(2) - with.low(2)});
  for (int i = 0; i < 3; ++i) near.around.set(i, with.low(i) - margin, -with.high(i) - margin);
  near.places.clear();
  near.places.reserve(std::min(kFew, geoms_.size()));  // once: later steps shall not allocate
  kept.tree.find(near.around, [&](int place) {
    if (!are_apart(near.around, kept.boxes[size(place)])) near.places.push_back(place);
  });
  return near.places;
}

void FixedSolids::follow_turn(const mjData* d, std::size_t place, Kept& kept) const {
  kept.compared[place] = kept.call;
  const mjtNum* now = d->geom_xmat + 9 * size(geoms_[place]);
  mjtNum* then = &kept.rotations[9 * place];
  if (are_same(now, then, 9)) return;
  std::copy_n(now, 9, then);
  kept.boxes[place] = box_of(d, place);
}

}  // namespace volcontact::adaptor
