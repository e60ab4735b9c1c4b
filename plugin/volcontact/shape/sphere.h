// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "volcontact/base/fields.h"
#include "volcontact/shape/pieces.h"
#include "volcontact/shape/solid.h"

namespace volcontact {

/// Ball about the origin.
class Sphere {
 public:
  static constexpr const char* kName = "sphere";
  struct Params {
    double radius = 1.0;
  };
  static constexpr std::array kFields{
      Field<Params>{"radius", "m", &Params::radius, kNonNegative, "radius"}};

  explicit Sphere(const Params& params) : p_(validated<Sphere>(params)) {}
  const Params& params() const { return p_; }
  double radius() const { return p_.radius; }

  Aabb bounds() const { return {Vec3::Constant(-p_.radius), Vec3::Constant(p_.radius)}; }
  Vec3 support(const Vec3& e) const { return p_.radius * e.normalized(); }
  double support_height(const Vec3& e) const { return p_.radius * e.norm(); }
  double signed_distance(const Vec3& p) const { return p.norm() - p_.radius; }
  Vec3 gradient(const Vec3& p) const {
    const double length = p.norm();
    return length > 0.0 ? Vec3(p / length) : Vec3::UnitZ();
  }
  RayInterval ray(const Vec3& o, const Vec3& d) const {
    // The point of the line nearest the centre first: no cancellation for far origins.
    const double t_mid = -o.dot(d) / d.squaredNorm();
    const double reach = p_.radius * p_.radius - (o + t_mid * d).squaredNorm();
    if (!(reach > 0.0)) return {};
    const double half = std::sqrt(reach / d.squaredNorm());
    return {t_mid - half, t_mid + half};
  }
  VolumeMetrics own_metrics() const {
    const double r = p_.radius;
    VolumeMetrics m;
    m.volume = 4.0 / 3.0 * kPi * r * r * r;
    m.inertia = (0.4 * m.volume * r * r) * Mat3::Identity();
    return m;
  }
  void pieces(PieceList& list) const {
    list.add(Quadric::round(Vec3::Ones(), Vec3::Zero(), p_.radius * p_.radius));
    list.end_piece();
  }
  template <typename Writer>
  void write_faces(Writer& writer) const {
    writer.round(Vec3::Constant(1.0 / p_.radius), Vec3::Zero());
  }

 private:
  Params p_;
};

static_assert(ConvexSolid<Sphere>);

}  // namespace volcontact
