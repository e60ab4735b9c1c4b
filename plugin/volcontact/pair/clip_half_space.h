// SPDX-License-Identifier: Apache-2.0
#pragma once

// A half-space below the plane z = 0 needs no graph: each face of the solid is cut on its own. Two
// faces cut their common edge by the same operations, so that the surface stays closed bit for bit,
// and the lid on the plane follows from that. Part of clip.cc.
#include <algorithm>
#include <span>
#include <vector>

#include "volcontact/pair/region_sum.h"

namespace volcontact::clipping {

// The point of an edge on the plane; `below` and `above` are its ends, in this order in both faces.
inline Vec3 on_plane(const Vec3& below, const Vec3& above) {
  const double t = below.z() / (below.z() - above.z());
  Vec3 p = below + t * (above - below);
  p.z() = 0.0;
  return p;
}

// The part of a face at z <= 0; the number of its points. Without branches on the heights: no
// processor could predict them.
inline int cut_face(std::span<const int> loop, std::span<const Vec3> corners, Vec3* part) {
  Vec3* end = part;
  const Vec3* last = &corners[loop.back()];
  for (int index : loop) {
    const Vec3* p = &corners[index];
    const bool last_is_above = last->z() > 0.0, is_above = p->z() > 0.0;
    *end = on_plane(last_is_above ? *p : *last, last_is_above ? *last : *p);
    end += last_is_above != is_above;
    *end = *p;
    end += !is_above;
    last = p;
  }
  return static_cast<int>(end - part);
}

// Metrics of the part below z = 0 of a solid with these corners and faces, moved by `shift`.
template <typename Loop, typename Normal>
VolumeMetrics measure_below(std::span<const Vec3> corners, int faces, Loop&& loop, Normal&& normal,
                            double rounding, const Vec3& shift, std::vector<Vec3>& part) {
  RegionSum sum;
  double lowest = 0.0;
  for (const Vec3& p : corners) {
    if (p.z() < lowest) {
      lowest = p.z();
      sum.origin = Vec3(p.x(), p.y(), 0.0);
    }
  }
  if (part.size() < 2 * corners.size()) part.resize(2 * corners.size());
  for (int f = 0; f < faces; ++f) {
    const int count = cut_face(loop(f), corners, part.data());
    if (count < 3) continue;
    const Vec3 n = normal(f);
    const FaceIntegral face =
        sum.add_face(count, [&](int i) -> const Vec3& { return part[i]; }, n, 0.0);
    sum.counter_area += face.area;
    sum.area_vector -= face.area * n;
    sum.area_moment -= face.first.cross(n);
  }
  // The whole surface has S = T = 0: what the faces leave is the lid.
  sum.area = std::max(0.0, sum.area_vector.z());
  if (!(sum.volume > sum.volume_error(rounding))) return VolumeMetrics{};
  VolumeMetrics m = sum.metrics(rounding);
  const Vec3 moved = shift + sum.origin;
  m.centroid += moved;
  m.area_vector = Vec3(0.0, 0.0, sum.area);
  m.area_moment = Vec3(sum.area_moment.x() + moved.y() * sum.area,
                       sum.area_moment.y() - moved.x() * sum.area, 0.0);
  m.depth = -lowest;
  m.depth_moment = std::max(0.0, -sum.first.z());
  return m;
}

}  // namespace volcontact::clipping
