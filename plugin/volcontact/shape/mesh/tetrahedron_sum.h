// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/metrics/volume_metrics.h"

namespace volcontact {

/// Exact sums over the tetrahedra from an origin to the triangles of a closed surface: the own
/// metrics of the solid in it.
struct TetrahedronSum {
  Vec3 origin;
  MomentSum sum;
  double surface_area = 0.0;

  void add(const Vec3& p, const Vec3& q, const Vec3& r) {
    const Vec3 a = p - origin, b = q - origin, c = r - origin;
    const double det = a.dot(b.cross(c));
    const Vec3 s = a + b + c;
    sum.volume += det / 6.0;
    sum.first += det / 24.0 * s;
    sum.second += det / 120.0 * (outer(s, s) + outer(a, a) + outer(b, b) + outer(c, c));
    surface_area += 0.5 * (b - a).cross(c - a).norm();
  }
  VolumeMetrics metrics() const {
    VolumeMetrics m = sum.metrics();
    m.centroid += origin;
    return m;
  }
};

}  // namespace volcontact
