// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/metrics/volume_metrics.h"
#include "volcontact/pair/face_set.h"

namespace volcontact {

/// A connected part of the overlap of two convex bodies, in A's frame and about its origin, and the
/// parts of its surface that lie in plane faces.
struct LinesRegion {
  struct PlanePatch {
    Owner owner;
    Vec3 normal;    ///< of the face, unit length
    double offset;  ///< normal . x = offset
    double area;    ///< of the patch [m^2]
    Vec3 centroid;  ///< of the patch
  };
  VolumeMetrics metrics;
  std::vector<PlanePatch> patches;
  int piece[2] = {0, 0};  ///< of A and B
};

}  // namespace volcontact
