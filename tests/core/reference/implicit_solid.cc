// SPDX-License-Identifier: Apache-2.0
#include "core/reference/implicit_solid.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "volcontact/base/fields.h"

namespace volcontact::test {
namespace {

using Kind = ImplicitMember::Kind;

constexpr LineParts::Part kNowhere{kInfinity, -kInfinity}, kEverywhere{-kInfinity, kInfinity};
constexpr int kUnion = -1, kIntersection = -2, kDifference = -3;

double horner(const double* c, int degree, double t) {
  double sum = c[degree];
  for (int i = degree - 1; i >= 0; --i) sum = sum * t + c[i];
  return sum;
}

// Root of a polynomial that rises or falls from left to right and changes its sign there: Newton's
// steps, or bisection where they lead out.
double root_between(const double* c, const double* slope, int degree, double left, double right) {
  const double close = 2e-16 * (right - left);
  const bool negative = horner(c, degree, left) < 0.0;
  double t = 0.5 * (left + right);
  for (int k = 0; k < 100; ++k) {
    const double value = horner(c, degree, t);
    ((value < 0.0) == negative ? left : right) = t;
    const double step = -value / horner(slope, degree - 1, t);
    if (std::abs(step) <= close || right - left <= close) return std::clamp(t, left, right);
    t = t + step > left && t + step < right ? t + step : 0.5 * (left + right);
  }
  return t;
}

// Real roots in [low, high] of a polynomial, in order: its turning points part it into stretches on
// which it rises or falls.
int polynomial_roots(const double* c, int degree, double low, double high, double* roots) {
  if (degree == 1) {
    if (c[1] == 0.0) return 0;
    roots[0] = -c[0] / c[1];
    return roots[0] >= low && roots[0] <= high ? 1 : 0;
  }
  double slope[4], turns[6];
  for (int i = 0; i < degree; ++i) slope[i] = c[i + 1] * (i + 1);
  turns[0] = low;
  const int inner = polynomial_roots(slope, degree - 1, low, high, turns + 1);
  turns[inner + 1] = high;
  int count = 0;
  bool negative = horner(c, degree, low) < 0.0;
  for (int i = 0; i <= inner; ++i) {
    const bool next = horner(c, degree, turns[i + 1]) < 0.0;
    if (next != negative) {
      roots[count++] = root_between(c, slope, degree, turns[i], turns[i + 1]);
    }
    negative = next;
  }
  return count;
}

double square(double x) { return x * x; }

double ellipsoid_level(const Vec3& p, const Vec3& semi_axes) {
  return std::sqrt(square(p.x() / semi_axes.x()) + square(p.y() / semi_axes.y()) +
                   square(p.z() / semi_axes.z()));
}

}  // namespace

double ImplicitMember::local_value(const Vec3& p) const {
  switch (kind) {
    case Kind::kHalfSpace:
      return p.z();
    case Kind::kEllipsoid:
      return size.minCoeff() * (ellipsoid_level(p, size) - 1.0);
    case Kind::kCapsule: {
      const double z = std::max(0.0, std::abs(p.z()) - size.y());
      return std::sqrt(square(p.x()) + square(p.y()) + z * z) - size.x();
    }
    case Kind::kFrustum: {
      const double rise = (size.y() - size.x()) / (2.0 * size.z());
      const double radius = size.x() + rise * (p.z() + size.z());
      const double wall =
          (std::sqrt(square(p.x()) + square(p.y())) - radius) / std::sqrt(1.0 + rise * rise);
      return std::max(wall, std::abs(p.z()) - size.z());
    }
    case Kind::kBox:
      return (p.cwiseAbs() - size).maxCoeff();
    case Kind::kTorus: {
      const double across = std::sqrt(square(p.x()) + square(p.y())) - size.x();
      return std::sqrt(across * across + square(p.z())) - size.y();
    }
    case Kind::kPolytope: {
      double most = -std::numeric_limits<double>::infinity();
      for (const Plane& plane : planes) most = std::max(most, plane.normal.dot(p) - plane.offset);
      return most;
    }
  }
  return 0.0;
}

Vec3 ImplicitMember::local_slope(const Vec3& p) const {
  switch (kind) {
    case Kind::kEllipsoid: {
      const double level = ellipsoid_level(p, size);
      if (level == 0.0) return Vec3::Zero();
      return size.minCoeff() / level * p.cwiseQuotient(size.cwiseAbs2());
    }
    case Kind::kCapsule: {
      Vec3 offset = p;
      offset.z() = std::copysign(std::max(0.0, std::abs(p.z()) - size.y()), p.z());
      const double length = offset.norm();
      return length > 0.0 ? Vec3(offset / length) : Vec3::Zero();
    }
    case Kind::kFrustum: {
      const double rise = (size.y() - size.x()) / (2.0 * size.z());
      const double rho = std::sqrt(square(p.x()) + square(p.y()));
      const double radius = size.x() + rise * (p.z() + size.z());
      const double steep = std::sqrt(1.0 + rise * rise);
      if (std::abs(p.z()) - size.z() >= (rho - radius) / steep) {
        return {0.0, 0.0, std::copysign(1.0, p.z())};
      }
      const double across = rho > 0.0 ? 1.0 / (rho * steep) : 0.0;
      return {p.x() * across, p.y() * across, -rise / steep};
    }
    case Kind::kBox: {
      const int axis = (p.cwiseAbs() - size).largest();
      return std::copysign(1.0, p[axis]) * Vec3::Unit(axis);
    }
    case Kind::kPolytope: {
      const auto height = [&p](const Plane& f) { return f.normal.dot(p) - f.offset; };
      return std::max_element(planes.begin(), planes.end(),
                              [&](const Plane& f, const Plane& g) { return height(f) < height(g); })
          ->normal;
    }
    default:
      return Vec3::UnitZ();
  }
}

// ---- Solids
// --------------------------------------------------------------------------------------

ImplicitSolid ImplicitSolid::single(ImplicitMember member, double radius, double volume) {
  ImplicitSolid solid;
  solid.members_.push_back(std::move(member));
  solid.steps_.push_back(0);
  solid.radius = radius;
  solid.most_volume = volume;
  return solid;
}

ImplicitSolid ImplicitSolid::half_space() {
  const double far = std::numeric_limits<double>::infinity();
  return single({}, far, far);
}
ImplicitSolid ImplicitSolid::ellipsoid(const Vec3& semi_axes) {
  return single({.kind = Kind::kEllipsoid, .size = semi_axes, .planes = {}, .X_SM = {}, .X_MS = {}},
                semi_axes.maxCoeff(), 4.0 / 3.0 * kPi * semi_axes.prod());
}
ImplicitSolid ImplicitSolid::capsule(double radius, double half_length) {
  return single({.kind = Kind::kCapsule,
                 .size = Vec3(radius, half_length, 0.0),
                 .planes = {},
                 .X_SM = {},
                 .X_MS = {}},
                radius + half_length,
                kPi * radius * radius * (2.0 * half_length + 4.0 / 3.0 * radius));
}
ImplicitSolid ImplicitSolid::frustum(double bottom, double top, double half_length) {
  const double widest = std::max(bottom, top);
  return single({.kind = Kind::kFrustum,
                 .size = Vec3(bottom, top, half_length),
                 .planes = {},
                 .X_SM = {},
                 .X_MS = {}},
                std::hypot(widest, half_length),
                2.0 / 3.0 * kPi * half_length * (bottom * bottom + bottom * top + top * top));
}
ImplicitSolid ImplicitSolid::box(const Vec3& half_sizes) {
  return single({.kind = Kind::kBox, .size = half_sizes, .planes = {}, .X_SM = {}, .X_MS = {}},
                half_sizes.norm(), 8.0 * half_sizes.prod());
}
ImplicitSolid ImplicitSolid::torus(double major_radius, double minor_radius) {
  return single({.kind = Kind::kTorus,
                 .size = Vec3(major_radius, minor_radius, 0.0),
                 .planes = {},
                 .X_SM = {},
                 .X_MS = {}},
                major_radius + minor_radius,
                2.0 * kPi * kPi * major_radius * minor_radius * minor_radius);
}

ImplicitSolid ImplicitSolid::polytope(const std::vector<Vec3>& points) {
  ImplicitMember member;
  member.kind = Kind::kPolytope;
  double radius = 0.0;
  for (const Vec3& p : points) radius = std::max(radius, p.norm());
  const double least = 1e-13 * radius;
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      for (std::size_t k = j + 1; k < n; ++k) {
        const Vec3 across = (points[j] - points[i]).cross(points[k] - points[i]);
        const double area = across.norm();
        if (area < 1e-12 * radius * radius) continue;
        for (const double sign : {1.0, -1.0}) {
          const Vec3 normal = sign / area * across;
          const double offset = normal.dot(points[i]);
          const bool outer = std::all_of(points.begin(), points.end(), [&](const Vec3& p) {
            return normal.dot(p) - offset <= least;
          });
          const bool known =
              std::any_of(member.planes.begin(), member.planes.end(), [&](const auto& f) {
                return f.normal.dot(normal) > 1.0 - 1e-14 && std::abs(f.offset - offset) <= least;
              });
          if (outer && !known) member.planes.push_back({normal, offset});
        }
      }
    }
  }
  Vec3 low = points.front(), high = points.front();
  for (const Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return single(std::move(member), radius, (high - low).prod());
}

ImplicitSolid ImplicitSolid::joined(const ImplicitSolid& a, const ImplicitSolid& b, int operation) {
  ImplicitSolid solid = a;
  const int first = static_cast<int>(a.members_.size());
  if (first + b.members_.size() > kMostMembers) throw std::invalid_argument("too many members");
  solid.members_.insert(solid.members_.end(), b.members_.begin(), b.members_.end());
  for (const int step : b.steps_) solid.steps_.push_back(step < 0 ? step : step + first);
  solid.steps_.push_back(operation);
  return solid;
}

ImplicitSolid operator|(const ImplicitSolid& a, const ImplicitSolid& b) {
  ImplicitSolid solid = ImplicitSolid::joined(a, b, kUnion);
  const Vec3 way = b.middle - a.middle;
  const double reach = std::max(a.radius, way.norm() + b.radius);
  solid.radius = reach;
  solid.most_volume = a.most_volume + b.most_volume;
  return solid;
}
ImplicitSolid operator&(const ImplicitSolid& a, const ImplicitSolid& b) {
  ImplicitSolid solid = ImplicitSolid::joined(a, b, kIntersection);
  if (b.radius < a.radius) {
    solid.middle = b.middle;
    solid.radius = b.radius;
  }
  solid.most_volume = std::min(a.most_volume, b.most_volume);
  return solid;
}
ImplicitSolid operator-(const ImplicitSolid& a, const ImplicitSolid& b) {
  return ImplicitSolid::joined(a, b, kDifference);
}

ImplicitSolid ImplicitSolid::posed(const Pose& X_WS) const {
  ImplicitSolid solid = *this;
  for (ImplicitMember& member : solid.members_) {
    member.X_SM = X_WS * member.X_SM;
    member.X_MS = member.X_SM.inverse();
  }
  solid.middle = X_WS * middle;
  return solid;
}

bool ImplicitSolid::is_convex() const { return members_.size() == 1 && members_[0].is_convex(); }

double ImplicitSolid::value(const Vec3& p) const {
  std::array<double, kMostMembers> stack;
  std::size_t top = 0;
  for (const int step : steps_) {
    if (step >= 0) {
      stack[top++] = members_[static_cast<std::size_t>(step)].value(p);
      continue;
    }
    const double b = stack[--top];
    double& a = stack[top - 1];
    if (step == kUnion) a = std::min(a, b);
    if (step == kIntersection) a = std::max(a, b);
    if (step == kDifference) a = std::max(a, -b);
  }
  return stack[0];
}

bool ImplicitSolid::holds(std::uint64_t inside) const {
  std::uint64_t stack = 0;  // of bits, the top lowest
  for (const int step : steps_) {
    if (step >= 0) {
      stack = stack << 1 | (inside >> step & 1);
      continue;
    }
    const std::uint64_t b = stack & 1;
    stack >>= 1;
    const std::uint64_t a = stack & 1;
    const std::uint64_t both = step == kUnion          ? (a | b)
                               : step == kIntersection ? (a & b)
                                                       : (a & ~b);
    stack = (stack & ~std::uint64_t{1}) | (both & 1);
  }
  return stack & 1;
}

// ---- Lines
// ---------------------------------------------------------------------------------------
// A line is n + s d with n its place nearest to the member's origin: so no number is larger than
// the solid.

MemberLines::MemberLines(const ImplicitMember& member, const Vec3& d_S)
    : member_(member), d_(member.X_MS.rotation * d_S) {
  const Vec3& size = member.size;
  across_ = square(d_.x()) + square(d_.y());
  switch (member.kind) {
    case Kind::kHalfSpace:
      ball_ = kInfinity;
      break;
    case Kind::kEllipsoid:
      ball_ = square(size.maxCoeff());
      scaled_ = d_.cwiseQuotient(size);
      break;
    case Kind::kCapsule:
      ball_ = square(size.x() + size.y());
      break;
    case Kind::kFrustum:
      ball_ = square(std::max(size.x(), size.y())) + square(size.z());
      rise_ = (size.y() - size.x()) / (2.0 * size.z());
      break;
    case Kind::kBox:
      ball_ = size.squaredNorm();
      break;
    case Kind::kTorus:
      ball_ = square(size.x() + size.y());
      break;
    case Kind::kPolytope:
      ball_ = kInfinity;
      for (const auto& plane : member.planes) rates_.push_back(plane.normal.dot(d_));
      break;
  }
}

void MemberLines::add_parts(const Vec3& o_S, double reach, LineParts& out) const {
  const Vec3 o = member_.X_MS * o_S;
  const double around = -o.dot(d_);
  const Vec3 n = o + around * d_;
  if (n.squaredNorm() > ball_) return;
  Span span{-kInfinity, kInfinity};
  switch (member_.kind) {
    case Kind::kHalfSpace:
      if (d_.z() > 0.0) span.leave = -n.z() / d_.z();
      if (d_.z() < 0.0) span.enter = -n.z() / d_.z();
      if (d_.z() == 0.0 && n.z() > 0.0) return;
      break;
    case Kind::kEllipsoid:
      span = ellipsoid(n);
      break;
    case Kind::kCapsule:
      span = capsule(n);
      break;
    case Kind::kFrustum:
      span = frustum(n);
      break;
    case Kind::kBox:
      for (int axis = 0; axis < 3; ++axis) {
        const Span between = slab(axis, n, member_.size[axis]);
        span = {std::max(span.enter, between.enter), std::min(span.leave, between.leave)};
      }
      break;
    case Kind::kPolytope:
      span = facets(n);
      break;
    case Kind::kTorus:
      return add_torus(n, around, reach, out);
  }
  out.add(std::max(-reach, around + span.enter), std::min(reach, around + span.leave));
}

// The ball of radius 1 about the origin, after the axes are scaled.
MemberLines::Span MemberLines::ellipsoid(const Vec3& n) const {
  const Vec3 p = n.cwiseQuotient(member_.size);
  const double rate = scaled_.squaredNorm(), middle = -p.dot(scaled_) / rate;
  const double left = 1.0 - (p + middle * scaled_).squaredNorm();
  if (!(left > 0.0)) return kNowhere;
  const double half = std::sqrt(left / rate);
  return {middle - half, middle + half};
}

MemberLines::Span MemberLines::slab(int axis, const Vec3& n, double half) const {
  const double rate = std::abs(d_[axis]);
  const double at = d_[axis] < 0.0 ? -n[axis] : n[axis];
  if (rate == 0.0) return std::abs(at) < half ? kEverywhere : kNowhere;
  return {(-half - at) / rate, (half - at) / rate};
}

// About the z axis, without end.
MemberLines::Span MemberLines::tube(const Vec3& n, double radius) const {
  const double cross = std::abs(n.x() * d_.y() - n.y() * d_.x());
  if (across_ == 0.0) {
    return square(n.x()) + square(n.y()) < square(radius) ? kEverywhere : kNowhere;
  }
  const double far = std::sqrt(across_) * radius;
  if (!(cross < far)) return kNowhere;
  const double half = std::sqrt((far - cross) * (far + cross)) / across_;
  const double middle = -(n.x() * d_.x() + n.y() * d_.y()) / across_;
  return {middle - half, middle + half};
}

// A tube between two heights and a ball at each of them; one part, as the whole is convex.
MemberLines::Span MemberLines::capsule(const Vec3& n) const {
  const double r = member_.size.x(), h = member_.size.y();
  const Span wall = tube(n, r), between = slab(2, n, h);
  Span all{std::max(wall.enter, between.enter), std::min(wall.leave, between.leave)};
  if (!(all.enter < all.leave)) all = kNowhere;
  for (const double end : {h, -h}) {
    const double middle = end * d_.z();
    const Vec3 nearest = n + middle * d_ - end * Vec3::UnitZ();
    const double left = r * r - nearest.squaredNorm();
    if (!(left > 0.0)) continue;
    const double half = std::sqrt(left);
    all = {std::min(all.enter, middle - half), std::max(all.leave, middle + half)};
  }
  return all;
}

// Between two heights the sign of x^2 + y^2 - (radius at z)^2 tells; it changes at two places.
MemberLines::Span MemberLines::frustum(const Vec3& n) const {
  const double top = member_.size.y(), bottom = member_.size.x(), h = member_.size.z();
  const Span between = slab(2, n, h);
  if (rise_ == 0.0) {
    const Span wall = tube(n, top);
    return {std::max(wall.enter, between.enter), std::min(wall.leave, between.leave)};
  }
  // a s^2 + 2 b s + c, and b^2 - a c as a difference of two squares.
  const double g = 0.5 * (bottom + top) + rise_ * n.z(), k = rise_ * d_.z();
  const double a = across_ - k * k;
  const double b = n.x() * d_.x() + n.y() * d_.y() - k * g;
  const double c = square(n.x()) + square(n.y()) - g * g;
  const double across = std::abs(n.x() * d_.y() - n.y() * d_.x());
  const double along = std::sqrt(square(g * d_.x() - k * n.x()) + square(g * d_.y() - k * n.y()));
  const auto value = [&](double s) { return (a * s + 2.0 * b) * s + c; };
  double cuts[4] = {between.enter, between.enter, between.enter, between.leave};
  if (across < along) {
    const double root = std::sqrt((along - across) * (along + across));
    const double q = -(b + std::copysign(root, b));
    double first = a != 0.0 ? q / a : kInfinity, second = q != 0.0 ? c / q : kInfinity;
    for (double* s : {&first, &second}) {
      const double slope = 2.0 * (a * *s + b), better = *s - value(*s) / slope;
      // At a place of contact the slope is small, and a step would lead away.
      if (std::abs(better - *s) <= 1e-3 * h) *s = better;
    }
    if (second < first) std::swap(first, second);
    cuts[1] = std::clamp(first, between.enter, between.leave);
    cuts[2] = std::clamp(second, between.enter, between.leave);
  }
  Span all = kNowhere;
  for (int i = 0; i < 3; ++i) {
    if (!(cuts[i] < cuts[i + 1]) || !(value(0.5 * (cuts[i] + cuts[i + 1])) < 0.0)) continue;
    all = {std::min(all.enter, cuts[i]), std::max(all.leave, cuts[i + 1])};
  }
  return all;
}

MemberLines::Span MemberLines::facets(const Vec3& n) const {
  Span span = kEverywhere;
  for (std::size_t i = 0; i < rates_.size(); ++i) {
    const auto& plane = member_.planes[i];
    const double value = plane.normal.dot(n) - plane.offset, rate = rates_[i];
    if (rate > 0.0) span.leave = std::min(span.leave, -value / rate);
    if (rate < 0.0) span.enter = std::max(span.enter, -value / rate);
    if (rate == 0.0 && value > 0.0) return kNowhere;
    if (!(span.enter < span.leave)) return kNowhere;
  }
  return span;
}

// (|p|^2 + R^2 - r^2)^2 - 4 R^2 (x^2 + y^2) with p = n + s d: |p|^2 = n^2 + s^2. Between two roots
// the sign of the distance tells.
void MemberLines::add_torus(const Vec3& n, double around, double reach, LineParts& out) const {
  const double R = member_.size.x(), r = member_.size.y();
  const Span between = slab(2, n, r);
  const double low = std::max({between.enter, -(R + r), -reach - around});
  const double high = std::min({between.leave, R + r, reach - around});
  if (!(low < high)) return;
  const double k = n.squaredNorm() + R * R - r * r;
  const double mixed = n.x() * d_.x() + n.y() * d_.y();
  const double middle = square(n.x()) + square(n.y());
  const double c[5] = {k * k - 4.0 * R * R * middle, -8.0 * R * R * mixed,
                       2.0 * k - 4.0 * R * R * across_, 0.0, 1.0};
  double cuts[6];
  const int count = polynomial_roots(c, 4, low, high, cuts + 1);
  cuts[0] = low;
  cuts[count + 1] = high;
  const auto is_inside = [&](double s) {
    const Vec3 p = n + s * d_;
    const double off = std::sqrt(square(p.x()) + square(p.y())) - R;
    return off * off + p.z() * p.z() < r * r;
  };
  for (int i = 0; i <= count; ++i) {
    double enter = cuts[i];
    if (!is_inside(0.5 * (enter + cuts[i + 1]))) continue;
    while (i < count && is_inside(0.5 * (cuts[i + 1] + cuts[i + 2]))) ++i;
    out.add(around + enter, around + cuts[i + 1]);
  }
}

SolidLines::SolidLines(const ImplicitSolid& solid, const Vec3& d) : solid_(solid) {
  members_.reserve(solid.members().size());
  for (const ImplicitMember& member : solid.members()) members_.emplace_back(member, d);
}

void SolidLines::parts(const Vec3& o, double reach, LineParts& out) {
  out.count = 0;
  if (members_.size() == 1) return members_[0].add_parts(o, reach, out);
  ends_.clear();
  std::uint64_t bit = 1;
  for (const MemberLines& member : members_) {
    of_member_.count = 0;
    member.add_parts(o, reach, of_member_);
    for (const auto& part : of_member_) {
      ends_.push_back({part.enter, bit});
      ends_.push_back({part.leave, bit});
    }
    bit <<= 1;
  }
  std::sort(ends_.begin(), ends_.end(), [](const End& e, const End& f) { return e.t < f.t; });
  std::uint64_t inside = 0;
  bool within = false;
  double enter = 0.0;
  for (const End& end : ends_) {
    inside ^= end.member;
    const bool is = solid_.holds(inside);
    if (is && !within) enter = end.t;
    if (within && !is) out.add(enter, end.t);
    within = is;
  }
}

}  // namespace volcontact::test
