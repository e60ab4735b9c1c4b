// SPDX-License-Identifier: Apache-2.0
#include "core/search/overlap_checks.h"

#include <algorithm>

#include "volcontact/base/symmetric_eigen.h"

namespace volcontact::test {
namespace {

constexpr double kNone = 1e-9;   // of the smaller body: a volume that is as good as none
constexpr double kLoose = 0.05;  // by which engines that are not exact may be off in one pose
constexpr double kTight = 1e-9;  // and those that are

double signed_distance(const Example& e, const Vec3& p) {
  return std::visit([&p](const auto& solid) { return solid.signed_distance(p); }, e.shape);
}

// Volume of a ball about the point that lies in both solids: a signed distance never exceeds the
// distance to the surface.
double ball_inside(const Example& a, const Example& b, const Pose& X_AB, const Vec3& p_A) {
  const double depth = -std::max(signed_distance(a, p_A), signed_distance(b, X_AB.inverse() * p_A));
  return depth > 0.0 ? 4.0 / 3.0 * kPi * depth * depth * depth : 0.0;
}

bool holds(const Example& e, const Vec3& p, double slack) {
  if (std::isinf(e.own_volume)) return true;
  return ((p - e.bounds.center()).cwiseAbs() - e.bounds.half_sizes()).maxCoeff() <= slack;
}

bool is_inertia_of_a_body(const VolumeMetrics& m) {
  // Thin overlaps have one moment of next to nothing.
  return symmetric_eigen(m.second_moment()).values[0] >= -1e-6 * m.inertia.trace();
}

}  // namespace

const char* fault_of(const Interference& answer, const Example& a, const Example& b,
                     const Pose& X_AB, const Vec3& inside) {
  const VolumeMetrics& m = answer.total;
  bool finite = is_finite(m);
  for (const VolumeMetrics& site : answer.sites) finite = finite && is_finite(site);
  if (!finite) return "not finite";
  const double body = std::min(a.own_volume, b.own_volume);
  if (m.volume < 0.0 || m.volume_error < 0.0) return "negative";
  if (m.volume > (1.0 + kTight) * body + m.volume_error) return "larger than a body";
  const double least = ball_inside(a, b, X_AB, inside);
  if (least > kNone * body && m.volume < (1.0 - kLoose) * least - m.volume_error) {
    return "smaller than a ball inside of both";
  }
  if (!m.touching()) return answer.sites.empty() ? nullptr : "sites of nothing";
  double sum = 0.0;
  for (const VolumeMetrics& site : answer.sites) sum += site.volume;
  if (std::abs(sum - m.volume) > kTight * m.volume) return "sites that do not add up";
  if (m.volume <= kNone * body) return nullptr;
  const double slack = 1e-6 * std::min(a.size, b.size);
  if (!holds(a, m.centroid, slack) || !holds(b, X_AB.inverse() * m.centroid, slack)) {
    return "centroid outside";
  }
  if (!is_inertia_of_a_body(m)) return "inertia of no body";
  // Rounding of the areas of a body, not of the overlap.
  const double area_slack = 1e-9 * std::pow(std::min(a.size, b.size), 2);
  const double most = (1.0 + kLoose) * std::min(m.area, m.counter_area) + area_slack;
  if (m.area_vector.norm() > most) return "area vector longer than an area";
  return nullptr;
}

const char* disagreement_of(const VolumeMetrics& in_A, const VolumeMetrics& in_B, const Pose& X_AB,
                            double smaller_body, bool exact, bool smooth) {
  const double volume = in_A.volume;
  const double errors = in_A.volume_error + in_B.volume_error;
  // Half-spaces meet bodies kilometres from their origin, where the inverse of the pose rounds.
  const double rounding = 1e-15 * X_AB.translation.norm() * std::max(in_A.area, in_A.counter_area);
  const double allowed = exact ? kTight * volume + 1e-3 * kNone * smaller_body + rounding
                               : kLoose * volume + errors + kNone * smaller_body;
  if (!(std::abs(in_B.volume - volume) <= allowed)) return "another volume in the other order";
  if (!smooth || volume <= 1e-6 * smaller_body || !in_B.touching()) return nullptr;
  const double area = std::max(in_A.area, in_A.counter_area);
  const Vec3 sum = in_A.area_vector + X_AB.rotation * in_B.area_vector;
  if (sum.norm() > kLoose * area) return "another area vector in the other order";
  return nullptr;
}

}  // namespace volcontact::test
