// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "volcontact/base/disjoint_sets.h"
#include "volcontact/pair/overlap.h"
#include "volcontact/pair/sections/section_region.h"
#include "volcontact/shape/csg/csg.h"

namespace volcontact {

inline constexpr double kSamePlane = 1e-9;     ///< of normals, and of offsets per size of a patch
inline constexpr double kSeamRounding = 1e-5;  ///< of S where that of the parts cancels, per area

inline double patch_slack(const LinesRegion::PlanePatch& patch) {
  return kSamePlane * (std::sqrt(patch.area) + patch.centroid.norm());
}

inline bool same_plane(const LinesRegion::PlanePatch& patch, const Vec3& normal, double offset) {
  return (patch.normal - normal).norm() < kSamePlane &&
         std::abs(patch.offset - offset) < patch_slack(patch);
}

/// Whether a patch lies in a seam of its piece, whose solid has the pose X in the patch's frame.
inline bool lies_in_seam(const LinesRegion::PlanePatch& patch, const std::vector<Seam>* seams,
                         const Pose& X) {
  if (!seams) return false;
  return std::any_of(seams->begin(), seams->end(), [&](const Seam& seam) {
    const Vec3 normal = X.rotation * seam.normal;
    return same_plane(patch, normal, seam.offset + normal.dot(X.translation));
  });
}

/// Regions on the two sides of a seam have the same patch there: they are one site, and the patch
/// is no surface. `holds(region, patch)`: whether the patch of another region belongs to this one
/// as well. Writes the sites and their sum.
template <typename Holds>
class RegionJoin {
 public:
  RegionJoin(LinesRegions& regions, std::vector<int>& site_of, Holds& holds, Interference& out)
      : regions_(regions), site_of_(site_of), holds_(holds), out_(out) {}

  void run() {
    const int n = static_cast<int>(regions_.size());
    make_sets(site_of_, regions_.size());
    for (int i = 0; i < n; ++i) {
      for (LinesRegion::PlanePatch& p : regions_[i].patches) {
        for (int j = 0; j < i; ++j) {
          for (LinesRegion::PlanePatch& q : regions_[j].patches) join(i, p, j, q);
        }
      }
    }
    out_.sites.clear();
    out_.total = VolumeMetrics{};
    for (int site = 0; site < n; ++site) {
      if (site_of_[site] != site) continue;
      VolumeMetrics sum = regions_[site].metrics;
      for (int i = site + 1; i < n; ++i) {
        if (root_of(site_of_, i) == site) sum = sum + regions_[i].metrics;
      }
      settle_status(sum);
      bound_area_vector(sum);
      out_.total = out_.sites.empty() ? sum : out_.total + sum;
      out_.sites.push_back(sum);
    }
  }

 private:
  void join(int i, LinesRegion::PlanePatch& p, int j, LinesRegion::PlanePatch& q) {
    if (p.owner != q.owner || !same_plane(p, -q.normal, -q.offset)) return;
    const double shared = std::min(p.area, q.area);
    if (!(shared > 0.0)) return;
    if (!holds_(regions_[i], q) && !holds_(regions_[j], p)) return;
    join_sets(site_of_, i, j);
    for (int k : {i, j}) {
      VolumeMetrics& m = regions_[k].metrics;
      double& area = p.owner == Owner::kA ? m.area : m.counter_area;
      area = std::max(0.0, area - shared);
    }
    p.area -= shared;
    q.area -= shared;
  }

  // A part that is contained is no contained solid, unless it is all of the overlap.
  static void settle_status(VolumeMetrics& m) {
    if (m.status == Status::kContained && m.area > 0.0 && m.counter_area > 0.0) {
      m.status = Status::kOk;
    }
  }

  // No area vector is longer than an area. Where seams leave next to nothing of a surface, those of
  // the regions cancel but for rounding.
  static void bound_area_vector(VolumeMetrics& m) {
    const double length = m.area_vector.norm(), least = std::min(m.area, m.counter_area);
    if (!(length > least && length < kSeamRounding * std::max(m.area, m.counter_area))) return;
    m.area_vector *= least / length;
    m.area_moment *= least / length;
  }

  LinesRegions& regions_;
  std::vector<int>& site_of_;
  Holds& holds_;
  Interference& out_;
};

template <typename Holds>
void join_regions(LinesRegions& regions, std::vector<int>& site_of, Holds&& holds,
                  Interference& out) {
  RegionJoin(regions, site_of, holds, out).run();
}

}  // namespace volcontact
