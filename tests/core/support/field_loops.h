// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include "core/support/gradient.h"
#include "volcontact/pair/pressure/pressure_field.h"

namespace volcontact::test {

/// The overlap of a pair, and the sum of the fields of all its sites.
struct FieldSum {
  Interference overlap;
  PressureField field;  ///< couple about A's origin
  std::vector<Vec3> by_site;
};

inline FieldSum field_sum(const Shape& a, const Shape& b, const Pose& X_AB, double share = 0.4) {
  static InterferenceWorkspace workspace;
  static PressureScratch scratch;
  FieldSum sum;
  interference(a, b, X_AB, {.tolerance = 1e-5}, workspace, sum.overlap);
  const std::vector<VolumeMetrics>& sites = sum.overlap.sites;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const PressureField field = pressure_field(a, b, X_AB, {sites, i, share, {}}, scratch);
    sum.field.energy += field.energy;
    sum.field.error += field.error;
    sum.field.force += field.force;
    sum.field.couple += field.couple + sites[i].centroid.cross(field.force);
    sum.by_site.push_back(field.force);
  }
  return sum;
}

/// Work of the field over a closed path of B about X_AB, over the largest energy on it.
inline double loop_work(const Shape& a, const Shape& b, const Pose& X_AB, int samples) {
  const Vec3 u(0.004, 0.002, -0.003), v(-0.001, 0.004, 0.002), axis(0.05, -0.03, 0.06);
  double work = 0.0, most = 0.0;
  for (int i = 0; i < samples; ++i) {
    const double s = 2.0 * kPi * i / samples;
    const Pose X = moved({X_AB.rotation, Vec3::Zero()}, Vec3::Zero(), std::sin(s) * axis);
    const Vec3 place = X_AB.translation + std::cos(s) * u + std::sin(2.0 * s) * v;
    const Vec3 velocity = -std::sin(s) * u + 2.0 * std::cos(2.0 * s) * v;
    const Vec3 rotation = std::cos(s) * axis;
    const FieldSum sum = field_sum(a, b, {X.rotation, place});
    const Vec3 couple = sum.field.couple - place.cross(sum.field.force);  // about B's origin
    work -= 2.0 * kPi / samples * (sum.field.force.dot(velocity) + couple.dot(rotation));
    most = std::max(most, sum.field.energy);
  }
  return most > 0.0 ? std::abs(work) / most : kInfinity;
}

}  // namespace volcontact::test
