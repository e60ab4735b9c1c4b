// SPDX-License-Identifier: Apache-2.0
#include "volcontact/model/site_memory.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace volcontact {
namespace {

SiteHead head_of(const double* row) {
  SiteHead head;
  std::memcpy(static_cast<void*>(&head), row, sizeof head);
  return head;
}

// Pose of B in A. One function for then and now, so that bodies at rest differ in no bit.
Pose relative_pose(const BodyMotion& motion) {
  const Mat3 from_W = motion.X_WA.rotation.transpose();
  return {from_W * motion.X_WB.rotation,
          from_W * (motion.X_WB.translation - motion.X_WA.translation)};
}

double radius_of(const VolumeMetrics& metrics) {
  const double mean_square = 0.5 * metrics.inertia.trace() / metrics.volume;
  return 2.0 * std::sqrt(std::max(0.0, mean_square));
}

// Rotation vector of a matrix near the identity, in the order of its angle squared.
Vec3 small_turn(const Mat3& r) {
  return 0.5 * Vec3(r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1));
}

// `vector`, which lay across the unit vector `from`, turned with it into `to` by the least turn.
// Exactly itself when the two are one.
Vec3 turned(const Vec3& vector, const Vec3& from, const Vec3& to) {
  const double both = 1.0 + from.dot(to);
  constexpr double kOpposite = 1e-9;  // a normal that turned right round: no least turn
  const Vec3 moved = both > kOpposite ? Vec3(vector - vector.dot(to) / both * (from + to)) : vector;
  return moved - moved.dot(to) * to;
}

}  // namespace

SiteHead site_head(int pair, const VolumeMetrics& metrics_W, const BodyMotion& motion) noexcept {
  const Pose X_AB = relative_pose(motion);
  SiteHead head;
  head.pair = pair;
  head.volume = metrics_W.volume;
  head.radius = radius_of(metrics_W);
  const Vec3 point_A =
      motion.X_WA.rotation.transpose() * (metrics_W.centroid - motion.X_WA.translation);
  point_A.to(head.point_A);
  metrics_W.normal().to(head.normal_W);
  X_AB.rotation.to(head.rotation_AB);
  X_AB.translation.to(head.origin_B_A);
  return head;
}

void SiteCarrier::predict(const SiteMemory& memory, int pair, const BodyMotion& motion) {
  const Mat3& R_WA = motion.X_WA.rotation;
  const Pose X_AB = relative_pose(motion);
  // How far the site can have rolled on: about as far as the bodies moved past each other.
  const double passed = (motion.V_WA.linear - motion.V_WB.linear).norm() * memory.elapsed;
  old_.clear();
  for (int i = 0; i < memory.count; ++i) {
    const double* row = memory.rows + static_cast<std::ptrdiff_t>(i) * memory.stride;
    const SiteHead head = head_of(row);
    if (head.pair != pair) continue;
    const Mat3 old_R_AB = Mat3::from(head.rotation_AB);
    const Vec3 old_p_AB = Vec3::from(head.origin_B_A), point_A = Vec3::from(head.point_A);
    // Differences of what was and is, so that bodies at rest have exactly no way.
    const Vec3 point_B = old_R_AB.transpose() * (point_A - old_p_AB);
    const Vec3 way_of_B = (X_AB.rotation - old_R_AB) * point_B + (X_AB.translation - old_p_AB);
    const Vec3 turn_of_B = small_turn((X_AB.rotation - old_R_AB) * old_R_AB.transpose());
    const Vec3 travel = -(R_WA * way_of_B);
    const Vec3 with_A = motion.X_WA * point_A;
    old_.push_back({row,
                    with_A - 0.5 * travel,
                    head.radius + travel.norm() + passed,
                    {travel, -(R_WA * turn_of_B)},
                    0.0});
  }
}

// Every old site goes on in the nearest new one; a new site that nothing goes on in came of the
// nearest old one.
void SiteCarrier::link(std::span<const VolumeMetrics> sites_W) {
  links_.assign(old_.size() * sites_W.size(), 0);
  const auto distance = [&](std::size_t o, std::size_t n) {
    const double gap = (old_[o].predicted - sites_W[n].centroid).norm();
    return gap <= old_[o].reach + radius_of(sites_W[n]) ? gap : HUGE_VAL;
  };
  const auto join = [&](std::size_t o, std::size_t n) {
    links_[o * sites_W.size() + n] = 1;
    old_[o].children += sites_W[n].volume;
  };
  for (std::size_t o = 0; o < old_.size(); ++o) {
    double least = HUGE_VAL;
    std::size_t nearest = 0;
    for (std::size_t n = 0; n < sites_W.size(); ++n) {
      const double gap = distance(o, n);
      if (gap < least) least = gap, nearest = n;
    }
    if (least < HUGE_VAL) join(o, nearest);
  }
  for (std::size_t n = 0; n < sites_W.size(); ++n) {
    double least = HUGE_VAL;
    std::size_t nearest = 0;
    bool has_parent = false;
    for (std::size_t o = 0; o < old_.size(); ++o) {
      has_parent = has_parent || links_[o * sites_W.size() + n];
      const double gap = distance(o, n);
      if (gap < least) least = gap, nearest = o;
    }
    if (!has_parent && least < HUGE_VAL) join(nearest, n);
  }
}

void SiteCarrier::inherit(std::size_t site, const VolumeMetrics& metrics_W,
                          const BodyMotion& motion, double elapsed,
                          std::span<const StateField> states) {
  const std::size_t sites = carried_.size();
  const Vec3 normal = metrics_W.normal();
  // The plane turns about its normal with the mean of the two bodies.
  const double spun = 0.5 * elapsed * (motion.V_WA.angular + motion.V_WB.angular).dot(normal);
  double* to = states_.data() + site * size_;
  CarriedSite& way = carried_[site];
  double parents = 0.0;
  for (std::size_t o = 0; o < old_.size(); ++o) {
    if (links_[o * sites + site]) parents += head_of(old_[o].row).volume;
  }
  for (std::size_t o = 0; o < old_.size(); ++o) {
    if (!links_[o * sites + site]) continue;
    const SiteHead head = head_of(old_[o].row);
    const double share = old_[o].children > 0.0 ? metrics_W.volume / old_[o].children : 0.0;
    const double weight = parents > 0.0 ? head.volume / parents : 0.0;
    way.travel += weight * old_[o].way.travel;
    way.rotation += weight * old_[o].way.rotation;
    const double* from = old_[o].row + kSiteHead;
    std::size_t i = 0;
    for (const StateField& state : states) {
      switch (state.keeping) {
        case Keeping::kVector:
        case Keeping::kVectorValue: {
          const Vec3 moved = turned(Vec3::from(from + i), Vec3::from(head.normal_W), normal);
          const Vec3 spun_on = moved * std::cos(spun) + normal.cross(moved) * std::sin(spun);
          const bool is_amount = state.keeping == Keeping::kVector;
          (Vec3::from(to + i) + (is_amount ? share : weight) * spun_on).to(to + i);
          break;
        }
        case Keeping::kAmount:
          to[i] += share * from[i];
          break;
        case Keeping::kValue:
          to[i] += weight * from[i];
          break;
      }
      i += static_cast<std::size_t>(state.size());
    }
  }
}

void SiteCarrier::carry(const SiteMemory& memory, int pair, std::span<const VolumeMetrics> sites_W,
                        const BodyMotion& motion, std::span<const StateField> states) {
  size_ = static_cast<std::size_t>(size_of(states));
  carried_.assign(sites_W.size(), {});
  states_.assign(sites_W.size() * size_, 0.0);
  predict(memory, pair, motion);
  link(sites_W);
  for (std::size_t n = 0; n < sites_W.size(); ++n) {
    inherit(n, sites_W[n], motion, memory.elapsed, states);
  }
}

}  // namespace volcontact
