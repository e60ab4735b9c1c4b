// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>

#include "volcontact/shape/pieces.h"
#include "volcontact/shape/shapes.h"
#include "volcontact/shape/solid.h"

namespace volcontact {

/// The least the octree needs of a solid, convex or not; meaning as in ConvexSolid. May also offer
///  pieces(list)                 exact faces: see PieceList
///  gradient(p)                  with curvature_bound(p, reach): a bound of the second derivatives
///                               of signed_distance within `reach` of p [1/m], infinite at a kink
///  bend_bound()                 bound K of its second derivatives [1/m] where it is below 1/(2 K)
///  signed_distances(p, n, f)    the signed distances of n points at once
/// The octree's bounds are certain when signed_distance is nowhere steeper than 1 and these hold.
template <typename S>
concept DistanceField = requires(const S& solid, const Vec3& x) {
  { solid.bounds() } -> std::same_as<Aabb>;
  { solid.signed_distance(x) } -> std::same_as<double>;
};

/// A solid of any type through one table of functions, so that the octree is compiled once. It
/// refers to the solid and must not outlive it. A function that the solid lacks is null.
struct SolidView {
  const void* solid = nullptr;
  Aabb bounds;
  VolumeMetrics own;  ///< of the whole solid; volume -1 where unknown
  bool convex = false;
  double bend_bound = kInfinity;  ///< K of the second derivatives where |signed_distance| < 1/(2 K)
  double (*signed_distance)(const void*, const Vec3&) = nullptr;
  void (*signed_distances)(const void*, const Vec3*, int, double*) = nullptr;
  Vec3 (*gradient)(const void*, const Vec3&) = nullptr;
  double (*curvature_bound)(const void*, const Vec3&, double) = nullptr;
  void (*pieces)(const void*, PieceList&) = nullptr;
  // Convex solids only.
  Vec3 (*support)(const void*, const Vec3&) = nullptr;
  double (*support_height)(const void*, const Vec3&) = nullptr;
  RayInterval (*ray)(const void*, const Vec3&, const Vec3&) = nullptr;
};

template <DistanceField S>
SolidView view_of(const S& solid) {
  SolidView view;
  view.solid = &solid;
  view.bounds = solid.bounds();
  view.signed_distance = [](const void* s, const Vec3& p) {
    return static_cast<const S*>(s)->signed_distance(p);
  };
  if constexpr (requires(const Vec3* p, double* f) { solid.signed_distances(p, 1, f); }) {
    view.signed_distances = [](const void* s, const Vec3* p, int count, double* f) {
      static_cast<const S*>(s)->signed_distances(p, count, f);
    };
  } else {
    view.signed_distances = [](const void* s, const Vec3* p, int count, double* f) {
      for (int i = 0; i < count; ++i) f[i] = static_cast<const S*>(s)->signed_distance(p[i]);
    };
  }
  if constexpr (requires { solid.bend_bound(); }) view.bend_bound = solid.bend_bound();
  if constexpr (requires(const Vec3& p) { solid.gradient(p); }) {
    view.gradient = [](const void* s, const Vec3& p) -> Vec3 {
      return static_cast<const S*>(s)->gradient(p);
    };
  }
  if constexpr (requires(const Vec3& p) {
                  solid.curvature_bound(p, 1.0);
                  solid.gradient(p);
                }) {
    view.curvature_bound = [](const void* s, const Vec3& p, double reach) -> double {
      return static_cast<const S*>(s)->curvature_bound(p, reach);
    };
  }
  if constexpr (requires(PieceList& list) { add_pieces(solid, list); }) {
    view.pieces = [](const void* s, PieceList& list) {
      add_pieces(*static_cast<const S*>(s), list);
    };
  }
  view.own.volume = -1.0;
  if constexpr (Solid<S>) view.own = solid.own_metrics();
  if constexpr (ConvexSolid<S>) {
    view.convex = true;
    view.support = [](const void* s, const Vec3& e) -> Vec3 {
      return static_cast<const S*>(s)->support(e);
    };
    view.support_height = [](const void* s, const Vec3& e) {
      return static_cast<const S*>(s)->support_height(e);
    };
    view.ray = [](const void* s, const Vec3& o, const Vec3& d) {
      return static_cast<const S*>(s)->ray(o, d);
    };
  }
  return view;
}

inline SolidView view_of(const Shape& shape) {
  return std::visit([](const auto& solid) { return view_of(solid); }, shape);
}

}  // namespace volcontact
