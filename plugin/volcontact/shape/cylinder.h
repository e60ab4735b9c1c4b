// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "volcontact/base/fields.h"
#include "volcontact/shape/pieces.h"
#include "volcontact/shape/solid.h"

namespace volcontact {

/// Circular cylinder about the z axis with flat ends at z = -half_length and +half_length.
class Cylinder {
 public:
  static constexpr const char* kName = "cylinder";
  struct Params {
    double radius = 1.0;
    double half_length = 1.0;
  };
  static constexpr std::array kFields{
      Field<Params>{"radius", "m", &Params::radius, kNonNegative, "radius"},
      Field<Params>{"half_length", "m", &Params::half_length, kNonNegative,
                    "half the length between the flat ends"}};

  explicit Cylinder(const Params& params) : p_(validated<Cylinder>(params)) {}
  const Params& params() const { return p_; }
  double radius() const { return p_.radius; }
  double half_length() const { return p_.half_length; }

  Aabb bounds() const {
    const Vec3 half(p_.radius, p_.radius, p_.half_length);
    return {-half, half};
  }
  Vec3 support(const Vec3& e) const {
    const double across = std::hypot(e.x(), e.y());
    const double scale = across > 0.0 ? p_.radius / across : 0.0;
    return {scale * e.x(), scale * e.y(), std::copysign(p_.half_length, e.z())};
  }
  double support_height(const Vec3& e) const {
    return p_.radius * std::hypot(e.x(), e.y()) + p_.half_length * std::abs(e.z());
  }
  double signed_distance(const Vec3& p) const {
    const double side = std::hypot(p.x(), p.y()) - p_.radius;
    const double end = std::abs(p.z()) - p_.half_length;
    if (side <= 0.0 || end <= 0.0) return std::max(side, end);
    return std::hypot(side, end);
  }
  Vec3 gradient(const Vec3& p) const {
    const double across = std::hypot(p.x(), p.y());
    const double side = across - p_.radius;
    const double end = std::abs(p.z()) - p_.half_length;
    const Vec3 outward =
        across > 0.0 ? Vec3(p.x() / across, p.y() / across, 0.0) : Vec3(Vec3::UnitX());
    const Vec3 along(0.0, 0.0, std::copysign(1.0, p.z()));
    if (side <= 0.0 || end <= 0.0) return side >= end ? outward : along;
    return (side * outward + end * along).normalized();
  }
  RayInterval ray(const Vec3& o, const Vec3& d) const {
    RayInterval span{-kInfinity, kInfinity};
    const double slope = d.x() * d.x() + d.y() * d.y();
    // The point of the line nearest the axis first: no cancellation for far origins.
    const double t_mid = slope > 0.0 ? -(o.x() * d.x() + o.y() * d.y()) / slope : 0.0;
    const double x = o.x() + t_mid * d.x(), y = o.y() + t_mid * d.y();
    const double reach = p_.radius * p_.radius - (x * x + y * y);
    if (!(reach > 0.0)) return {};
    if (slope > 0.0) {
      const double half = std::sqrt(reach / slope);
      span = {t_mid - half, t_mid + half};
    }
    if (d.z() != 0.0) {
      const double at_low = (-p_.half_length - o.z()) / d.z();
      const double at_high = (p_.half_length - o.z()) / d.z();
      span.enter = std::max(span.enter, std::min(at_low, at_high));
      span.leave = std::min(span.leave, std::max(at_low, at_high));
    } else if (std::abs(o.z()) > p_.half_length) {
      return {};
    }
    return span.empty() ? RayInterval{} : span;
  }
  VolumeMetrics own_metrics() const {
    const double r2 = p_.radius * p_.radius, h2 = p_.half_length * p_.half_length;
    VolumeMetrics m;
    m.volume = 2.0 * kPi * r2 * p_.half_length;
    const double across = m.volume * (r2 / 4.0 + h2 / 3.0);
    m.inertia = Vec3(across, across, m.volume * r2 / 2.0).asDiagonal();
    return m;
  }
  void pieces(PieceList& list) const {
    list.add(Quadric::round({1.0, 1.0, 0.0}, Vec3::Zero(), p_.radius * p_.radius));
    list.add(Quadric::plane(Vec3::UnitZ(), p_.half_length));
    list.add(Quadric::plane(-Vec3::UnitZ(), p_.half_length));
    list.end_piece();
  }
  template <typename Writer>
  void write_faces(Writer& writer) const {
    const double scale = 1.0 / p_.radius;
    writer.round({scale, scale, 0.0}, Vec3::Zero());
    writer.end(1.0, p_.radius, p_.half_length);
    writer.end(-1.0, p_.radius, p_.half_length);
  }

 private:
  Params p_;
};

static_assert(ConvexSolid<Cylinder>);

}  // namespace volcontact
