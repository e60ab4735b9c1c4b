// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "volcontact/pair/surface_sweep/face_curve.h"

namespace volcontact {

/// Two curves in a plane face on both sides of where another face crosses it, `beside` [m] away or
/// about so: where a part of the plane ends at that edge, however small, one of them runs in it.
/// False when there are none: the faces do not cross, or in a curve that is no line, circle or
/// ellipse.
inline bool curves_beside_edge(const SweepFace& plane, const SweepFace& other, double beside,
                               FaceCurve curves[2]) {
  const Vec3& n = plane.normal;
  const Vec3 on_plane = plane.offset * n;
  for (int side = 0; side < 2; ++side) curves[side].circle = false;
  if (other.kind == SweepFace::Kind::kPlane) {
    const Vec3 along = n.cross(other.normal), across = along.cross(n);
    const double sine2 = along.squaredNorm();  // and across . other.normal
    if (!(sine2 > 1e-12)) return false;
    for (int side = 0; side < 2; ++side) {
      const double height = other.offset - other.normal.dot(on_plane);
      FaceCurve& curve = curves[side];
      curve.p = on_plane + (height / sine2) * across;
      curve.p += (side == 0 ? beside : -beside) / std::sqrt(sine2) * across;
      curve.p -= along * (along.dot(curve.p) / sine2);
      curve.u = along / std::sqrt(sine2);
      curve.v = Vec3::Zero();
    }
    return true;
  }
  if (other.kind == SweepFace::Kind::kTorus) return false;
  // q + E c on the plane, where the face is (c - m) . Q (c - m) = rest.
  const RoundFace& round = other.round;
  const Mat3 basis = basis_with_z(n);
  const Vec3 e = basis.col(0), f = basis.col(1);
  const Vec3 y_e = round.map * e, y_f = round.map * f;
  const Vec3 y = round.map * (on_plane - round.center);
  const double ee = y_e.dot(round.weighted(y_e)), ef = y_e.dot(round.weighted(y_f));
  const double ff = y_f.dot(round.weighted(y_f)), det = ee * ff - ef * ef;
  if (!(ee > 0.0 && det > 1e-9 * ee * ee)) return false;
  const double be = y_e.dot(round.weighted(y)), bf = y_f.dot(round.weighted(y));
  const Vec3 middle = on_plane + (ef * bf - ff * be) / det * e + (ef * be - ee * bf) / det * f;
  const double square = -round(middle);
  if (!(square > 0.0)) return false;
  const double root = std::sqrt(square), l = std::sqrt(ee), k = std::sqrt(det) / l;
  const Vec3 u = root / l * e, v = root / k * (f - ef / ee * e);
  const double part = beside / std::max(u.norm(), v.norm());
  if (!(part < 0.5)) return false;
  for (int side = 0; side < 2; ++side) {
    const double scale = side == 0 ? 1.0 + part : 1.0 - part;
    curves[side].circle = true;
    curves[side].p = middle;
    curves[side].u = scale * u;
    curves[side].v = scale * v;
  }
  return true;
}

}  // namespace volcontact
