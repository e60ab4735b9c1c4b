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

  explicit Frustum(const Params& params)
      : p_(validated<Frustum>(params)),
        mean_radius_(0.5 * (p_.bottom_radius + p_.top_radius)),
        slope_(p_.half_length > 0.0 ? (p_.top_radius - p_.bottom_radius) / (2.0 * p_.half_length)
                                    : 0.0),
        wall_x_(1.0 / std::sqrt(1.0 + slope_ * slope_)),
        wall_z_(-slope_ * wall_x_) {}
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
    return inside <= 0.0 ? inside : (Vec2(rho, p.z()) - nearest(rho, p.z())).norm();
  }
  Vec3 gradient(const Vec3& p) const {
    const double rho = std::hypot(p.x(), p.y());
    const Vec3 outward = rho > 0.0 ? Vec3(p.x() / rho, p.y() / rho, 0.0) : Vec3(Vec3::UnitX());
    const double side = wall(rho, p.z()), end = std::abs(p.z()) - p_.half_length;
    Vec2 direction(wall_x_, wall_z_);
    if (std::max(side, end) > 0.0) {
      direction = (Vec2(rho, p.z()) - nearest(rho, p.z())).normalized();
    } else if (end > side) {
      direction = {0.0, std::copysign(1.0, p.z())};
    }
    return direction.x() * outward + direction.y() * Vec3::UnitZ();
  }
  RayInterval ray(const Vec3& o, const Vec3& d) const {
    RayInterval span = between_ends(o, d);
    if (span.empty()) return {};
    // x^2 + y^2 <= (mean_radius + slope z)^2 along the line: a t^2 + 2 b t + c <= 0, with t counted
    // from the point nearest the axis (or the middle of the slab) against cancellation.
    const double across = d.x() * d.x() + d.y() * d.y();
    double shift = 0.5 * (span.enter + span.leave);
    if (across > 0.0) {
      shift = std::clamp(-(o.x() * d.x() + o.y() * d.y()) / across, span.enter, span.leave);
    }
    const Vec3 q = o + shift * d;
    const double radius = mean_radius_ + slope_ * q.z(), growth = slope_ * d.z();
    const double a = across - growth * growth;
    const double b = q.x() * d.x() + q.y() * d.y() - radius * growth;
    const double c = q.x() * q.x() + q.y() * q.y() - radius * radius;
    const RayInterval wall_span = quadratic_at_most_zero(a, b, c, growth);
    span.enter = std::max(span.enter, wall_span.enter + shift);
    span.leave = std::min(span.leave, wall_span.leave + shift);
    return span.empty() ? RayInterval{} : span;
  }
  VolumeMetrics own_metrics() const {
    const double r0 = p_.bottom_radius, r1 = p_.top_radius, h = p_.half_length;
    const double h3 = h * h * h;
    VolumeMetrics m;
    m.volume = 2.0 * kPi * h / 3.0 * (r0 * r0 + r0 * r1 + r1 * r1);
    if (!(m.volume > 0.0)) return m;
    // With r(z) = mean_radius + slope z: int pi r^2 z dz, int pi r^2 z^2 dz and int pi r^4 dz.
    const double first = kPi * 4.0 / 3.0 * mean_radius_ * slope_ * h3;
    const double second = kPi * (2.0 / 3.0 * mean_radius_ * mean_radius_ * h3 +
                                 2.0 / 5.0 * slope_ * slope_ * h3 * h * h);
    const double fourth = kPi * 2.0 * h / 5.0 *
                          (r0 * r0 * r0 * r0 + r0 * r0 * r0 * r1 + r0 * r0 * r1 * r1 +
                           r0 * r1 * r1 * r1 + r1 * r1 * r1 * r1);
    m.centroid.z() = first / m.volume;
    const double across = fourth / 4.0 + second - first * m.centroid.z();
    m.inertia = Vec3(across, across, fourth / 2.0).asDiagonal();
    return m;
  }
  void pieces(PieceList& list) const {
    list.add(slope_ == 0.0
                 ? Quadric::round({1.0, 1.0, 0.0}, Vec3::Zero(), mean_radius_ * mean_radius_)
                 : Quadric::cone(mean_radius_, slope_));
    list.add(Quadric::plane(Vec3::UnitZ(), p_.half_length));
    list.add(Quadric::plane(-Vec3::UnitZ(), p_.half_length));
    list.end_piece();
  }
  template <typename Writer>
  void write_faces(Writer& writer) const {
    constexpr double kStraight = 1e-12;  // radii that differ less are one, relatively
    const double mean = 0.5 * (p_.bottom_radius + p_.top_radius);
    const double slope = (p_.top_radius - p_.bottom_radius) / (2.0 * p_.half_length);
    if (std::abs(slope) * p_.half_length < kStraight * mean) {
      writer.round({1.0 / mean, 1.0 / mean, 0.0}, Vec3::Zero());
    } else {
      writer.cone(slope, -mean / slope);
    }
    writer.end(1.0, p_.top_radius, p_.half_length);
    writer.end(-1.0, p_.bottom_radius, p_.half_length);
  }

 private:
  using Vec2 = Eigen::Vector2d;

  double at_top(double across, double z) const {
    return p_.top_radius * across + p_.half_length * z;
  }
  double at_bottom(double across, double z) const {
    return p_.bottom_radius * across - p_.half_length * z;
  }
  // Distance from the slanted wall's line in the (rho, z) half-plane, negative inside.
  double wall(double rho, double z) const { return (rho - mean_radius_) * wall_x_ + z * wall_z_; }

  // The point of the profile nearest to an outside point of the (rho, z) half-plane.
  Vec2 nearest(double rho, double z) const {
    const Vec2 bottom(p_.bottom_radius, -p_.half_length), top(p_.top_radius, p_.half_length);
    const Vec2 edge = top - bottom, point(rho, z);
    const double length2 = edge.squaredNorm();
    const double s = length2 > 0.0 ? (point - bottom).dot(edge) / length2 : 0.0;
    if (wall(rho, z) > 0.0 && s > 0.0 && s < 1.0) return bottom + s * edge;
    const bool above = z > p_.half_length || (std::abs(z) <= p_.half_length && s >= 1.0);
    const Vec2 corner = above ? top : bottom;
    return {std::min(rho, corner.x()), corner.y()};
  }

  RayInterval between_ends(const Vec3& o, const Vec3& d) const {
    if (d.z() == 0.0) {
      if (std::abs(o.z()) > p_.half_length) return {};
      return {-kInfinity, kInfinity};
    }
    const double at_low = (-p_.half_length - o.z()) / d.z();
    const double at_high = (p_.half_length - o.z()) / d.z();
    return {std::min(at_low, at_high), std::max(at_low, at_high)};
  }

  // {t : a t^2 + 2 b t + c <= 0} on the nappe of the solid. When the line is steeper than the wall
  // (a < 0) it stays inside for ever towards the wide end, where `growth` t grows.
  static RayInterval quadratic_at_most_zero(double a, double b, double c, double growth) {
    const double discriminant = b * b - a * c;
    if (discriminant < 0.0) return a < 0.0 ? RayInterval{-kInfinity, kInfinity} : RayInterval{};
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    if (q == 0.0) {  // b = 0 and a c = 0
      return c <= 0.0 && a <= 0.0 ? RayInterval{-kInfinity, kInfinity} : RayInterval{};
    }
    const double one = c / q;
    if (a == 0.0) return b > 0.0 ? RayInterval{-kInfinity, one} : RayInterval{one, kInfinity};
    const double two = q / a;
    const double low = std::min(one, two), high = std::max(one, two);
    if (a > 0.0) return {low, high};
    return growth > 0.0 ? RayInterval{high, kInfinity} : RayInterval{-kInfinity, low};
  }

  Params p_;
  double mean_radius_, slope_;
  double wall_x_, wall_z_;  // outward normal of the wall in the (rho, z) half-plane
};

static_assert(ConvexSolid<Frustum>);

}  // namespace volcontact
