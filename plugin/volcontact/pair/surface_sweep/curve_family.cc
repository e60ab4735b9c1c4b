// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/surface_sweep/curve_family.h"

#include <algorithm>
#include <cmath>

namespace volcontact {
namespace {

using Kind = SweepFace::Kind;

constexpr double kPole = 0.5 * kPi - 1e-9;  // as good as the pole: what is left is 1e-18
constexpr double kAside = 0.3;              // of a ball's radius: the box is to one side
constexpr double kFlatTurn = 1.4;  // half a range of angles within which a box is aside [rad]

}  // namespace

CurveFamily::CurveFamily(const SweepFace& face, const Vec3& half) : face_(face) {
  if (face.kind == Kind::kPlane) set_plane(half);
  if (face.kind == Kind::kBall) set_ball(half);
  if (face.kind == Kind::kTube) {
    const Vec3 r0 = face.round.map.row(0), r1 = face.round.map.row(1);
    radius_ = 1.0 / r0.norm();
    set_about_axis(r0.cross(r1).normalized(), half);
  }
  if (face.kind == Kind::kCone) {
    const Vec3 r2 = face.round.map.row(2);
    slope_ = r2.norm() / face.round.map.row(0).norm();
    set_about_axis(r2.normalized(), half);
  }
  if (face.kind == Kind::kTorus) {
    radius_ = face.major;
    set_about_axis(face.normal, half);
  }
}

// Lines along the longest side of the plane's part of the box.
void CurveFamily::set_plane(const Vec3& half) {
  axis_ = face_.normal;
  origin_ = face_.offset * axis_;
  // Across the lines is the axis of the box that is least of those near to the plane.
  int across = -1;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(axis_[i]) > 0.8) continue;
    if (across < 0 || half[i] < half[across]) across = i;
  }
  const Vec3 e = Vec3::Unit(across) - axis_[across] * axis_;
  e_ = e.normalized();
  f_ = axis_.cross(e_);
  low_ = kInfinity;
  high_ = -kInfinity;
  for (int i = 0; i < 8; ++i) {
    const Vec3 p = half.cwiseProduct(corner_signs(i));
    const double height = axis_.dot(p) - face_.offset;
    for (int k = 0; k < 3; ++k) {
      if (i & (1 << k)) continue;
      const Vec3 q = half.cwiseProduct(corner_signs(i | (1 << k)));
      const double other = axis_.dot(q) - face_.offset;
      if ((height > 0.0) == (other > 0.0)) continue;
      const double at = e_.dot(p + height / (height - other) * (q - p));
      low_ = std::min(low_, at);
      high_ = std::max(high_, at);
    }
  }
}

void CurveFamily::set_about_axis(const Vec3& axis, const Vec3& half) {
  axis_ = axis;
  origin_ = face_.round.center;
  const Vec3 middle = -origin_ + axis_.dot(origin_) * axis_;
  const double away = middle.norm();
  e_ = away > 1e-3 * half.norm() ? Vec3(middle / away) : Vec3(basis_with_z(axis_).col(0));
  f_ = axis_.cross(e_);
  low_ = kInfinity;
  high_ = -kInfinity;
  for (int i = 0; i < 8; ++i) {
    const Vec3 p = half.cwiseProduct(corner_signs(i)) - origin_;
    const double angle = std::atan2(f_.dot(p), e_.dot(p));
    low_ = std::min(low_, angle);
    high_ = std::max(high_, angle);
  }
  turn_ = !(low_ > -kFlatTurn && high_ < kFlatTurn);
  if (!turn_) return;
  low_ = -kPi;
  high_ = kPi;
}

// Circles of latitude about the direction towards the box.
void CurveFamily::set_ball(const Vec3& half) {
  const RoundFace& round = face_.round;
  origin_ = round.center;
  inverse_ = round.map.inverse();
  scale_ = std::abs(inverse_.determinant());
  const Vec3 middle = round.map * -origin_;
  const double away = middle.norm();
  axis_ = away > kAside ? Vec3(middle / away) : Vec3::UnitZ();
  const Mat3 basis = basis_with_z(axis_);
  e_ = basis.col(0);
  f_ = basis.col(1);
  double least = 1.0, most = -1.0;
  for (int i = 0; i < 8; ++i) {
    const double height = axis_.dot(round.map * (half.cwiseProduct(corner_signs(i)) - origin_));
    least = std::min(least, height);
    most = std::max(most, height);
  }
  low_ = std::max(-kPole, std::asin(std::clamp(least, -1.0, 1.0)));
  high_ = std::min(kPole, std::asin(std::clamp(most, -1.0, 1.0)));
}

FaceCurve CurveFamily::curve(double u) const {
  FaceCurve curve;
  if (face_.kind == Kind::kPlane) {
    curve.p = origin_ + u * e_;
    curve.u = f_;
    curve.v = Vec3::Zero();
    return curve;
  }
  const double c = std::cos(u), s = std::sin(u);
  if (face_.kind == Kind::kBall) {
    curve.circle = true;
    curve.p = origin_ + inverse_ * (s * axis_);
    curve.u = inverse_ * (c * e_);
    curve.v = inverse_ * (c * f_);
    return curve;
  }
  const Vec3 out = c * e_ + s * f_;
  curve.p = origin_ + radius_ * out;
  curve.u = axis_;
  curve.v = Vec3::Zero();
  if (face_.kind == Kind::kCone) curve.u += slope_ * out;
  if (face_.kind == Kind::kTorus) {
    curve.circle = true;
    curve.u = face_.minor * out;
    curve.v = face_.minor * axis_;
  }
  return curve;
}

Vec3 CurveFamily::element(double u, double t, const Vec3& x) const {
  if (face_.kind == Kind::kPlane) return axis_;
  const double c = std::cos(u), s = std::sin(u);
  if (face_.kind == Kind::kBall) {
    return scale_ * c * (face_.round.map.transpose() * (face_.round.map * (x - origin_)));
  }
  const Vec3 out = c * e_ + s * f_;
  if (face_.kind == Kind::kTube) return radius_ * out;
  if (face_.kind == Kind::kCone) return slope_ * t * (out - slope_ * axis_);
  const double tc = std::cos(t), ts = std::sin(t);
  return face_.minor * (face_.major + face_.minor * tc) * (tc * out + ts * axis_);
}

void CurveFamily::locate(const Vec3& x, double& u, double& t) const {
  const Vec3 d = x - origin_;
  if (face_.kind == Kind::kPlane) {
    u = e_.dot(d);
    t = f_.dot(d);
    return;
  }
  if (face_.kind == Kind::kBall) {
    const Vec3 y = face_.round.map * d;
    u = std::atan2(axis_.dot(y), std::hypot(e_.dot(y), f_.dot(y)));
    t = std::atan2(f_.dot(y), e_.dot(y));
    return;
  }
  u = std::atan2(f_.dot(d), e_.dot(d));
  t = axis_.dot(d);
  if (face_.kind != Kind::kTorus) return;
  t = std::atan2(t, std::hypot(e_.dot(d), f_.dot(d)) - face_.major);
}

}  // namespace volcontact
