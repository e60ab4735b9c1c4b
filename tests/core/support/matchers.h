// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "volcontact/metrics/volume_metrics.h"

namespace volcontact::test {

/// What counts as the same: `relative` to the size of each field; places to `relative` of `length`.
struct Tolerance {
  double relative;
  double length;  ///< of the solids [m]
};

inline ::testing::AssertionResult within(const char* field, double error, double allowed) {
  if (error <= allowed) return ::testing::AssertionSuccess();  // not so for NaN
  return ::testing::AssertionFailure() << field << " off by " << error << ", allowed " << allowed;
}

/// Every field of the metrics but the error bound.
inline ::testing::AssertionResult same(const VolumeMetrics& m, const VolumeMetrics& expected,
                                       const Tolerance& t) {
  const double r = t.relative;
  const double area = std::max(expected.area, expected.counter_area);
  const ::testing::AssertionResult checks[] = {
      within("volume", std::abs(m.volume - expected.volume), r * expected.volume),
      within("centroid", (m.centroid - expected.centroid).norm(), r * t.length),
      within("inertia", (m.inertia - expected.inertia).norm(), r * expected.inertia.norm()),
      within("area_vector", (m.area_vector - expected.area_vector).norm(), r * area),
      within("area_moment", (m.area_moment - expected.area_moment).norm(), r * area * t.length),
      within("area", std::abs(m.area - expected.area), r * area),
      within("counter_area", std::abs(m.counter_area - expected.counter_area), r * area),
      within("depth_moment", std::abs(m.depth_moment - expected.depth_moment),
             r * expected.depth_moment),
      within("depth", std::abs(m.depth - expected.depth), r * t.length)};
  for (const auto& check : checks) {
    if (!check) return check;
  }
  if (m.status != expected.status) {
    return ::testing::AssertionFailure()
           << "status " << to_string(m.status) << ", expected " << to_string(expected.status);
  }
  return ::testing::AssertionSuccess();
}

}  // namespace volcontact::test
