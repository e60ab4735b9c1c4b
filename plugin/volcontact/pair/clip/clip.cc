// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/clip/clip.h"

#include "volcontact/pair/clip/clip_half_space.h"
#include "volcontact/pair/clip/clip_region.h"
#include "volcontact/pair/clip/clip_solids.h"
#include "volcontact/pair/convex/separation.h"

namespace volcontact {
namespace {

using namespace clipping;

template <typename SolidA, typename SolidB>
VolumeMetrics clip_solids(const SolidA& a, const SolidB& b, const Vec3& middle, double rounding,
                          ClipScratch& scratch) {
  start(b, scratch);
  if (!cut(a, middle, b.size(), rounding, scratch.polytope)) return VolumeMetrics{};
  return Region<SolidA, SolidB>(a, b, rounding, scratch).measure(a.origin);
}

// The whole of a solid, which lies inside the other one.
VolumeMetrics whole(const VolumeMetrics& own, const Pose& X_AX, double surface, bool is_a,
                    double rounding) {
  VolumeMetrics m = transformed(own, X_AX);
  (is_a ? m.area : m.counter_area) = surface;
  m.volume_error = 8.0 * kEpsilon * m.volume + rounding * surface;
  m.status = Status::kContained;
  return m;
}

// The same below the plane of a half-space, where the depth still means something.
VolumeMetrics immersed(const VolumeMetrics& own, const Pose& X_AB, double surface, double depth,
                       double rounding) {
  VolumeMetrics m = whole(own, X_AB, surface, false, rounding);
  m.depth = depth;
  m.depth_moment = -m.centroid.z() * m.volume;
  return m;
}

// Whether a box lies in another one; pose of its axes and centre in those of the outer one.
bool lies_in(const Vec3& half, const Vec3& outer_half, const Mat3& R, const Vec3& p) {
  return (p.cwiseAbs() + R.cwiseAbs() * half).at_most(outer_half);
}

// The point of A's bounds nearest to the middle of B: sums about the origin of A would lose digits
// when A is large.
Vec3 nearest_in(const Aabb& bounds, const Vec3& p) {
  return p.cwiseMax(bounds.min).cwiseMin(bounds.max);
}

// Rounding error of a position where coordinates reach this far.
double rounding_at(double reach) { return 4.0 * kEpsilon * reach; }

}  // namespace

VolumeMetrics clip(const HalfSpace&, const Box& b, const Pose& X_AB, ClipScratch& scratch) {
  const Vec3& half = b.half_sizes();
  const double height = X_AB.translation.z();
  const double reach = X_AB.rotation.row(2).cwiseAbs().dot(half);
  if (!(height < reach) || half.minCoeff() <= 0.0) return VolumeMetrics{};
  const double rounding = rounding_at(std::abs(height) + half.sum());
  if (height <= -reach) {
    return immersed(b.own_metrics(), X_AB, surface_of(b), 2.0 * reach, rounding);
  }
  Vec3 corners[8];
  place_corners(half, X_AB.rotation, Vec3(0.0, 0.0, height), corners);
  const auto loop = [](int f) { return std::span<const int>(kBoxLoops[f]); };
  const auto normal = [&](int f) { return box_normal(f, X_AB.rotation); };
  return measure_below(corners, 6, loop, normal, rounding,
                       Vec3(X_AB.translation.x(), X_AB.translation.y(), 0.0), scratch.part);
}

VolumeMetrics clip(const HalfSpace&, const ConvexPolytope& b, const Pose& X_AB,
                   ClipScratch& scratch) {
  const Vec3 up_B = X_AB.rotation.row(2);
  const double height = X_AB.translation.z();
  const double depth = b.support_height(-up_B) - height;
  if (!(depth > 0.0)) return VolumeMetrics{};
  const Aabb bounds = b.bounds();
  const double size = bounds.min.cwiseAbs().cwiseMax(bounds.max.cwiseAbs()).sum();
  const double rounding = rounding_at(std::abs(height) + size);
  const double top = height + b.support_height(up_B);
  if (top <= 0.0) {
    return immersed(b.own_metrics(), X_AB, b.surface_area(), depth + top, rounding);
  }
  scratch.corners.clear();
  for (const Vec3& v : b.vertices()) {
    scratch.corners.push_back(X_AB.rotation * v + Vec3(0.0, 0.0, height));
  }
  const auto& faces = b.faces();
  const auto loop = [&](int f) { return std::span<const int>(faces[f].loop); };
  const auto normal = [&](int f) { return Vec3(X_AB.rotation * faces[f].normal); };
  return measure_below(scratch.corners, static_cast<int>(faces.size()), loop, normal, rounding,
                       Vec3(X_AB.translation.x(), X_AB.translation.y(), 0.0), scratch.part);
}

VolumeMetrics clip(const Box& a, const Box& b, const Pose& X_AB, ClipScratch& scratch) {
  const Vec3 &half_a = a.half_sizes(), &half_b = b.half_sizes(), &p_AB = X_AB.translation;
  const Mat3& R_AB = X_AB.rotation;
  if (boxes_apart(half_a, half_b, R_AB, p_AB)) return VolumeMetrics{};
  if (half_a.minCoeff() <= 0.0 || half_b.minCoeff() <= 0.0) return VolumeMetrics{};
  const AlignedBox planes{half_a, nearest_in(a.bounds(), p_AB)};
  const PosedBox box{half_b, R_AB, p_AB - planes.origin};
  const double rounding = rounding_at(box.center.cwiseAbs().sum() + half_b.sum());
  if (lies_in(half_b, half_a, R_AB, p_AB)) {
    return whole(b.own_metrics(), X_AB, surface_of(b), false, rounding);
  }
  const Mat3 R_BA = R_AB.transpose();
  if (lies_in(half_a, half_b, R_BA, R_BA * p_AB)) {
    return whole(a.own_metrics(), Pose{}, surface_of(a), true, rounding);
  }
  // The box that fewer planes of the other one cut is begun with, unless it is so large that its
  // corners lose digits.
  if (half_a.sum() < half_b.sum()) {
    const Excess of_a(half_a, R_BA, -(R_BA * p_AB), half_b), of_b(half_b, R_AB, p_AB, half_a);
    if (of_a.count(rounding) < of_b.count(rounding)) {
      start(planes, scratch);
      const double of_corners = rounding + rounding_at(planes.origin.cwiseAbs().sum());
      if (!cut(box, of_a, of_corners, scratch.polytope)) return VolumeMetrics{};
      return Region(planes, box, of_corners, scratch).measure(planes.origin);
    }
  }
  return clip_solids(planes, box, box.center, rounding, scratch);
}

VolumeMetrics clip(const Box& a, const ConvexPolytope& b, const Pose& X_AB, ClipScratch& scratch) {
  const Aabb bounds = b.bounds();
  const Vec3 p_AM = X_AB * bounds.center(), half_b = bounds.half_sizes();
  if (boxes_apart(a.half_sizes(), half_b, X_AB.rotation, p_AM)) return VolumeMetrics{};
  if (a.half_sizes().minCoeff() <= 0.0) return VolumeMetrics{};
  const AlignedBox planes{a.half_sizes(), nearest_in(a.bounds(), p_AM)};
  const PosedPolytope polytope{b, X_AB.rotation, X_AB.translation - planes.origin};
  const double rounding = rounding_at((p_AM - planes.origin).cwiseAbs().sum() +
                                      bounds.center().cwiseAbs().sum() + half_b.sum());
  return clip_solids(planes, polytope, p_AM - planes.origin, rounding, scratch);
}

VolumeMetrics clip(const ConvexPolytope& a, const ConvexPolytope& b, const Pose& X_AB,
                   ClipScratch& scratch) {
  const Aabb bounds_a = a.bounds(), bounds_b = b.bounds();
  const Vec3 half_a = bounds_a.half_sizes(), half_b = bounds_b.half_sizes();
  const Vec3 p_AM = X_AB * bounds_b.center();
  if (boxes_apart(half_a, half_b, X_AB.rotation, p_AM - bounds_a.center())) return VolumeMetrics{};
  const AlignedPolytope planes{a, nearest_in(bounds_a, p_AM)};
  const PosedPolytope polytope{b, X_AB.rotation, X_AB.translation - planes.origin};
  const double rounding =
      rounding_at((p_AM - planes.origin).cwiseAbs().sum() + bounds_b.center().cwiseAbs().sum() +
                  half_b.sum() + bounds_a.center().cwiseAbs().sum() + half_a.sum());
  return clip_solids(planes, polytope, p_AM - planes.origin, rounding, scratch);
}

}  // namespace volcontact
