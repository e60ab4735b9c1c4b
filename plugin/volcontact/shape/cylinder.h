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

  explicit Cylinder(const Params& params);
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
  Vec3 gradient(const Vec3& p) const;
  RayInterval ray(const Vec3& o, const Vec3& d) const;
  double volume() const { return 2.0 * kPi * (p_.radius * p_.radius) * p_.half_length; }
  VolumeMetrics own_metrics() const;
  void pieces(PieceList& list) const;
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
