// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <concepts>
#include <limits>

#include "volcontact/base/types.h"
#include "volcontact/metrics/volume_metrics.h"

namespace volcontact {

/// Axis-aligned box in the solid's frame [m]. Unbounded solids have infinite corners.
struct Aabb {
  Vec3 min;
  Vec3 max;

  bool bounded() const { return is_finite(min) && is_finite(max); }
  Vec3 center() const { return 0.5 * (min + max); }
  Vec3 half_sizes() const { return 0.5 * (max - min); }

  /// The box that holds nothing.
  static Aabb none() {
    const Vec3 far = Vec3::Constant(std::numeric_limits<double>::infinity());
    return {far, -far};
  }
  void add(const Vec3& point) {
    min = min.cwiseMin(point);
    max = max.cwiseMax(point);
  }
  void add(const Aabb& other) {
    min = min.cwiseMin(other.min);
    max = max.cwiseMax(other.max);
  }
  /// Distance from another box, 0 where they overlap [m].
  double distance(const Aabb& other) const {
    return (other.min - max).cwiseMax(min - other.max).cwiseMax(0.0).norm();
  }
};

/// Part of the line o + t d inside a convex solid: t from `enter` to `leave`; empty when
/// enter >= leave. Ends may be infinite.
struct RayInterval {
  double enter = 0.0;
  double leave = 0.0;
  bool empty() const { return !(enter < leave); }
};

/// What a solid must supply, all in its own frame. One header per shape; a shape knows no other
/// shape.
///  bounds()            an axis-aligned box that holds the solid, the smallest for a single shape
///  support_height(e)   max over the solid of e . x, or a bound of it; +infinity where unbounded
///  signed_distance(p)  negative inside; its magnitude never exceeds the distance to the surface
///                      (so a ball of that radius holds no surface)
///  gradient(p)         unit outward direction in which signed_distance grows at p
///  own_metrics()       volume, centroid and inertia of the whole solid; infinite where unbounded
template <typename S>
concept Solid = requires(const S& solid, const Vec3& x) {
  { S::kName } -> std::convertible_to<const char*>;
  { solid.bounds() } -> std::same_as<Aabb>;
  { solid.support_height(x) } -> std::same_as<double>;
  { solid.signed_distance(x) } -> std::same_as<double>;
  { solid.gradient(x) } -> std::same_as<Vec3>;
  { solid.own_metrics() } -> std::same_as<VolumeMetrics>;
};

/// What a convex solid must supply as well; its signed distance is zero on the surface only.
///  support(e)          a point of the solid farthest along the direction e (any length but zero);
///                      for unbounded solids in an unbounded direction: a point at infinity
///  ray(o, d)           the interval of the line o + t d inside the solid
template <typename S>
concept ConvexSolid = Solid<S> && requires(const S& solid, const Vec3& x) {
  { solid.support(x) } -> std::same_as<Vec3>;
  { solid.ray(x, x) } -> std::same_as<RayInterval>;
};

// What a solid may supply besides, so that engines know its surface: the octree asks for none.
//  volume()             that of own_metrics() alone, quickly: every evaluation asks for it [m^3]
//  pieces(list)         itself as pieces of quadric faces with disjoint interiors: pieces.h
//  write_faces(writer)  the faces whose insides have it as their intersection, with `kPlanesOnly`
//                       where none of them is round. They bear the sections and the columns.
//  write_parts(writer)  such faces for each of several parts, which go on in each other without an
//                       edge, or a ring. They bear the surface sweep.
// Written into a member template, so that a shape knows no engine: FaceWriter in
// pair/convex/face_set.h, PartWriter in pair/surface_sweep/sweep_solid.cc.

/// What `write_faces` may say, in the solid's frame.
struct AnyFaces {
  void plane(const Vec3&, double) {}                     ///< normal . x <= offset
  void round(const Vec3&, const Vec3&, double = 0.0) {}  ///< |diag(scales) (x - center)| <= 1
  void cone(double, double) {}                           ///< sqrt(x^2 + y^2) <= slope (z - apex)
  void rounded_tube(double, double) {}                   ///< radius, half_length
  void end(double, double, double) {}                    ///< side z <= half_length, with its radius
};
/// What `write_parts` may say, in the solid's frame.
struct AnyParts {
  void plane(const Vec3&, double, bool) {}  ///< and whether it is a seam, no surface
  void tube(int, double, const Vec3&) {}    ///< axis, radius, center
  void ball(double, const Vec3&) {}         ///< radius, center
  void ring(double, double) {}              ///< major_radius, minor_radius, about z
  void end_part() {}
};

template <typename S>
concept HasFaces = requires(const S& solid, AnyFaces& writer) { solid.write_faces(writer); };
/// Whether any of them is round.
template <typename S>
concept HasRoundFaces = HasFaces<S> && !requires { S::kPlanesOnly; };
template <typename S>
concept HasParts = requires(const S& solid, AnyParts& writer) { solid.write_parts(writer); };

}  // namespace volcontact
