// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "volcontact/base/fields.h"
#include "volcontact/shape/pieces.h"
#include "volcontact/shape/solid.h"

namespace volcontact {

/// Box about the origin, faces normal to the axes.
class Box {
 public:
  static constexpr bool kPlanesOnly = true;
  static constexpr const char* kName = "box";
  struct Params {
    Vec3 half_sizes = Vec3::Ones();
  };
  static constexpr std::array kFields{
      Field<Params>{"half_sizes", "m", &Params::half_sizes, kNonNegative, "half the edge lengths"}};

  explicit Box(const Params& params);
  const Params& params() const { return p_; }
  const Vec3& half_sizes() const { return p_.half_sizes; }

  Aabb bounds() const { return {-p_.half_sizes, p_.half_sizes}; }
  Vec3 support(const Vec3& e) const {
    return {std::copysign(p_.half_sizes.x(), e.x()), std::copysign(p_.half_sizes.y(), e.y()),
            std::copysign(p_.half_sizes.z(), e.z())};
  }
  double support_height(const Vec3& e) const { return p_.half_sizes.dot(e.cwiseAbs()); }
  double signed_distance(const Vec3& p) const {
    const Vec3 excess = p.cwiseAbs() - p_.half_sizes;
    const double largest = excess.maxCoeff();
    return largest <= 0.0 ? largest : excess.cwiseMax(0.0).norm();
  }
  Vec3 gradient(const Vec3& p) const;
  RayInterval ray(const Vec3& o, const Vec3& d) const;
  double volume() const { return 8.0 * p_.half_sizes.prod(); }
  VolumeMetrics own_metrics() const;
  void pieces(PieceList& list) const;
  template <typename Writer>
  void write_faces(Writer& writer) const {
    for (int i = 0; i < 3; ++i) {
      writer.plane(Vec3::Unit(i), p_.half_sizes[i]);
      writer.plane(-Vec3::Unit(i), p_.half_sizes[i]);
    }
  }

 private:
  Params p_;
};

static_assert(ConvexSolid<Box>);

}  // namespace volcontact
