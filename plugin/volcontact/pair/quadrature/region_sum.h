// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "volcontact/metrics/volume_metrics.h"

namespace volcontact::clipping {

inline constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// Area of a face and the integral of x over it, about the origin of its RegionSum.
struct FaceIntegral {
  double area;
  Vec3 first;
};

/// Moments of a region from its plane faces, about `origin`, a point of the region: any other
/// origin costs accuracy. docs/theory.md, "Clipping".
struct RegionSum {
  Vec3 origin = Vec3::Zero();
  double volume = 0.0;
  Vec3 first = Vec3::Zero();
  double xx = 0.0, xy = 0.0, xz = 0.0, yy = 0.0, yz = 0.0, zz = 0.0;
  Vec3 area_vector = Vec3::Zero();
  Vec3 area_moment = Vec3::Zero();
  double area = 0.0;
  double counter_area = 0.0;

  /// Adds the fluxes of x, x x and x x x^T through a face, whose sums over the closed surface are
  /// 3 V, 4 int x dV and 5 int x x^T dV. `point(i)`, i below `count`, goes around the face
  /// counterclockwise seen from outside. A plane nearer to the origin than `flat` has no flux.
  template <typename PointAt>
  FaceIntegral add_face(int count, PointAt&& point, const Vec3& normal, double flat) {
    const Vec3 a = point(0) - origin;
    const double distance = normal.dot(a);
    const bool has_flux = std::abs(distance) > flat;
    double area2 = 0.0, qxx = 0.0, qxy = 0.0, qxz = 0.0, qyy = 0.0, qyz = 0.0, qzz = 0.0;
    Vec3 sum = Vec3::Zero();
    Vec3 b = point(1) - origin, to_b = b - a;
    for (int i = 2; i < count; ++i) {
      const Vec3 c = point(i) - origin, to_c = c - a, s = a + b + c;
      const double w = normal.dot(to_b.cross(to_c));  // twice the area of the triangle a b c
      area2 += w;
      sum += w * s;
      if (has_flux) {
        qxx += w * (s.x() * s.x() + a.x() * a.x() + b.x() * b.x() + c.x() * c.x());
        qxy += w * (s.x() * s.y() + a.x() * a.y() + b.x() * b.y() + c.x() * c.y());
        qxz += w * (s.x() * s.z() + a.x() * a.z() + b.x() * b.z() + c.x() * c.z());
        qyy += w * (s.y() * s.y() + a.y() * a.y() + b.y() * b.y() + c.y() * c.y());
        qyz += w * (s.y() * s.z() + a.y() * a.z() + b.y() * b.z() + c.y() * c.z());
        qzz += w * (s.z() * s.z() + a.z() * a.z() + b.z() * b.z() + c.z() * c.z());
      }
      b = c;
      to_b = to_c;
    }
    if (has_flux) {
      volume += distance / 6.0 * area2;
      first += distance / 24.0 * sum;
      const double factor = distance / 120.0;
      xx += factor * qxx;
      xy += factor * qxy;
      xz += factor * qxz;
      yy += factor * qyy;
      yz += factor * qyz;
      zz += factor * qzz;
    }
    return {0.5 * area2, sum / 6.0};
  }

  /// Bound of the rounding in the volume, when positions are known to `rounding` [m].
  double volume_error(double rounding) const {
    return 8.0 * kEpsilon * volume + 2.0 * rounding * (area + counter_area);
  }

  /// A volume that its rounding may have made: none, with an error that holds what may be there.
  VolumeMetrics none(double rounding) const {
    VolumeMetrics m;
    m.volume_error = volume_error(rounding) + std::max(0.0, volume);
    return m;
  }

  /// Volume with its error, areas, centroid and inertia; the centroid still relative to `origin`.
  VolumeMetrics metrics(double rounding) const {
    VolumeMetrics m;
    m.volume = volume;
    m.volume_error = volume_error(rounding);
    const Vec3 c = first / volume;
    m.centroid = c;
    const double sxx = xx - first.x() * c.x(), syy = yy - first.y() * c.y(),
                 szz = zz - first.z() * c.z(), sxy = xy - first.x() * c.y(),
                 sxz = xz - first.x() * c.z(), syz = yz - first.y() * c.z();
    m.inertia = {syy + szz, -sxy, -sxz, -sxy, sxx + szz, -syz, -sxz, -syz, sxx + syy};
    m.area = area;
    m.counter_area = counter_area;
    return m;
  }
};

}  // namespace volcontact::clipping
