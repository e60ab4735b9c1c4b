// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "volcontact/metrics/volume_metrics.h"

namespace volcontact {

/// Depth and depth moment of an overlap whose columns nobody looked at: those of a layer as thick
/// everywhere, which has the variance thickness^2 / 12 across. docs/theory.md, "Columns over round
/// solids".
inline void set_depth_of_layer(VolumeMetrics& m) {
  if (!m.touching()) return;
  const Mat3 variance = m.second_moment() / m.volume;
  const Vec3 n = m.normal();
  const double across = n.isZero(0.0) ? variance.trace() / 3.0 : n.dot(variance * n);
  m.depth = std::sqrt(12.0 * std::max(0.0, across));
  m.depth_moment = 0.5 * m.volume * m.depth;
}

}  // namespace volcontact
