// SPDX-License-Identifier: Apache-2.0
#include "adaptor/geoms/overlap_bounds.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace volcontact::adaptor {
namespace {

// How far a solid reaches along e, in F, where it lies in the half-space n . x <= offset: by
// duality the least over l >= 0 of its support along e - l n, plus l times the offset. Any l gives
// a bound.
double reach_within(const SolidView& solid, const Pose& X_FS, const Vec3& e, const Vec3& n,
                    double offset) {
  const auto bound = [&](double angle) {  // e and n are perpendicular
    const Vec3 along = std::cos(angle) * e - std::sin(angle) * n;
    const double height = solid.support_height(solid.solid, X_FS.rotation.transpose() * along);
    return (height + along.dot(X_FS.translation) + std::sin(angle) * offset) / std::cos(angle);
  };
  constexpr double kGolden = 0.6180339887498949;
  double low = 0.0, high = 0.5 * kPi;
  double x = high - kGolden * (high - low), y = low + kGolden * (high - low);
  double at_x = bound(x), at_y = bound(y), least = bound(low);
  for (int i = 0; i < 40; ++i) {
    least = std::min({least, at_x, at_y});
    if (at_x < at_y) {
      high = std::exchange(y, x);
      at_y = at_x;
      x = high - kGolden * (high - low);
      at_x = bound(x);
    } else {
      low = std::exchange(x, y);
      at_x = at_y;
      y = low + kGolden * (high - low);
      at_y = bound(y);
    }
  }
  return least;
}

// The same of a box, whose support is linear between the l at which an edge of it turns: one of
// these is the best, but for a box outside of the half-space, of which nothing is left.
double reach_within(const Box& solid, const Pose& X_FS, const Vec3& e, const Vec3& n,
                    double offset) {
  constexpr double kFar = 1e8;
  const Vec3 e_S = X_FS.rotation.transpose() * e, n_S = X_FS.rotation.transpose() * n;
  const double along = e.dot(X_FS.translation), across = n.dot(X_FS.translation) - offset;
  const auto bound = [&](double l) {
    return (e_S - l * n_S).cwiseAbs().dot(solid.half_sizes()) + along - l * across;
  };
  double least = std::min(bound(0.0), bound(kFar));
  for (int k = 0; k < 3; ++k) {
    const double l = e_S[k] / n_S[k];
    if (l > 0.0 && l < kFar) least = std::min(least, bound(l));
  }
  return least;
}

template <typename Solid>
Aabb bounds_of_overlap(const Solid& solid, const Pose& X_FS, const Aabb& box) {
  Aabb overlap = box;
  for (int i = 0; i < 3; ++i) {
    for (const double sign : {1.0, -1.0}) {
      double reach = kInfinity;
      for (int j = 0; j < 3; ++j) {
        if (j == i) continue;
        const Vec3 e = sign * Vec3::Unit(i), n = Vec3::Unit(j);
        reach = std::min({reach, reach_within(solid, X_FS, e, n, box.max[j]),
                          reach_within(solid, X_FS, e, -n, -box.min[j])});
      }
      double& end = sign > 0.0 ? overlap.max[i] : overlap.min[i];
      if (reach < sign * end) end = sign * reach;
    }
  }
  return overlap;
}

}  // namespace

Aabb overlap_bounds(const SolidView& solid, const Pose& X_FS, const Aabb& box) {
  return bounds_of_overlap(solid, X_FS, box);
}

Aabb overlap_bounds(const Box& solid, const Pose& X_FS, const Aabb& box) {
  return bounds_of_overlap(solid, X_FS, box);
}

}  // namespace volcontact::adaptor
