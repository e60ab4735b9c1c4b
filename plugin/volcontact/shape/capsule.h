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

  explicit Capsule(const Params& params);
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
  Vec3 gradient(const Vec3& p) const;
  RayInterval ray(const Vec3& o, const Vec3& d) const;
  double volume() const {
    return kPi * (p_.radius * p_.radius) * (2.0 * p_.half_length + 4.0 / 3.0 * p_.radius);
  }
  VolumeMetrics own_metrics() const;
  void pieces(PieceList& list) const;
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
  RayInterval middle(const Vec3& o, const Vec3& d) const;
  RayInterval end_ball(const Vec3& o, const Vec3& d, double z) const;

  Params p_;
};

static_assert(ConvexSolid<Capsule>);

}  // namespace volcontact
