// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "volcontact/metrics/volume_metrics.h"
#include "volcontact/pair/mesh_columns/radial/radial_search.h"

namespace volcontact {

/// What would fill a bore within its body, in Q: a cylinder or a frustum about z.
struct BorePlug {
  double low, high;    ///< its ends [m]
  double bottom, top;  ///< radii there [m]
  bool exact;  ///< it ends in faces of the body, and no other face cuts it; else it holds more

  bool is_cylinder() const { return bottom == top; }
  Pose pose() const { return {Mat3::Identity(), Vec3(0.0, 0.0, 0.5 * (low + high))}; }
  double half_length() const { return 0.5 * (high - low); }
};

/// The plug of the solid's bore; `lowest` and `highest` are the heights of the body's ends. None
/// where the bore has no radius.
std::optional<BorePlug> bore_plug(const RadialSolid& solid, double lowest, double highest);

/// The metrics `m` of an overlap less those of a part of it, both in one frame. Without
/// counter_area.
VolumeMetrics without(const VolumeMetrics& m, const VolumeMetrics& part);

}  // namespace volcontact
