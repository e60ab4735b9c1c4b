// SPDX-License-Identifier: Apache-2.0
#include "core/reference/implicit_solid.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace volcontact::test {
namespace {

using Kind = ImplicitMember::Kind;

constexpr int kUnion = -1, kIntersection = -2, kDifference = -3;

struct Roots {
  std::array<double, 16> t{};
  int count = 0;
  void add(double root) {
    if (std::isfinite(root) && count < static_cast<int>(t.size())) {
      t[static_cast<std::size_t>(count++)] = root;
    }
  }
};

// Roots of the linear function that has these values at t = 0 and at t = step.
void add_linear(double at_zero, double at_step, double step, Roots& roots) {
  roots.add(-at_zero * step / (at_step - at_zero));
}

// Roots of the polynomial of second degree F, from three of its values about `around`; F itself has
// the last word.
template <typename F>
void add_quadratic(const F& function, double around, double step, Roots& roots) {
  const double low = function(around - step), middle = function(around);
  const double high = function(around + step);
  const double a = 0.5 * (high + low) - middle, b = 0.5 * (high - low);
  double s[2];
  int count = 0;
  if (std::abs(a) <= 1e-14 * (std::abs(b) + std::abs(middle))) {
    s[count++] = -middle / b;
  } else {
    const double root = b * b - 4.0 * a * middle;
    if (root < 0.0) return;
    const double q = -0.5 * (b + std::copysign(std::sqrt(root), b));
    s[count++] = q / a;
    if (q != 0.0) s[count++] = middle / q;
  }
  for (int i = 0; i < count; ++i) {
    double t = around + step * s[i];
    const double slope = (2.0 * a * s[i] + b) / step;
    if (slope != 0.0 && std::isfinite(t)) {
      const double better = t - function(t) / slope;
      // At a place of contact the slope is small, and a step would lead away.
      if (std::abs(better - t) <= 1e-3 * step) t = better;
    }
    roots.add(t);
  }
}

double horner(const double* c, int degree, double t) {
  double sum = c[degree];
  for (int i = degree - 1; i >= 0; --i) sum = sum * t + c[i];
  return sum;
}

// Real roots in [low, high] of a polynomial: its turning points part it into stretches on which it
// rises or falls; there Newton's steps, or bisection where they lead out.
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
  for (int i = 0; i <= inner; ++i) {
    double left = turns[i], right = turns[i + 1], t = 0.5 * (left + right);
    const bool negative = horner(c, degree, left) < 0.0;
    if (negative == (horner(c, degree, right) < 0.0)) continue;
    for (int k = 0; k < 100; ++k) {
      const double value = horner(c, degree, t);
      ((value < 0.0) == negative ? left : right) = t;
      const double next = t - value / horner(slope, degree - 1, t);
      const double before = t;
      t = next > left && next < right ? next : 0.5 * (left + right);
      if (std::abs(t - before) <= 1e-16 * (high - low)) break;
    }
    roots[count++] = t;
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
      int axis = 0;
      (p.cwiseAbs() - size).maxCoeff(&axis);
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

void ImplicitMember::parts(const Vec3& o_S, const Vec3& d_S, double reach, LineParts& out) const {
  const Vec3 o = X_MS * o_S, d = X_MS.rotation * d_S;
  const auto at = [&](double t) { return Vec3(o + t * d); };
  out.count = 0;
  if (kind == Kind::kPolytope) {  // one interval, cut plane by plane
    double enter = -reach, leave = reach;
    for (const Plane& plane : planes) {
      const double value = plane.normal.dot(o) - plane.offset, rate = plane.normal.dot(d);
      if (rate > 0.0) leave = std::min(leave, -value / rate);
      if (rate < 0.0) enter = std::max(enter, -value / rate);
      if (rate == 0.0 && value > 0.0) return;
    }
    if (enter < leave) out = {{enter, leave}, 1};
    return;
  }
  // Most lines pass by: the least distance from the middle tells.
  const double around = -o.dot(d);
  const Vec3 nearest = at(around);
  Roots roots;
  const auto add_height = [&](double z) { add_linear(o.z() - z, at(1.0).z() - z, 1.0, roots); };
  switch (kind) {
    case Kind::kHalfSpace:
      add_height(0.0);
      break;
    case Kind::kEllipsoid: {
      const double step = size.maxCoeff();
      if (nearest.squaredNorm() > step * step) return;
      add_quadratic([&](double t) { return at(t).cwiseQuotient(size).squaredNorm() - 1.0; }, around,
                    step, roots);
      break;
    }
    case Kind::kCapsule: {
      const double r = size.x(), h = size.y(), step = r + h;
      if (nearest.squaredNorm() > step * step) return;
      const auto tube = [&](double t) {
        const Vec3 p = at(t);
        return square(p.x()) + square(p.y()) - r * r;
      };
      add_quadratic(tube, around, step, roots);
      for (const double end : {h, -h}) {
        add_quadratic([&](double t) { return tube(t) + square(at(t).z() - end); }, around, step,
                      roots);
        add_height(end);
      }
      break;
    }
    case Kind::kFrustum: {
      const double step = std::max(std::max(size.x(), size.y()), size.z());
      if (nearest.squaredNorm() > 2.0 * step * step) return;
      const double rise = (size.y() - size.x()) / (2.0 * size.z());
      const double mean = 0.5 * (size.x() + size.y());
      add_quadratic(
          [&](double t) {
            const Vec3 p = at(t);
            return square(p.x()) + square(p.y()) - square(mean + rise * p.z());
          },
          around, step, roots);
      add_height(size.z());
      add_height(-size.z());
      break;
    }
    case Kind::kBox:
      if (nearest.squaredNorm() > size.squaredNorm()) return;
      for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {size[axis], -size[axis]}) {
          add_linear(o[axis] - side, o[axis] + d[axis] - side, 1.0, roots);
        }
      }
      break;
    case Kind::kTorus: {
      const double R = size.x(), r = size.y();
      if (nearest.squaredNorm() > square(R + r) || std::abs(around) > reach + R + r) return;
      // (|p|^2 + R^2 - r^2)^2 - 4 R^2 (x^2 + y^2) with p = nearest + s d: |p|^2 = n^2 + s^2.
      const double k = nearest.squaredNorm() + R * R - r * r;
      const double across = square(d.x()) + square(d.y());
      const double mixed = nearest.x() * d.x() + nearest.y() * d.y();
      const double middle = square(nearest.x()) + square(nearest.y());
      const double c[5] = {k * k - 4.0 * R * R * middle, -8.0 * R * R * mixed,
                           2.0 * k - 4.0 * R * R * across, 0.0, 1.0};
      double found[4];
      const int count = polynomial_roots(c, 4, -(R + r), R + r, found);
      for (int i = 0; i < count; ++i) roots.add(around + found[i]);
      break;
    }
    case Kind::kPolytope:
      break;
  }
  std::sort(roots.t.begin(), roots.t.begin() + roots.count);
  double from = -reach;
  bool open = false;
  for (int i = 0; i <= roots.count; ++i) {
    const double last = i < roots.count ? roots.t[static_cast<std::size_t>(i)] : reach;
    const double to = std::clamp(last, -reach, reach);
    if (!(to > from)) continue;
    if (local_value(at(0.5 * (from + to))) < 0.0) {
      const auto end = static_cast<std::size_t>(2 * out.count);
      if (open) {
        out.ends[end - 1] = to;
      } else if (out.count < LineParts::kMost) {
        out.ends[end] = from;
        out.ends[end + 1] = to;
        ++out.count;
        open = true;
      }
    } else {
      if (open && is_convex()) return;
      open = false;
    }
    from = to;
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

}  // namespace volcontact::test
