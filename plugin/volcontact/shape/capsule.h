// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "volcontact/base/fields.h"
#include "volcontact/shape/pieces.h"
#include "volcontact/shape/solid.h"

namespace volcontact {

/// All points within `radius` of the segment of the z axis from -half_length to +half_length: a
/// cylinder of that half length with a half ball on each end.
class Capsule {
 public:
  static constexpr const char* kName = "capsule";
  struct Params {
    double radius = 1.0;
    double half_length = 1.0;
  };
  static constexpr std::array kFields{
      Field<Params>{"radius", "m", &Params::radius, kNonNegative, "radius"},
      Field<Params>{"half_length", "m", &Params::half_length, kNonNegative,
                    "half the length of the cylinder, without the round ends"}};

  explicit Capsule(const Params& params) : p_(validated<Capsule>(params)) {}
  const Params& params() const { return p_; }
  double radius() const { return p_.radius; }
  double half_length() const { return p_.half_length; }

  Aabb bounds() const {
    const Vec3 half(p_.radius, p_.radius, p_.radius + p_.half_length);
    return {-half, half};
  }
  Vec3 support(const Vec3& e) const {
    return p_.radius * e.normalized() + Vec3(0.0, 0.0, std::copysign(p_.half_length, e.z()));
  }
  double support_height(const Vec3& e) const {
    return p_.radius * e.norm() + p_.half_length * std::abs(e.z());
  }
  double signed_distance(const Vec3& p) const { return from_axis(p).norm() - p_.radius; }
  Vec3 gradient(const Vec3& p) const {
    const Vec3 offset = from_axis(p);
    const double length = offset.norm();
    return length > 0.0 ? Vec3(offset / length) : Vec3::UnitX();
  }
  RayInterval ray(const Vec3& o, const Vec3& d) const {
    // The solid is convex: the interval is the hull of those of its three parts.
    RayInterval hull;
    const auto join = [&hull](const RayInterval& part) {
      if (part.empty()) return;
      hull = hull.empty()
                 ? part
                 : RayInterval{std::min(hull.enter, part.enter), std::max(hull.leave, part.leave)};
    };
    join(middle(o, d));
    join(end_ball(o, d, p_.half_length));
    join(end_ball(o, d, -p_.half_length));
    return hull;
  }
  VolumeMetrics own_metrics() const {
    const double r = p_.radius, h = p_.half_length;
    const double r2 = r * r;
    VolumeMetrics m;
    m.volume = kPi * r2 * (2.0 * h + 4.0 / 3.0 * r);
    // int x^2 and int z^2: cylinder, ball, and what moving the half balls apart by h adds.
    const double xx = kPi * r2 * r2 * (h / 2.0 + 4.0 / 15.0 * r);
    const double zz =
        kPi * r2 * (2.0 / 3.0 * h * h * h + 4.0 / 15.0 * r * r2 + r2 * h + 4.0 / 3.0 * r * h * h);
    m.inertia = Vec3(xx + zz, xx + zz, 2.0 * xx).asDiagonal();
    return m;
  }
  void pieces(PieceList& list) const {
    const double r2 = p_.radius * p_.radius, h = p_.half_length;
    list.add(Quadric::round({1.0, 1.0, 0.0}, Vec3::Zero(), r2));
    list.add(Quadric::seam_plane(Vec3::UnitZ(), h));
    list.add(Quadric::seam_plane(-Vec3::UnitZ(), h));
    list.end_piece();
    for (const double side : {1.0, -1.0}) {
      list.add(Quadric::round(Vec3::Ones(), Vec3(0.0, 0.0, side * h), r2));
      list.add(Quadric::seam_plane(Vec3(0.0, 0.0, -side), -h));
      list.end_piece();
    }
  }
  template <typename Writer>
  void write_parts(Writer& writer) const {
    const double h = p_.half_length;
    writer.plane(Vec3::UnitZ(), h, true);
    writer.plane(-Vec3::UnitZ(), h, true);
    writer.tube(2, p_.radius, Vec3::Zero());
    writer.end_part();
    for (const double side : {1.0, -1.0}) {
      const Vec3 out(0.0, 0.0, side);
      writer.plane(-out, -h, true);
      writer.ball(p_.radius, h * out);
      writer.end_part();
    }
  }
  template <typename Writer>
  void write_faces(Writer& writer) const {
    writer.rounded_tube(p_.radius, p_.half_length);
  }

 private:
  Vec3 from_axis(const Vec3& p) const {
    return {p.x(), p.y(), p.z() - std::clamp(p.z(), -p_.half_length, p_.half_length)};
  }
  // Nearest point to the axis, or to the centre, first: no cancellation for far origins.
  RayInterval middle(const Vec3& o, const Vec3& d) const {
    RayInterval span{-kInfinity, kInfinity};
    const double slope = d.x() * d.x() + d.y() * d.y();
    const double t_mid = slope > 0.0 ? -(o.x() * d.x() + o.y() * d.y()) / slope : 0.0;
    const double x = o.x() + t_mid * d.x(), y = o.y() + t_mid * d.y();
    const double reach = p_.radius * p_.radius - (x * x + y * y);
    if (!(reach > 0.0)) return {};
    if (slope > 0.0) {
      const double half = std::sqrt(reach / slope);
      span = {t_mid - half, t_mid + half};
    }
    if (d.z() == 0.0) return std::abs(o.z()) > p_.half_length ? RayInterval{} : span;
    const double at_low = (-p_.half_length - o.z()) / d.z();
    const double at_high = (p_.half_length - o.z()) / d.z();
    return {std::max(span.enter, std::min(at_low, at_high)),
            std::min(span.leave, std::max(at_low, at_high))};
  }
  RayInterval end_ball(const Vec3& o, const Vec3& d, double z) const {
    const Vec3 from(o.x(), o.y(), o.z() - z);
    const double t_mid = -from.dot(d) / d.squaredNorm();
    const double reach = p_.radius * p_.radius - (from + t_mid * d).squaredNorm();
    if (!(reach > 0.0)) return {};
    const double half = std::sqrt(reach / d.squaredNorm());
    return {t_mid - half, t_mid + half};
  }

  Params p_;
};

static_assert(ConvexSolid<Capsule>);

}  // namespace volcontact
