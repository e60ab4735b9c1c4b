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

  explicit Box(const Params& params) : p_(validated<Box>(params)) {}
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
  Vec3 gradient(const Vec3& p) const {
    const Vec3 excess = p.cwiseAbs() - p_.half_sizes;
    Eigen::Index i;
    if (excess.maxCoeff(&i) <= 0.0) return std::copysign(1.0, p[i]) * Vec3::Unit(i);
    Vec3 direction = excess.cwiseMax(0.0).normalized();
    for (int k = 0; k < 3; ++k) direction[k] = std::copysign(direction[k], p[k]);
    return direction;
  }
  RayInterval ray(const Vec3& o, const Vec3& d) const {
    RayInterval span{-kInfinity, kInfinity};
    for (int i = 0; i < 3; ++i) {
      if (d[i] == 0.0) {
        if (std::abs(o[i]) > p_.half_sizes[i]) return {};
        continue;
      }
      const double at_low = (-p_.half_sizes[i] - o[i]) / d[i];
      const double at_high = (p_.half_sizes[i] - o[i]) / d[i];
      span.enter = std::max(span.enter, std::min(at_low, at_high));
      span.leave = std::min(span.leave, std::max(at_low, at_high));
    }
    return span.empty() ? RayInterval{} : span;
  }
  VolumeMetrics own_metrics() const {
    const Vec3 squares = p_.half_sizes.cwiseAbs2();
    VolumeMetrics m;
    m.volume = 8.0 * p_.half_sizes.prod();
    const Vec3 second = m.volume / 3.0 * squares;
    m.inertia = (Vec3::Constant(second.sum()) - second).asDiagonal();
    return m;
  }
  void pieces(PieceList& list) const {
    for (int i = 0; i < 3; ++i) {
      list.add(Quadric::plane(Vec3::Unit(i), p_.half_sizes[i]));
      list.add(Quadric::plane(-Vec3::Unit(i), p_.half_sizes[i]));
    }
    list.end_piece();
  }
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
