// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/metrics/volume_metrics.h"
#include "volcontact/pair/convex/face_set.h"

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

/// A list of regions that keeps the memory of those it drops.
class LinesRegions {
 public:
  std::size_t size() const { return count_; }
  LinesRegion& operator[](std::size_t i) { return all_[i]; }
  const LinesRegion& operator[](std::size_t i) const { return all_[i]; }

  /// A new region at the end, with zero metrics and no patches.
  LinesRegion& add() {
    if (count_ == all_.size()) all_.emplace_back();
    LinesRegion& region = all_[count_++];
    region.metrics = VolumeMetrics{};
    region.patches.clear();
    return region;
  }
  /// Drops all but the first `count`.
  void cut(std::size_t count) { count_ = count; }

 private:
  std::vector<LinesRegion> all_;
  std::size_t count_ = 0;
};

}  // namespace volcontact
