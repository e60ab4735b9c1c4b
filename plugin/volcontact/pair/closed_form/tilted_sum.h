// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>

#include "volcontact/metrics/volume_metrics.h"

namespace volcontact {

/// How the axis of a body of revolution stands to the half-space z <= 0 of A. Places in the plane
/// through the axis and along z: q along the axis, p across it, upwards.
struct Tilt {
  double sine;    ///< of the angle between axis and z, >= 0
  double cosine;  ///< z component of the axis
  Vec2 heading;   ///< horizontal part of the axis, unit length

  explicit Tilt(const Vec3& axis)
      : sine(std::hypot(axis.x(), axis.y())),
        cosine(axis.z()),
        heading(sine > 0.0 ? Vec2(axis.head<2>() / sine) : Vec2(Vec2::UnitX())) {}

  /// Along the heading, of a place (p, q).
  double forward(double p, double q) const { return sine * q - cosine * p; }
};

/// Integrals over a region that is its own mirror image in the plane of a Tilt, about a point of
/// that plane; r is the direction normal to it.
struct TiltedSum {
  double volume = 0.0;
  double p = 0.0, q = 0.0;                          ///< int p dV, int q dV
  double pp = 0.0, pq = 0.0, qq = 0.0, rr = 0.0;    ///< int p^2 dV and so on
  double depth_moment = 0.0;                        ///< int (depth below z = 0) dV
  double cut_area = 0.0, cut_p = 0.0, cut_q = 0.0;  ///< int 1, p, q dS over the cut at z = 0
  double side_area = 0.0;                           ///< of the body's surface
  double depth = 0.0;

  /// In A, about A's origin; `origin` is that of the sum, `reach` the size of the body [m].
  VolumeMetrics metrics(const Vec3& origin, const Tilt& tilt, double reach) const {
    VolumeMetrics m;
    if (!(volume > 0.0)) return m;
    m.volume = volume;
    const double s = tilt.sine, k = tilt.cosine, ux = tilt.heading.x(), uy = tilt.heading.y();
    const double c_p = p / volume, c_q = q / volume, forward = tilt.forward(c_p, c_q);
    m.centroid = Vec3(origin.x() + forward * ux, origin.y() + forward * uy, -depth_moment / volume);
    // Second moments about the centroid: forward, up and mixed.
    const double v_pp = pp - p * c_p, v_pq = pq - p * c_q, v_qq = qq - q * c_q;
    const double ff = k * k * v_pp - 2.0 * k * s * v_pq + s * s * v_qq;
    const double zz = s * s * v_pp + 2.0 * k * s * v_pq + k * k * v_qq;
    const double fz = k * s * (v_qq - v_pp) + (s * s - k * k) * v_pq;
    const double xx = ff * ux * ux + rr * uy * uy, yy = ff * uy * uy + rr * ux * ux;
    const double xy = (ff - rr) * ux * uy, xz = fz * ux, yz = fz * uy;
    m.inertia = {yy + zz, -xy, -xz, -xy, xx + zz, -yz, -xz, -yz, xx + yy};
    m.area = cut_area;
    m.counter_area = side_area;
    m.area_vector.z() = cut_area;
    const double cut_forward = tilt.forward(cut_p, cut_q);
    m.area_moment = Vec3(origin.y() * cut_area + cut_forward * uy,
                         -origin.x() * cut_area - cut_forward * ux, 0.0);
    m.depth = depth;
    m.depth_moment = depth_moment;
    m.volume_error =
        kRounding * (16.0 * volume + (cut_area + side_area) * (reach + std::abs(origin.z())));
    return m;
  }

  static constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();
};

/// A whole solid below the plane z = 0 of A: no direction, but the depth still means something.
inline VolumeMetrics immersed_solid(const VolumeMetrics& own_B, const Pose& X_AB, double surface,
                                    double depth) {
  VolumeMetrics m = transformed(own_B, X_AB);
  m.counter_area = surface;
  m.depth = depth;
  m.depth_moment = -m.centroid.z() * m.volume;
  m.volume_error = 4.0 * TiltedSum::kRounding * m.volume;
  m.status = Status::kContained;
  return m;
}

}  // namespace volcontact
