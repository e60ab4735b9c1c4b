// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "volcontact/base/fields.h"
#include "volcontact/shape/solid.h"

namespace volcontact {

/// Ellipsoid about the origin: the image of the unit ball under diag(semi_axes). A zero semi-axis
/// makes a flat, empty solid.
class Ellipsoid {
 public:
  static constexpr const char* kName = "ellipsoid";
  struct Params {
    Vec3 semi_axes = Vec3::Ones();
  };
  static constexpr std::array kFields{
      Field<Params>{"semi_axes", "m", &Params::semi_axes, kNonNegative, "half the axis lengths"}};

  explicit Ellipsoid(const Params& params);
  const Params& params() const { return p_; }
  const Vec3& semi_axes() const { return p_.semi_axes; }

  Aabb bounds() const { return {-p_.semi_axes, p_.semi_axes}; }
  Vec3 support(const Vec3& e) const {
    const Vec3 scaled = p_.semi_axes.cwiseProduct(e);
    const double length = scaled.norm();
    return length > 0.0 ? Vec3(p_.semi_axes.cwiseProduct(scaled) / length) : Vec3::Zero();
  }
  double support_height(const Vec3& e) const { return p_.semi_axes.cwiseProduct(e).norm(); }

  /// A bound, exact to first order at the surface. With f = |p/a| - 1, outside: f is convex, so
  /// f / |grad f| cannot exceed the distance. Inside: the quadric |p/a|^2 - 1 has second
  /// derivatives of at most 2 / min(a)^2, so it cannot reach zero nearer than the root of that
  /// parabola.
  double signed_distance(const Vec3& p) const {
    const Vec3 scaled = p.cwiseProduct(inverse_);
    const double f = scaled.norm();
    const double slope = scaled.cwiseProduct(inverse_).norm();
    const double outside = f > 1.0 ? f * (f - 1.0) / slope : 0.0;
    if (is_flat()) return std::hypot(outside, off_flat(p));
    if (f > 1.0) return outside;
    const double deficit = (1.0 - f) * (1.0 + f);
    return -deficit / (slope + std::sqrt(slope * slope + deficit / (smallest_ * smallest_)));
  }
  Vec3 gradient(const Vec3& p) const;
  RayInterval ray(const Vec3& o, const Vec3& d) const;
  double volume() const { return 4.0 / 3.0 * kPi * p_.semi_axes.prod(); }
  VolumeMetrics own_metrics() const;
  template <typename Writer>
  void write_faces(Writer& writer) const {
    writer.round(p_.semi_axes.cwiseInverse(), Vec3::Zero());
  }

 private:
  // Below this length the inverse square overflows: such an axis counts as zero.
  static constexpr double kFlat = 1e-100;

  bool is_flat(int i) const { return p_.semi_axes[i] < kFlat; }
  bool is_flat() const { return smallest_ < kFlat; }
  // Distance from the linear space a flat ellipsoid lies in.
  double off_flat(const Vec3& p) const {
    Vec3 off = Vec3::Zero();
    for (int i = 0; i < 3; ++i) {
      if (is_flat(i)) off[i] = p[i];
    }
    return off.norm();
  }

  Params p_;
  Vec3 inverse_;
  double smallest_;
};

static_assert(ConvexSolid<Ellipsoid>);

}  // namespace volcontact
