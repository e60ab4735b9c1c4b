// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>

#include "volcontact/pair/closed_form/spherical_cap.h"
#include "volcontact/shape/ellipsoid.h"
#include "volcontact/shape/half_space.h"

namespace volcontact {

/// Ellipsoid B in half-space A, in A: the affine image of a cap of the unit ball. Fully immersed as
/// with the ball. `area`, the flat cut, is exact. The curved `counter_area` has no closed form: it
/// is an upper bound (Cauchy-Schwarz over the cap), sharp for a ball and for a thin cap; the
/// smaller of the two, which flatness() uses, is always the exact one. docs/theory.md, "Ellipsoid
/// cap".
inline VolumeMetrics closed_form(const HalfSpace&, const Ellipsoid& b, const Pose& X_AB) noexcept {
  const Vec3& a = b.semi_axes();
  const Vec3& center = X_AB.translation;
  const Mat3 map = X_AB.rotation * a.asDiagonal();  // unit ball about its centre to A's axes
  const double reach = map.row(2).norm();           // support height of the ellipsoid [m]
  const double h = std::min(reach - center.z(), 2.0 * reach);
  VolumeMetrics m;
  if (!(h > 0.0)) return m;
  const SphericalCap cap = spherical_cap(1.0, h / reach);
  const double scale = a.prod();  // of volumes
  m.volume = scale * cap.volume;
  if (!(m.volume > 0.0)) return VolumeMetrics{};

  const bool immersed = !(h < 2.0 * reach);
  const Vec3 up = map.row(2).transpose() / reach;  // image of the plane normal in the unit ball
  const Vec3 axis = map * up;                      // from the centre to the topmost point, in A
  const double s = h / reach;
  const Vec3 cut_center = center - (1.0 - s) * axis;
  m.centroid = cut_center - cap.centroid_depth * axis;
  m.centroid.z() = immersed ? center.z() : -reach * cap.centroid_depth;

  // Second moments: lateral (map (1 - up up^T) map^T) + axial (axis axis^T). The first matrix has
  // no z entries; as products of the rows' parts across `up` it suffers no cancellation.
  const Vec3 row_x = map.row(0).transpose().cross(up), row_y = map.row(1).transpose().cross(up);
  const double lateral = scale * cap.lateral_second, axial = scale * cap.axial_second;
  Mat3 second = axial * axis * axis.transpose();
  second(0, 0) += lateral * row_x.squaredNorm();
  second(1, 1) += lateral * row_y.squaredNorm();
  second(0, 1) += lateral * row_x.dot(row_y);
  second(1, 0) = second(0, 1);
  m.inertia = second.trace() * Mat3::Identity() - second;

  const double stretch = scale / reach;  // of areas across `up`
  m.area = stretch * cap.cut_area;
  m.area_vector.z() = m.area;
  m.area_moment = Vec3(cut_center.y() * m.area, -cut_center.x() * m.area, 0.0);
  m.depth_moment = immersed ? -center.z() * m.volume : reach * scale * cap.depth_moment;
  m.depth = h;

  // Area factor of the map at the point u of the unit sphere: |cofactor u|; mean square over the
  // cap.
  const double cofactors =
      std::pow(a.y() * a.z(), 2) + std::pow(a.z() * a.x(), 2) + std::pow(a.x() * a.y(), 2);
  const double lateral_square = kPi * s * s * (3.0 - s) / 3.0;  // int (u . e)^2, e across `up`
  const double axial_square = cap.lateral_area - 2.0 * lateral_square;
  m.counter_area = std::sqrt(cap.lateral_area * (lateral_square * (cofactors - stretch * stretch) +
                                                 axial_square * stretch * stretch));
  m.volume_error = std::numeric_limits<double>::epsilon() *
                   (16.0 * m.volume + 8.0 * m.area * (reach + std::abs(center.z())));
  m.status = immersed ? Status::kContained : Status::kOk;
  return m;
}

}  // namespace volcontact
