// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "volcontact/shape/shapes.h"

namespace volcontact {

/// What no overlap with a solid can go beyond, in the solid's frame.
struct OverlapLimits {
  double volume = kInfinity;  ///< V is no larger [m^3]
  Aabb bounds;                ///< the centroid lies within
  double parts = 1.0;         ///< most parts of a straight line within the solid
};

template <typename S>
OverlapLimits limits_of(const S& solid) {
  if constexpr (requires { solid.volume(); }) {
    return {solid.volume(), solid.bounds()};
  } else {
    return {solid.own_metrics().volume, solid.bounds()};
  }
}
inline OverlapLimits limits_of(const Torus& torus) { return {torus.volume(), torus.bounds(), 2.0}; }
inline OverlapLimits limits_of(const Csg& solid) {
  return {solid.most_volume(), solid.bounds(), static_cast<double>(solid.most_parts())};
}
inline OverlapLimits limits_of(const SignedDistance& solid) {
  return {kInfinity, solid.bounds(), kInfinity};
}
inline OverlapLimits limits_of(const Mesh& mesh) {
  return {mesh.own_metrics().volume, mesh.bounds(),
          static_cast<double>(mesh.topology().triangles.size())};
}

namespace overlap_limits {
inline constexpr double kRounding = 1e-6;    ///< of V, and of lengths, per the size of the solid
inline constexpr double kMostError = 0.1;    ///< share of V that counts of the error claimed
inline constexpr double kAreaError = 1e-2;   ///< of S; less well known than V
inline constexpr double kMostDoubt = 0.05;   ///< error claimed by V: more is no answer
inline constexpr double kLeastDoubt = 1e-6;  ///< of a solid: less is no matter
inline constexpr double kSpeck = 1e-9;  ///< of a solid: where less is, and its S, may be rounding
}  // namespace overlap_limits

/// Whether the centroid `at` and the area vector, in the frame of a solid, can be those of an
/// overlap with it. What is no number cannot.
inline bool is_possible(const OverlapLimits& limits, double parts, const Vec3& at,
                        const Vec3& area_vector) {
  const Vec3 extent = limits.bounds.max - limits.bounds.min;
  const double slack = overlap_limits::kRounding * (extent.sum() + at.cwiseAbs().sum());
  // Each part of a line in the overlap ends on A once, or twice, and then the two cancel.
  const double most = parts * (1.0 + overlap_limits::kAreaError);
  const auto within = [&](int i, int j, int k) {
    return at[i] - limits.bounds.max[i] <= slack && limits.bounds.min[i] - at[i] <= slack &&
           std::abs(area_vector[i]) <= most * extent[j] * extent[k];
  };
  return within(0, 1, 2) && within(1, 2, 0) && within(2, 0, 1);
}

/// The same where it is plain without turning the two into the frame of the solid: `at` and the
/// area vector count from its origin, in any axes.
inline bool is_plainly_possible(const OverlapLimits& limits, const Vec3& at,
                                const Vec3& area_vector) {
  const double inner = std::min(limits.bounds.max.minCoeff(), -limits.bounds.min.maxCoeff());
  return inner > 0.0 && at.squaredNorm() <= inner * inner &&
         area_vector.squaredNorm() <= 16.0 * (inner * inner) * (inner * inner);
}

/// Whether V is a number, and not beyond the volume of either solid.
inline bool is_possible_volume(const VolumeMetrics& m, const OverlapLimits& a,
                               const OverlapLimits& b) {
  using namespace overlap_limits;
  const double least = std::min(a.volume, b.volume);
  const double error = std::min(m.volume_error, kMostError * least);
  return m.volume >= 0.0 && m.volume <= (1.0 + kRounding) * least + error;
}

/// Whether metrics in A's frame can be those of an overlap of A and B at X_AB: all numbers finite,
/// V not beyond either solid, the centroid in both bounds, and S not beyond what the bounds show of
/// a solid from any side. Tells what is wrong by far; no more. docs/theory.md, "Engines".
inline bool is_possible(const VolumeMetrics& metrics, const OverlapLimits& a,
                        const OverlapLimits& b, const Pose& X_AB) {
  using namespace overlap_limits;
  const VolumeMetrics& m = metrics;
  const double others = (m.inertia.col(0).sum() + m.inertia.col(1).sum()) +
                        (m.inertia.col(2).sum() + m.area_moment.sum()) +
                        ((m.area + m.counter_area) + (m.depth_moment + m.depth));
  if (!(std::abs(others) < kInfinity && m.volume_error < kInfinity)) return false;
  if (!is_possible_volume(m, a, b)) return false;
  const double least = std::min(a.volume, b.volume);
  if (least < kInfinity && m.volume <= kSpeck * least) return is_finite(m);
  // Of a line in both solids there are no more parts than in either, but for one.
  const double parts = a.parts + b.parts - 1.0;
  if (!is_possible(a, parts, m.centroid, m.area_vector)) return false;
  const Vec3 p_BC_A = m.centroid - X_AB.translation;
  if (is_plainly_possible(b, p_BC_A, m.area_vector)) return true;
  const Mat3 R_BA = X_AB.rotation.transpose();
  return is_possible(b, parts, R_BA * p_BC_A, R_BA * m.area_vector);
}

/// Makes possible what a rough answer with a bound of its error is not: V no larger than either
/// solid, the error with it; no direction. False where V is no number.
inline bool keep_possible(const OverlapLimits& a, const OverlapLimits& b, VolumeMetrics& m) {
  const double least = std::min(a.volume, b.volume);
  if (!(m.volume >= 0.0 && m.volume < kInfinity && m.volume_error < kInfinity)) return false;
  m.volume_error += std::max(0.0, m.volume - least);
  m.volume = std::min(m.volume, least);
  m.centroid = m.centroid.cwiseMax(a.bounds.min).cwiseMin(a.bounds.max);
  m.area_vector = m.area_moment = Vec3::Zero();
  m.status = std::max(m.status, Status::kApproximate);
  return is_finite(m);
}

/// Whether an engine says itself that it does not know V.
inline bool is_doubtful(const VolumeMetrics& m, const OverlapLimits& a, const OverlapLimits& b) {
  using namespace overlap_limits;
  return m.volume_error > kMostDoubt * m.volume &&
         m.volume_error > kLeastDoubt * std::min(a.volume, b.volume);
}

/// The square of the longest line that both bounds hold [m^2]; infinite where neither ends.
inline double longest_square(const OverlapLimits& a, const OverlapLimits& b) {
  return std::min((a.bounds.max - a.bounds.min).squaredNorm(),
                  (b.bounds.max - b.bounds.min).squaredNorm());
}

/// No part of V has more depth than the longest line: keeps the depth moment, int depth dV, within
/// that. Where a touch has no volume but by rounding, its depth comes out as anything.
inline void bound_depth_moment(double longest_square, VolumeMetrics& m) {
  if (m.depth_moment < 0.0) m.depth_moment = 0.0;
  // As a rule no root is needed to see it.
  const double square = longest_square * m.volume * m.volume;
  if (m.depth_moment * m.depth_moment < square) return;
  const double most = std::sqrt(longest_square) * m.volume;
  if (!(m.depth_moment <= most)) m.depth_moment = most;
}

}  // namespace volcontact
