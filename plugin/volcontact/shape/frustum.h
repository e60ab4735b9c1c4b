// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "volcontact/base/fields.h"
#include "volcontact/shape/pieces.h"
#include "volcontact/shape/solid.h"

namespace volcontact {

/// Cone frustum about the z axis: radius `bottom_radius` at z = -half_length, `top_radius` at
/// z = +half_length. One radius may be zero (a cone); equal radii make a cylinder.
class Frustum {
 public:
  static constexpr const char* kName = "frustum";
  struct Params {
    double bottom_radius = 1.0;
    double top_radius = 0.5;
    double half_length = 1.0;
  };
  static constexpr std::array kFields{
      Field<Params>{"bottom_radius", "m", &Params::bottom_radius, kNonNegative,
                    "radius at z = -half_length"},
      Field<Params>{"top_radius", "m", &Params::top_radius, kNonNegative,
                    "radius at z = +half_length"},
      Field<Params>{"half_length", "m", &Params::half_length, kNonNegative,
                    "half the length between the flat ends"}};

  explicit Frustum(const Params& params);
  const Params& params() const { return p_; }

  Aabb bounds() const {
    const double r = std::max(p_.bottom_radius, p_.top_radius);
    const Vec3 half(r, r, p_.half_length);
    return {-half, half};
  }
  Vec3 support(const Vec3& e) const {
    const double across = std::hypot(e.x(), e.y());
    const bool top = at_top(across, e.z()) > at_bottom(across, e.z());
    const double scale = across > 0.0 ? (top ? p_.top_radius : p_.bottom_radius) / across : 0.0;
    return {scale * e.x(), scale * e.y(), top ? p_.half_length : -p_.half_length};
  }
  double support_height(const Vec3& e) const {
    const double across = std::hypot(e.x(), e.y());
    return std::max(at_top(across, e.z()), at_bottom(across, e.z()));
  }
  double signed_distance(const Vec3& p) const {
    const double rho = std::hypot(p.x(), p.y());
    const double inside = std::max(wall(rho, p.z()), std::abs(p.z()) - p_.half_length);
    return inside <= 0.0 ? inside : from_profile(rho, p.z());
  }
  Vec3 gradient(const Vec3& p) const;
  RayInterval ray(const Vec3& o, const Vec3& d) const;
  double volume() const {
    const double r0 = p_.bottom_radius, r1 = p_.top_radius;
    return 2.0 * kPi * p_.half_length / 3.0 * (r0 * r0 + r0 * r1 + r1 * r1);
  }
  VolumeMetrics own_metrics() const;
  void pieces(PieceList& list) const;
  template <typename Writer>
  void write_faces(Writer& writer) const {
    // An apex as far away as the digits of a double are long says less of the wall, by its
    // rounding, than a tube of the mean radius: nothing is nearer to a wall that leans by less.
    constexpr double kStraight = 1e-8;
    const double mean = 0.5 * (p_.bottom_radius + p_.top_radius);
    const double slope = (p_.top_radius - p_.bottom_radius) / (2.0 * p_.half_length);
    const double off = std::abs(slope) * p_.half_length;
    if (off < kStraight * mean) {
      writer.round({1.0 / mean, 1.0 / mean, 0.0}, Vec3::Zero(), off);
    } else {
      writer.cone(slope, -mean / slope);
    }
    writer.end(1.0, p_.top_radius, p_.half_length);
    writer.end(-1.0, p_.bottom_radius, p_.half_length);
  }

 private:
  double at_top(double across, double z) const {
    return p_.top_radius * across + p_.half_length * z;
  }
  double at_bottom(double across, double z) const {
    return p_.bottom_radius * across - p_.half_length * z;
  }
  // Distance from the slanted wall's line in the (rho, z) half-plane, negative inside.
  double wall(double rho, double z) const { return (rho - mean_radius_) * wall_x_ + z * wall_z_; }

  // Distance of an outside point of the (rho, z) half-plane from the profile.
  double from_profile(double rho, double z) const;
  // The point of the profile nearest to it.
  Vec2 nearest(double rho, double z) const;

  RayInterval between_ends(const Vec3& o, const Vec3& d) const;

  // {t : a t^2 + 2 b t + c <= 0} on the nappe of the solid. When the line is steeper than the wall
  // (a < 0) it stays inside for ever towards the wide end, where `growth` t grows.
  static RayInterval quadratic_at_most_zero(double a, double b, double c, double growth);

  Params p_;
  double mean_radius_, slope_;
  double wall_x_, wall_z_;  // outward normal of the wall in the (rho, z) half-plane
};

static_assert(ConvexSolid<Frustum>);

}  // namespace volcontact
