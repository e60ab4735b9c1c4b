// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "volcontact/base/fields.h"
#include "volcontact/shape/solid.h"

namespace volcontact {

/// Ring about the z axis: all points within `minor_radius` of the circle of `major_radius` in the
/// plane z = 0. The tube must not reach over the axis: minor_radius <= major_radius.
class Torus {
 public:
  static constexpr const char* kName = "torus";
  struct Params {
    double major_radius = 1.0;
    double minor_radius = 0.25;
  };
  static constexpr std::array kFields{
      Field<Params>{"major_radius", "m", &Params::major_radius, kNonNegative,
                    "from the axis to the middle of the tube"},
      Field<Params>{"minor_radius", "m", &Params::minor_radius, kNonNegative,
                    "of the tube, at most major_radius"}};

  explicit Torus(const Params& params);
  const Params& params() const { return p_; }
  double major_radius() const { return p_.major_radius; }
  double minor_radius() const { return p_.minor_radius; }

  Aabb bounds() const {
    const double reach = p_.major_radius + p_.minor_radius;
    const Vec3 half(reach, reach, p_.minor_radius);
    return {-half, half};
  }
  Vec3 support(const Vec3& e) const {
    const double across = std::hypot(e.x(), e.y());
    const double scale = across > 0.0 ? p_.major_radius / across : 0.0;
    return Vec3(scale * e.x(), scale * e.y(), 0.0) + p_.minor_radius * e.normalized();
  }
  double support_height(const Vec3& e) const {
    return p_.major_radius * std::hypot(e.x(), e.y()) + p_.minor_radius * e.norm();
  }
  double signed_distance(const Vec3& p) const { return from_circle(p).norm() - p_.minor_radius; }
  Vec3 gradient(const Vec3& p) const;
  /// Bound of the second derivatives of signed_distance within `reach` of p [1/m]: 1/q around the
  /// tube, q the distance from the circle, and cos/rho around the axis.
  double curvature_bound(const Vec3& p, double reach) const;
  double volume() const {
    return 2.0 * kPi * kPi * p_.major_radius * (p_.minor_radius * p_.minor_radius);
  }
  VolumeMetrics own_metrics() const;
  template <typename Writer>
  void write_parts(Writer& writer) const {
    writer.ring(p_.major_radius, p_.minor_radius);
    writer.end_part();
  }

 private:
  // From the nearest point of the circle; on the axis, from the one towards x.
  Vec3 from_circle(const Vec3& p) const {
    const double rho = std::hypot(p.x(), p.y());
    if (!(rho > 0.0)) return {-p_.major_radius, 0.0, p.z()};
    const double scale = 1.0 - p_.major_radius / rho;
    return {scale * p.x(), scale * p.y(), p.z()};
  }

  Params p_;
};

static_assert(Solid<Torus>);

}  // namespace volcontact
