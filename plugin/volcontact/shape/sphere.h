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

  explicit Sphere(const Params& params);
  const Params& params() const { return p_; }
  double radius() const { return p_.radius; }

  Aabb bounds() const { return {Vec3::Constant(-p_.radius), Vec3::Constant(p_.radius)}; }
  Vec3 support(const Vec3& e) const { return p_.radius * e.normalized(); }
  double support_height(const Vec3& e) const { return p_.radius * e.norm(); }
  double signed_distance(const Vec3& p) const { return p.norm() - p_.radius; }
  Vec3 gradient(const Vec3& p) const;
  RayInterval ray(const Vec3& o, const Vec3& d) const;
  double volume() const { return 4.0 / 3.0 * kPi * p_.radius * p_.radius * p_.radius; }
  VolumeMetrics own_metrics() const;
  void pieces(PieceList& list) const;
  template <typename Writer>
  void write_faces(Writer& writer) const {
    writer.round(Vec3::Constant(1.0 / p_.radius), Vec3::Zero());
  }

 private:
  Params p_;
};

static_assert(ConvexSolid<Sphere>);

}  // namespace volcontact
