// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>

#include "volcontact/pair/closed_form/spherical_cap.h"
#include "volcontact/shape/ellipsoid.h"
#include "volcontact/shape/half_space.h"

namespace volcontact {

/// What does not depend on the frame in which the metrics of an ellipsoid's cap are wanted.
struct EllipsoidCap {
  VolumeMetrics metrics;  ///< with the flat cut as `area`; no centroid, inertia and vectors
  double share = 0.0;     ///< height of the cap in the unit ball
  double offset = 0.0;    ///< of the centroid from the centre, downwards, in half axes
  double lateral = 0.0, axial = 0.0;  ///< second moments over squares of half axes [m^3]
};

/// `reach` is the height of the topmost point over the centre, `height` that of the centre.
inline EllipsoidCap ellipsoid_cap(const Vec3& a, double reach, double height) {
  EllipsoidCap result;
  VolumeMetrics& m = result.metrics;
  const double h = std::min(reach - height, 2.0 * reach);
  if (!(h > 0.0)) return result;
  const double per_reach = 1.0 / reach, s = h * per_reach;
  const SphericalCap cap = spherical_cap(1.0, s);
  const double scale = a.prod();  // of volumes
  if (!(scale * cap.volume > 0.0)) return result;
  const bool immersed = !(h < 2.0 * reach);
  m.volume = scale * cap.volume;
  result.share = s;
  result.offset = immersed ? 0.0 : 1.0 - s + cap.centroid_depth;
  result.lateral = scale * cap.lateral_second;
  result.axial = scale * cap.axial_second;

  const double stretch = scale * per_reach;  // of areas across `up`
  m.area = stretch * cap.cut_area;
  m.depth_moment = immersed ? -height * m.volume : reach * scale * cap.depth_moment;
  m.depth = h;

  // Area factor of the map at the point u of the unit sphere: |cofactor u|; mean square over the
  // cap.
  const double xy = a.x() * a.y(), yz = a.y() * a.z(), zx = a.z() * a.x();
  const double lateral_square = kPi * s * s * (3.0 - s) / 3.0;  // int (u . e)^2, e across `up`
  const double axial_square = cap.lateral_area - 2.0 * lateral_square;
  m.counter_area = std::sqrt(cap.lateral_area *
                             (lateral_square * (xy * xy + yz * yz + zx * zx - stretch * stretch) +
                              axial_square * stretch * stretch));
  m.volume_error = std::numeric_limits<double>::epsilon() *
                   (16.0 * m.volume + 8.0 * m.area * (reach + std::abs(height)));
  m.status = immersed ? Status::kContained : Status::kOk;
  return result;
}

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
  const EllipsoidCap cap = ellipsoid_cap(a, reach, center.z());
  VolumeMetrics m = cap.metrics;
  if (!m.touching()) return m;
  const Vec3 up = map.row(2) * (1.0 / reach);  // plane normal's image in the unit ball
  const Vec3 axis = map * up;                  // from the centre to the topmost point, in A
  m.centroid = center - cap.offset * axis;
  if (cap.offset != 0.0) m.centroid.z() = -m.depth_moment / m.volume;

  // Second moments: lateral (map (1 - up up^T) map^T) + axial (axis axis^T). The first matrix has
  // no z entries; as products of the rows' parts across `up` it suffers no cancellation.
  const Vec3 row_x = map.row(0).cross(up), row_y = map.row(1).cross(up);
  const double xx = cap.axial * axis.x() * axis.x() + cap.lateral * row_x.squaredNorm();
  const double yy = cap.axial * axis.y() * axis.y() + cap.lateral * row_y.squaredNorm();
  const double xy = cap.axial * axis.x() * axis.y() + cap.lateral * row_x.dot(row_y);
  const double zz = cap.axial * axis.z() * axis.z();
  const double xz = cap.axial * axis.x() * axis.z(), yz = cap.axial * axis.y() * axis.z();
  m.inertia = {yy + zz, -xy, -xz, -xy, xx + zz, -yz, -xz, -yz, xx + yy};

  const Vec3 cut_center = center - (1.0 - cap.share) * axis;
  m.area_vector.z() = m.area;
  m.area_moment = Vec3(cut_center.y() * m.area, -cut_center.x() * m.area, 0.0);
  return m;
}

/// The same with the ellipsoid as A, in its frame: less work than the mirror image.
inline VolumeMetrics closed_form(const Ellipsoid& b, const HalfSpace&, const Pose& X_AB) noexcept {
  const Vec3& a = b.semi_axes();
  const Vec3 normal = X_AB.rotation.col(2);
  const Vec3 image = a.cwiseProduct(normal);  // of the plane's normal in the unit ball
  const double reach = image.norm();
  const EllipsoidCap cap = ellipsoid_cap(a, reach, -normal.dot(X_AB.translation));
  VolumeMetrics m = cap.metrics;
  if (!m.touching()) return m;
  const Vec3 axis = a.cwiseProduct(image) * (1.0 / reach);  // to the topmost point
  m.centroid = -cap.offset * axis;
  const double along = cap.axial - cap.lateral;
  const double xx = cap.lateral * a.x() * a.x() + along * axis.x() * axis.x();
  const double yy = cap.lateral * a.y() * a.y() + along * axis.y() * axis.y();
  const double zz = cap.lateral * a.z() * a.z() + along * axis.z() * axis.z();
  const double xy = along * axis.x() * axis.y(), xz = along * axis.x() * axis.z(),
               yz = along * axis.y() * axis.z();
  m.inertia = {yy + zz, -xy, -xz, -xy, xx + zz, -yz, -xz, -yz, xx + yy};
  m.area_vector = -m.area * normal;
  m.area_moment = (cap.share - 1.0) * axis.cross(m.area_vector);
  std::swap(m.area, m.counter_area);
  return m;
}

}  // namespace volcontact
