// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/pieces.h"

namespace volcontact {

Quadric Quadric::plane(const Vec3& normal, double offset) {
  Quadric face;
  face.linear = normal;
  face.constant = -offset;
  return face;
}

Quadric Quadric::seam_plane(const Vec3& normal, double offset) {
  Quadric face = plane(normal, offset);
  face.seam = true;
  return face;
}

Quadric Quadric::round(const Vec3& weights, const Vec3& center, double level) {
  Quadric face;
  face.hessian = (2.0 * weights).asDiagonal();
  face.linear = -2.0 * weights.cwiseProduct(center);
  face.constant = weights.dot(center.cwiseAbs2()) - level;
  face.bend = Bend::kConvex;
  return face;
}

Quadric Quadric::cone(double radius, double slope) {
  Quadric face;
  face.hessian = Vec3(2.0, 2.0, -2.0 * slope * slope).asDiagonal();
  face.linear = Vec3(0.0, 0.0, -2.0 * radius * slope);
  face.constant = -radius * radius;
  face.bend = Bend::kCone;
  face.nappe = Vec3(0.0, 0.0, slope);
  face.nappe_offset = radius;
  return face;
}

Quadric Quadric::reversed() const {
  Quadric face = *this;
  face.hessian = -hessian;
  face.linear = -linear;
  face.constant = -constant;
  face.bend = static_cast<Bend>(-static_cast<int>(bend));
  return face;
}

Quadric transformed(const Quadric& face_S, const Pose& X_SW) {
  const Mat3& r = X_SW.rotation;
  const Vec3& p = X_SW.translation;
  Quadric face = face_S;
  face.linear = r.transpose() * (face_S.linear + face_S.hessian * p);
  face.constant = face_S(p);
  if (face.bend != Bend::kFlat) face.hessian = r.transpose() * face_S.hessian * r;
  face.nappe = r.transpose() * face_S.nappe;
  face.nappe_offset = face_S.nappe_offset + face_S.nappe.dot(p);
  return face;
}

void PieceWriter::tube(int axis, double radius, const Vec3& center) {
  const Vec3 weights = Vec3::Ones() - Vec3::Unit(axis);
  list_.add(Quadric::round(weights, center.cwiseProduct(weights), radius * radius));
}

void PieceWriter::ball(double radius, const Vec3& center) {
  list_.add(Quadric::round(Vec3::Ones(), center, radius * radius));
}

}  // namespace volcontact
