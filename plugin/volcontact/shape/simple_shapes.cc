// SPDX-License-Identifier: Apache-2.0
// What of the simple solids no engine has in its inner loops. Out of their headers, which every
// source includes: there it would be compiled again for each.
#include "volcontact/shape/simple_shapes.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>

#include "volcontact/base/check.h"

namespace volcontact {
namespace {

// Of a line with a cylinder about z.
RayInterval in_cylinder(double radius, double half_length, const Vec3& o, const Vec3& d) {
  RayInterval span{-kInfinity, kInfinity};
  const double slope = d.x() * d.x() + d.y() * d.y();
  // The point of the line nearest the axis first: no cancellation for far origins.
  const double t_mid = slope > 0.0 ? -(o.x() * d.x() + o.y() * d.y()) / slope : 0.0;
  const double x = o.x() + t_mid * d.x(), y = o.y() + t_mid * d.y();
  const double reach = radius * radius - (x * x + y * y);
  if (!(reach > 0.0)) return {};
  if (slope > 0.0) {
    const double half = std::sqrt(reach / slope);
    span = {t_mid - half, t_mid + half};
  }
  if (d.z() != 0.0) {
    const double at_low = (-half_length - o.z()) / d.z();
    const double at_high = (half_length - o.z()) / d.z();
    span.enter = std::max(span.enter, std::min(at_low, at_high));
    span.leave = std::min(span.leave, std::max(at_low, at_high));
  } else if (std::abs(o.z()) > half_length) {
    return {};
  }
  return span.empty() ? RayInterval{} : span;
}

}  // namespace

Sphere::Sphere(const Params& params) : p_(validated<Sphere>(params)) {}
Vec3 Sphere::gradient(const Vec3& p) const {
  const double length = p.norm();
  return length > 0.0 ? Vec3(p / length) : Vec3::UnitZ();
}

RayInterval Sphere::ray(const Vec3& o, const Vec3& d) const {
  // The point of the line nearest the centre first: no cancellation for far origins.
  const double t_mid = -o.dot(d) / d.squaredNorm();
  const double reach = p_.radius * p_.radius - (o + t_mid * d).squaredNorm();
  if (!(reach > 0.0)) return {};
  const double half = std::sqrt(reach / d.squaredNorm());
  return {t_mid - half, t_mid + half};
}

VolumeMetrics Sphere::own_metrics() const {
  const double r = p_.radius;
  VolumeMetrics m;
  m.volume = volume();
  m.inertia = (0.4 * m.volume * r * r) * Mat3::Identity();
  return m;
}

void Sphere::pieces(PieceList& list) const {
  list.add(Quadric::round(Vec3::Ones(), Vec3::Zero(), p_.radius * p_.radius));
  list.end_piece();
}

Ellipsoid::Ellipsoid(const Params& params) : p_(validated<Ellipsoid>(params)) {
  for (int i = 0; i < 3; ++i) inverse_[i] = is_flat(i) ? 0.0 : 1.0 / p_.semi_axes[i];
  smallest_ = p_.semi_axes.minCoeff();
}

Vec3 Ellipsoid::gradient(const Vec3& p) const {
  const Vec3 normal = p.cwiseProduct(inverse_).cwiseProduct(inverse_);
  const double length = normal.norm();
  if (length > 0.0 && !is_flat()) return normal / length;
  const int thinnest = p_.semi_axes.least();
  return std::copysign(1.0, p[thinnest]) * Vec3::Unit(thinnest);
}

RayInterval Ellipsoid::ray(const Vec3& o, const Vec3& d) const {
  if (is_flat()) return {};
  // In the space of the unit ball, from the point of the line nearest the centre.
  const Vec3 o_unit = o.cwiseProduct(inverse_), d_unit = d.cwiseProduct(inverse_);
  const double t_mid = -o_unit.dot(d_unit) / d_unit.squaredNorm();
  const double reach = 1.0 - (o_unit + t_mid * d_unit).squaredNorm();
  if (!(reach > 0.0)) return {};
  const double half = std::sqrt(reach / d_unit.squaredNorm());
  return {t_mid - half, t_mid + half};
}

VolumeMetrics Ellipsoid::own_metrics() const {
  const Vec3 squares = p_.semi_axes.cwiseAbs2();
  VolumeMetrics m;
  m.volume = volume();
  m.inertia = (0.2 * m.volume * (Vec3::Constant(squares.sum()) - squares)).asDiagonal();
  return m;
}

Capsule::Capsule(const Params& params) : p_(validated<Capsule>(params)) {}
Vec3 Capsule::gradient(const Vec3& p) const {
  const Vec3 offset = from_axis(p);
  const double length = offset.norm();
  return length > 0.0 ? Vec3(offset / length) : Vec3::UnitX();
}

RayInterval Capsule::ray(const Vec3& o, const Vec3& d) const {
  // The solid is convex: the interval is the hull of those of its three parts.
  RayInterval hull;
  const auto join = [&hull](const RayInterval& part) {
    if (part.empty()) return;
    hull = hull.empty()
               ? part
               : RayInterval{std::min(hull.enter, part.enter), std::max(hull.leave, part.leave)};
  };
  join(middle(o, d));
  join(end_ball(o, d, p_.half_length));
  join(end_ball(o, d, -p_.half_length));
  return hull;
}

VolumeMetrics Capsule::own_metrics() const {
  const double r = p_.radius, h = p_.half_length;
  const double r2 = r * r;
  VolumeMetrics m;
  m.volume = volume();
  // int x^2 and int z^2: cylinder, ball, and what moving the half balls apart by h adds.
  const double xx = kPi * r2 * r2 * (h / 2.0 + 4.0 / 15.0 * r);
  const double zz =
      kPi * r2 * (2.0 / 3.0 * h * h * h + 4.0 / 15.0 * r * r2 + r2 * h + 4.0 / 3.0 * r * h * h);
  m.inertia = Vec3(xx + zz, xx + zz, 2.0 * xx).asDiagonal();
  return m;
}

void Capsule::pieces(PieceList& list) const {
  const double r2 = p_.radius * p_.radius, h = p_.half_length;
  list.add(Quadric::round({1.0, 1.0, 0.0}, Vec3::Zero(), r2));
  list.add(Quadric::seam_plane(Vec3::UnitZ(), h));
  list.add(Quadric::seam_plane(-Vec3::UnitZ(), h));
  list.end_piece();
  for (const double side : {1.0, -1.0}) {
    list.add(Quadric::round(Vec3::Ones(), Vec3(0.0, 0.0, side * h), r2));
    list.add(Quadric::seam_plane(Vec3(0.0, 0.0, -side), -h));
    list.end_piece();
  }
}

RayInterval Capsule::middle(const Vec3& o, const Vec3& d) const {
  return in_cylinder(p_.radius, p_.half_length, o, d);
}

RayInterval Capsule::end_ball(const Vec3& o, const Vec3& d, double z) const {
  const Vec3 from(o.x(), o.y(), o.z() - z);
  const double t_mid = -from.dot(d) / d.squaredNorm();
  const double reach = p_.radius * p_.radius - (from + t_mid * d).squaredNorm();
  if (!(reach > 0.0)) return {};
  const double half = std::sqrt(reach / d.squaredNorm());
  return {t_mid - half, t_mid + half};
}

Cylinder::Cylinder(const Params& params) : p_(validated<Cylinder>(params)) {}
Vec3 Cylinder::gradient(const Vec3& p) const {
  const double across = std::hypot(p.x(), p.y());
  const double side = across - p_.radius;
  const double end = std::abs(p.z()) - p_.half_length;
  const Vec3 outward =
      across > 0.0 ? Vec3(p.x() / across, p.y() / across, 0.0) : Vec3(Vec3::UnitX());
  const Vec3 along(0.0, 0.0, std::copysign(1.0, p.z()));
  if (side <= 0.0 || end <= 0.0) return side >= end ? outward : along;
  return (side * outward + end * along).normalized();
}

RayInterval Cylinder::ray(const Vec3& o, const Vec3& d) const {
  return in_cylinder(p_.radius, p_.half_length, o, d);
}

VolumeMetrics Cylinder::own_metrics() const {
  const double r2 = p_.radius * p_.radius, h2 = p_.half_length * p_.half_length;
  VolumeMetrics m;
  m.volume = volume();
  const double across = m.volume * (r2 / 4.0 + h2 / 3.0);
  m.inertia = Vec3(across, across, m.volume * r2 / 2.0).asDiagonal();
  return m;
}

void Cylinder::pieces(PieceList& list) const {
  list.add(Quadric::round({1.0, 1.0, 0.0}, Vec3::Zero(), p_.radius * p_.radius));
  list.add(Quadric::plane(Vec3::UnitZ(), p_.half_length));
  list.add(Quadric::plane(-Vec3::UnitZ(), p_.half_length));
  list.end_piece();
}

Frustum::Frustum(const Params& params)
    : p_(validated<Frustum>(params)),
      mean_radius_(0.5 * (p_.bottom_radius + p_.top_radius)),
      slope_(p_.half_length > 0.0 ? (p_.top_radius - p_.bottom_radius) / (2.0 * p_.half_length)
                                  : 0.0),
      wall_x_(1.0 / std::sqrt(1.0 + slope_ * slope_)),
      wall_z_(-slope_ * wall_x_) {}
Vec3 Frustum::gradient(const Vec3& p) const {
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

RayInterval Frustum::ray(const Vec3& o, const Vec3& d) const {
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

VolumeMetrics Frustum::own_metrics() const {
  const double r0 = p_.bottom_radius, r1 = p_.top_radius, h = p_.half_length;
  const double h3 = h * h * h;
  VolumeMetrics m;
  m.volume = volume();
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

void Frustum::pieces(PieceList& list) const {
  list.add(slope_ == 0.0
               ? Quadric::round({1.0, 1.0, 0.0}, Vec3::Zero(), mean_radius_ * mean_radius_)
               : Quadric::cone(mean_radius_, slope_));
  list.add(Quadric::plane(Vec3::UnitZ(), p_.half_length));
  list.add(Quadric::plane(-Vec3::UnitZ(), p_.half_length));
  list.end_piece();
}

double Frustum::from_profile(double rho, double z) const {
  return (Vec2(rho, z) - nearest(rho, z)).norm();
}

Vec2 Frustum::nearest(double rho, double z) const {
  const Vec2 bottom(p_.bottom_radius, -p_.half_length), top(p_.top_radius, p_.half_length);
  const Vec2 edge = top - bottom, point(rho, z);
  const double length2 = edge.squaredNorm();
  const double s = length2 > 0.0 ? (point - bottom).dot(edge) / length2 : 0.0;
  if (wall(rho, z) > 0.0 && s > 0.0 && s < 1.0) return bottom + s * edge;
  const bool above = z > p_.half_length || (std::abs(z) <= p_.half_length && s >= 1.0);
  const Vec2 corner = above ? top : bottom;
  return {std::min(rho, corner.x()), corner.y()};
}

RayInterval Frustum::between_ends(const Vec3& o, const Vec3& d) const {
  if (d.z() == 0.0) {
    if (std::abs(o.z()) > p_.half_length) return {};
    return {-kInfinity, kInfinity};
  }
  const double at_low = (-p_.half_length - o.z()) / d.z();
  const double at_high = (p_.half_length - o.z()) / d.z();
  return {std::min(at_low, at_high), std::max(at_low, at_high)};
}

RayInterval Frustum::quadratic_at_most_zero(double a, double b, double c, double growth) {
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

Box::Box(const Params& params) : p_(validated<Box>(params)) {}
Vec3 Box::gradient(const Vec3& p) const {
  const Vec3 excess = p.cwiseAbs() - p_.half_sizes;
  const int i = excess.largest();
  if (excess[i] <= 0.0) return std::copysign(1.0, p[i]) * Vec3::Unit(i);
  Vec3 direction = excess.cwiseMax(0.0).normalized();
  for (int k = 0; k < 3; ++k) direction[k] = std::copysign(direction[k], p[k]);
  return direction;
}

RayInterval Box::ray(const Vec3& o, const Vec3& d) const {
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

VolumeMetrics Box::own_metrics() const {
  const Vec3 squares = p_.half_sizes.cwiseAbs2();
  VolumeMetrics m;
  m.volume = volume();
  const Vec3 second = m.volume / 3.0 * squares;
  m.inertia = (Vec3::Constant(second.sum()) - second).asDiagonal();
  return m;
}

void Box::pieces(PieceList& list) const {
  for (int i = 0; i < 3; ++i) {
    list.add(Quadric::plane(Vec3::Unit(i), p_.half_sizes[i]));
    list.add(Quadric::plane(-Vec3::Unit(i), p_.half_sizes[i]));
  }
  list.end_piece();
}

RoundedBox::RoundedBox(const Params& params)
    : p_(validated<RoundedBox>(params)), inner_(p_.half_sizes - Vec3::Constant(p_.radius)) {
  static constexpr Range kHalfAtMost{0.0, kInfinity, true, true,
                                     "no more than the smallest of half_sizes"};
  require(inner_.minCoeff() >= 0.0,
          out_of_range_message(kName, "radius", "m", p_.radius, kHalfAtMost));
}

Vec3 RoundedBox::gradient(const Vec3& p) const {
  const Vec3 excess = p.cwiseAbs() - inner_;
  const int i = excess.largest();
  if (excess[i] <= 0.0) return std::copysign(1.0, p[i]) * Vec3::Unit(i);
  const Vec3 outside = excess.cwiseMax(0.0);
  Vec3 direction = outside.normalized();
  for (int k = 0; k < 3; ++k) direction[k] = std::copysign(direction[k], p[k]);
  return direction;
}

RayInterval RoundedBox::ray(const Vec3& o, const Vec3& d) const {
  // The solid is convex: the interval is the hull of those of its parts.
  RayInterval hull;
  const auto join = [&hull](const RayInterval& part) {
    if (part.empty()) return;
    hull = hull.empty()
               ? part
               : RayInterval{std::min(hull.enter, part.enter), std::max(hull.leave, part.leave)};
  };
  if (within(p_.half_sizes, o, d).empty()) return {};
  for (int i = 0; i < 3; ++i) {
    Vec3 half = inner_;
    half[i] = p_.half_sizes[i];
    join(within(half, o, d));
  }
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner = inner_.cwiseProduct(corner_signs(i));
    join(round(Vec3::Ones(), corner, o, d));
    for (int axis = 0; axis < 3; ++axis) {
      if (corner[axis] >= 0.0) join(edge(axis, corner, o, d));
    }
  }
  return hull;
}

VolumeMetrics RoundedBox::own_metrics() const {
  const double r = p_.radius, r2 = r * r, disc = kPi * r2, ball = 4.0 / 3.0 * kPi * r * r2;
  const double a[3] = {inner_.x(), inner_.y(), inner_.z()};
  VolumeMetrics m;
  m.volume = volume();
  // int x_i^2 over the box, its six slabs, twelve quarters of tubes and eight octants of a ball,
  // whose inner edges lie at a_i.
  Vec3 second;
  for (int i = 0; i < 3; ++i) {
    const double x = a[i], y = a[(i + 1) % 3], z = a[(i + 2) % 3], square = x * x / 3.0;
    const double out = x + r;
    second[i] = 8.0 * x * y * z * square + 8.0 / 3.0 * y * z * (out * out * out - x * x * x) +
                8.0 * r * x * (y + z) * square + 2.0 * disc * x * square +
                2.0 * (y + z) * (x * x * disc + 8.0 / 3.0 * x * r * r2 + 0.25 * kPi * r2 * r2) +
                x * x * ball + kPi * x * r2 * r2 + 4.0 / 15.0 * kPi * r * r2 * r2;
  }
  m.inertia = (Vec3::Constant(second.sum()) - second).asDiagonal();
  return m;
}

void RoundedBox::pieces(PieceList& list) const {
  PieceWriter writer(list);
  write_parts(writer);
}

RayInterval RoundedBox::within(const Vec3& half, const Vec3& o, const Vec3& d) {
  RayInterval span{-kInfinity, kInfinity};
  for (int i = 0; i < 3; ++i) {
    if (d[i] == 0.0) {
      if (std::abs(o[i]) > half[i]) return {};
      continue;
    }
    const double at_low = (-half[i] - o[i]) / d[i], at_high = (half[i] - o[i]) / d[i];
    span.enter = std::max(span.enter, std::min(at_low, at_high));
    span.leave = std::min(span.leave, std::max(at_low, at_high));
  }
  return span.empty() ? RayInterval{} : span;
}

RayInterval RoundedBox::round(const Vec3& mask, const Vec3& center, const Vec3& o,
                              const Vec3& d) const {
  const Vec3 from = (o - center).cwiseProduct(mask), way = d.cwiseProduct(mask);
  const double slope = way.squaredNorm();
  const double t_mid = slope > 0.0 ? -from.dot(way) / slope : 0.0;
  const double reach = p_.radius * p_.radius - (from + t_mid * way).squaredNorm();
  if (!(reach > 0.0)) return {};
  if (slope == 0.0) return {-kInfinity, kInfinity};
  const double half = std::sqrt(reach / slope);
  return {t_mid - half, t_mid + half};
}

RayInterval RoundedBox::edge(int axis, const Vec3& center, const Vec3& o, const Vec3& d) const {
  RayInterval span = round(Vec3::Ones() - Vec3::Unit(axis), center, o, d);
  if (span.empty()) return {};
  if (d[axis] == 0.0) return std::abs(o[axis]) > inner_[axis] ? RayInterval{} : span;
  const double at_low = (-inner_[axis] - o[axis]) / d[axis];
  const double at_high = (inner_[axis] - o[axis]) / d[axis];
  return {std::max(span.enter, std::min(at_low, at_high)),
          std::min(span.leave, std::max(at_low, at_high))};
}

Torus::Torus(const Params& params) : p_(validated<Torus>(params)) {
  require(p_.minor_radius <= p_.major_radius,
          "torus: minor_radius = " + std::to_string(p_.minor_radius) +
              " [m] is out of range: must be <= major_radius = " + std::to_string(p_.major_radius));
}

Vec3 Torus::gradient(const Vec3& p) const {
  const Vec3 offset = from_circle(p);
  const double length = offset.norm();
  return length > 0.0 ? Vec3(offset / length) : Vec3::UnitZ();
}

double Torus::curvature_bound(const Vec3& p, double reach) const {
  const double rho = std::hypot(p.x(), p.y());
  const double nearest = std::hypot(rho - p_.major_radius, p.z()) - reach;
  const double least_rho = rho - reach;
  if (!(nearest > 0.0 && least_rho > 0.0)) return kInfinity;
  const double most_cos = std::min(1.0, (std::abs(rho - p_.major_radius) + reach) / nearest);
  return std::max(1.0 / nearest, most_cos / least_rho);
}

VolumeMetrics Torus::own_metrics() const {
  const double R2 = p_.major_radius * p_.major_radius, r2 = p_.minor_radius * p_.minor_radius;
  VolumeMetrics m;
  m.volume = volume();
  const double across = m.volume * (R2 / 2.0 + r2 * 5.0 / 8.0);
  m.inertia = Vec3(across, across, m.volume * (R2 + r2 * 3.0 / 4.0)).asDiagonal();
  return m;
}

Vec3 HalfSpace::gradient(const Vec3&) const { return Vec3::UnitZ(); }
RayInterval HalfSpace::ray(const Vec3& o, const Vec3& d) const {
  if (d.z() == 0.0) {
    return o.z() <= 0.0 ? RayInterval{-kInfinity, kInfinity} : RayInterval{};
  }
  const double t = -o.z() / d.z();
  return d.z() > 0.0 ? RayInterval{-kInfinity, t} : RayInterval{t, kInfinity};
}

VolumeMetrics HalfSpace::own_metrics() const {
  VolumeMetrics m;
  m.volume = volume();
  m.status = Status::kUnbounded;
  return m;
}

void HalfSpace::pieces(PieceList& list) const {
  list.add(Quadric::plane(Vec3::UnitZ(), 0.0));
  list.end_piece();
}

void add_pieces(const Ellipsoid& solid, PieceList& list) {
  list.add(Quadric::round(solid.semi_axes().cwiseAbs2().cwiseInverse(), Vec3::Zero(), 1.0));
  list.end_piece();
}

void add_pieces(const ConvexPolytope& solid, PieceList& list) {
  for (const ConvexPolytope::Face& face : solid.faces()) {
    list.add(Quadric::plane(face.normal, face.offset));
  }
  list.end_piece();
}

bool has_pieces(const SimpleShape& shape) {
  return std::visit([](const auto& solid) { return HasPieces<std::decay_t<decltype(solid)>>; },
                    shape);
}

bool is_made_of_faces(const SimpleShape& shape) {
  return std::visit([](const auto& solid) { return HasFaces<std::decay_t<decltype(solid)>>; },
                    shape);
}

}  // namespace volcontact
