// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/parallel_solid.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace volcontact {
namespace {

// A solid about the z axis moves along it when its ends do.
struct Inner {
  Shape shape;
  double shift = 0.0;  // along z
};

std::optional<Inner> inside(const Sphere& solid, double depth) {
  if (!(solid.radius() > depth)) return {};
  return Inner{Sphere({.radius = solid.radius() - depth})};
}

std::optional<Inner> inside(const Capsule& solid, double depth) {
  if (!(solid.radius() > depth)) return {};
  return Inner{Capsule({.radius = solid.radius() - depth, .half_length = solid.half_length()})};
}

std::optional<Inner> inside(const Cylinder& solid, double depth) {
  if (!(std::min(solid.radius(), solid.half_length()) > depth)) return {};
  return Inner{
      Cylinder({.radius = solid.radius() - depth, .half_length = solid.half_length() - depth})};
}

std::optional<Inner> inside(const Box& solid, double depth) {
  if (!(solid.half_sizes().minCoeff() > depth)) return {};
  return Inner{Box({.half_sizes = solid.half_sizes() - Vec3::Constant(depth)})};
}

// Beyond the radius the edges are sharp.
std::optional<Inner> inside(const RoundedBox& solid, double depth) {
  if (!(solid.half_sizes().minCoeff() > depth)) return {};
  const Vec3 half = solid.half_sizes() - Vec3::Constant(depth);
  if (!(solid.radius() > depth)) return Inner{Box({.half_sizes = half})};
  const double radius = std::min(solid.radius() - depth, half.minCoeff());
  return Inner{RoundedBox({.half_sizes = half, .radius = radius})};
}

std::optional<Inner> inside(const Torus& solid, double depth) {
  if (!(solid.minor_radius() > depth)) return {};
  return Inner{
      Torus({.major_radius = solid.major_radius(), .minor_radius = solid.minor_radius() - depth})};
}

// The wall moves in at right angles to itself; where it meets the axis first, the end is an apex.
std::optional<Inner> inside(const Frustum& solid, double depth) {
  const auto& p = solid.params();
  if (!(p.half_length > depth)) return {};
  const double slope = (p.top_radius - p.bottom_radius) / (2.0 * p.half_length);
  const double middle =
      0.5 * (p.bottom_radius + p.top_radius) - depth * std::sqrt(1.0 + slope * slope);
  double low = depth - p.half_length, high = p.half_length - depth;
  if (middle + slope * low < 0.0) low = -middle / slope;
  if (middle + slope * high < 0.0) high = -middle / slope;
  if (!(high > low) || !(std::max(middle + slope * low, middle + slope * high) > 0.0)) return {};
  return Inner{Frustum({.bottom_radius = std::max(0.0, middle + slope * low),
                        .top_radius = std::max(0.0, middle + slope * high),
                        .half_length = 0.5 * (high - low)}),
               0.5 * (high + low)};
}

std::optional<Inner> inside(const HalfSpace& solid, double depth) { return Inner{solid, -depth}; }

template <typename S>
constexpr bool kHasInside = requires(const S& solid, double depth) { inside(solid, depth); };
template <typename S>
constexpr bool kIsLayered = kHasInside<S> && !std::is_same_v<S, HalfSpace>;

// The part of a composed solid that is deeper than a depth; what is taken away grows by it.
class ComposedInside {
 public:
  explicit ComposedInside(const Csg& solid) : solid_(solid), next_(solid.steps().size()) {}

  std::optional<Csg> make(double depth) {
    const Csg::Step step = solid_.steps()[--next_];
    if (step.member >= 0) return member(solid_.members()[step.member], depth);
    const bool taken = step.operation == Csg::Operation::kDifference;
    // The steps are in postfix order: the last operand comes first.
    const std::optional<Csg> b = make(taken ? -depth : depth), a = make(depth);
    const bool both_needed = step.operation == Csg::Operation::kIntersection;
    if (a && b) return Csg(step.operation, *a, *b);
    if (both_needed) return {};
    return a || taken ? a : b;
  }

 private:
  static std::optional<Csg> member(const Csg::Member& member, double depth) {
    return std::visit(
        [&](const auto& shape) -> std::optional<Csg> {
          if constexpr (kHasInside<std::decay_t<decltype(shape)>>) {
            const std::optional<Inner> inner = inside(shape, depth);
            if (!inner) return {};
            const Pose X_MI{Mat3::Identity(), Vec3(0.0, 0.0, inner->shift)};
            return std::visit(
                [&](const auto& s) -> std::optional<Csg> {
                  if constexpr (std::is_constructible_v<SimpleShape, decltype(s)>) {
                    return Csg(SimpleShape(s), member.X_SM * X_MI);
                  }
                  return {};
                },
                inner->shape);
          }
          return {};
        },
        member.shape);
  }

  const Csg& solid_;
  std::size_t next_;
};

bool has_insides(const Csg& solid) {
  const auto has = [](const Csg::Member& member) {
    return std::visit([](const auto& s) { return kHasInside<std::decay_t<decltype(s)>>; },
                      member.shape);
  };
  return std::all_of(solid.members().begin(), solid.members().end(), has);
}

double depth_of(const Sphere& solid) { return solid.radius(); }
double depth_of(const Capsule& solid) { return solid.radius(); }
double depth_of(const Cylinder& solid) { return std::min(solid.radius(), solid.half_length()); }
double depth_of(const Box& solid) { return solid.half_sizes().minCoeff(); }
double depth_of(const RoundedBox& solid) { return solid.half_sizes().minCoeff(); }
double depth_of(const Torus& solid) { return solid.minor_radius(); }
// Of the ball that touches the wall and the wide end.
double depth_of(const Frustum& solid) {
  const auto& p = solid.params();
  const double slope = std::abs(p.top_radius - p.bottom_radius) / (2.0 * p.half_length);
  const double wide = std::max(p.bottom_radius, p.top_radius);
  return std::min(p.half_length, wide / (slope + std::sqrt(1.0 + slope * slope)));
}

double area_of(const Sphere& solid) { return 4.0 * kPi * solid.radius() * solid.radius(); }
double area_of(const Capsule& solid) {
  return 4.0 * kPi * solid.radius() * (solid.radius() + solid.half_length());
}
double area_of(const Cylinder& solid) {
  return 2.0 * kPi * solid.radius() * (solid.radius() + 2.0 * solid.half_length());
}
double area_of(const Box& solid) {
  const Vec3& h = solid.half_sizes();
  return 8.0 * (h.x() * h.y() + h.y() * h.z() + h.z() * h.x());
}
double area_of(const RoundedBox& solid) {
  const double r = solid.radius();
  const Vec3 a = solid.half_sizes() - Vec3::Constant(r);
  return 8.0 * (a.x() * a.y() + a.y() * a.z() + a.z() * a.x()) + 4.0 * kPi * r * (a.sum() + r);
}
double area_of(const Torus& solid) {
  return 4.0 * kPi * kPi * solid.major_radius() * solid.minor_radius();
}
double area_of(const Frustum& solid) {
  const auto& p = solid.params();
  const double r = p.bottom_radius, q = p.top_radius;
  return kPi * ((r + q) * std::hypot(r - q, 2.0 * p.half_length) + r * r + q * q);
}

}  // namespace

bool has_parallel_solids(const Shape& solid) {
  return std::visit([](const auto& s) { return kIsLayered<std::decay_t<decltype(s)>>; }, solid);
}

bool has_composed_parallels(const Shape& solid) {
  const Csg* composed = std::get_if<Csg>(&solid);
  return composed && has_insides(*composed);
}

double greatest_depth(const Shape& solid) {
  return std::visit(
      [](const auto& s) -> double {
        using S = std::decay_t<decltype(s)>;
        if constexpr (kIsLayered<S>) return depth_of(s);
        if constexpr (std::is_same_v<S, Csg>) {
          return has_insides(s) ? s.bounds().half_sizes().minCoeff() : kInfinity;
        }
        return kInfinity;
      },
      solid);
}

bool parallel_solid(const Shape& solid, double depth, Shape& inner, Pose& X_SI) {
  return std::visit(
      [&](const auto& s) {
        using S = std::decay_t<decltype(s)>;
        if constexpr (kIsLayered<S>) {
          const std::optional<Inner> found = inside(s, depth);
          if (!found) return false;
          inner = found->shape;
          X_SI = {Mat3::Identity(), Vec3(0.0, 0.0, found->shift)};
          return true;
        } else if constexpr (std::is_same_v<S, Csg>) {
          if (!has_insides(s)) return false;
          const std::optional<Csg> found = ComposedInside(s).make(depth);
          if (!found) return false;
          inner = *found;
          X_SI = {};
          return true;
        }
        return false;
      },
      solid);
}

double surface_area(const Shape& solid) {
  return std::visit(
      [](const auto& s) -> double {
        if constexpr (kIsLayered<std::decay_t<decltype(s)>>) return area_of(s);
        return 0.0;
      },
      solid);
}

}  // namespace volcontact
