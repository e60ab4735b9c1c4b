// SPDX-License-Identifier: Apache-2.0

// A half-space below the plane z = 0 needs no graph: each face of the solid is cut on its own. Two
// faces cut their common edge by the same operations, so that the surface stays closed bit for bit,
// and the lid on the plane follows from that.
#include <algorithm>
#include <limits>
#include <span>

#include "volcontact/pair/box_faces.h"
#include "volcontact/pair/clip.h"
#include "volcontact/pair/region_sum.h"

namespace volcontact {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// The point of an edge on the plane; `below` and `above` are its ends, in this order in either
// face.
Vec3 on_plane(const Vec3& below, const Vec3& above) {
  const double t = below.z() / (below.z() - above.z());
  Vec3 p = below + t * (above - below);
  p.z() = 0.0;
  return p;
}

// The part of a face at z <= 0, appended to `part`.
void cut_face(std::span<const int> loop, std::span<const Vec3> corners, std::vector<Vec3>& part) {
  part.clear();
  const Vec3* last = &corners[loop.back()];
  for (int index : loop) {
    const Vec3* p = &corners[index];
    if (last->z() > 0.0 && !(p->z() > 0.0)) part.push_back(on_plane(*p, *last));
    if (!(last->z() > 0.0) && p->z() > 0.0) part.push_back(on_plane(*last, *p));
    if (!(p->z() > 0.0)) part.push_back(*p);
    last = p;
  }
}

// Metrics of the part below z = 0 of a solid with these corners and faces, moved by `shift`.
template <typename Loop, typename Normal>
VolumeMetrics measure_below(std::span<const Vec3> corners, int faces, Loop&& loop, Normal&& normal,
                            double rounding, const Vec3& shift, std::vector<Vec3>& part) {
  RegionSum sum;
  double lowest = 0.0;
  for (const Vec3& p : corners) {
    if (p.z() < lowest) {
      lowest = p.z();
      sum.origin = Vec3(p.x(), p.y(), 0.0);
    }
  }
  for (int f = 0; f < faces; ++f) {
    cut_face(loop(f), corners, part);
    if (part.size() < 3) continue;
    const Vec3 n = normal(f);
    const FaceIntegral face = sum.add_face(
        static_cast<int>(part.size()), [&](int i) -> const Vec3& { return part[i]; }, n, 0.0);
    sum.counter_area += face.area;
    sum.area_vector -= face.area * n;
    sum.area_moment -= face.first.cross(n);
  }
  // The whole surface has S = T = 0: what the faces leave is the lid.
  sum.area = std::max(0.0, sum.area_vector.z());
  const double volume_error =
      8.0 * kEpsilon * sum.volume + 2.0 * rounding * (sum.area + sum.counter_area);
  if (!(sum.volume > volume_error)) return VolumeMetrics{};
  VolumeMetrics m = sum.metrics();
  const Vec3 moved = shift + sum.origin;
  m.centroid += moved;
  m.area_vector = Vec3(0.0, 0.0, sum.area);
  m.area_moment = Vec3(sum.area_moment.x() + moved.y() * sum.area,
                       sum.area_moment.y() - moved.x() * sum.area, 0.0);
  m.depth = -lowest;
  m.depth_moment = -sum.first.z();
  m.volume_error = volume_error;
  return m;
}

// The whole solid, below the plane.
VolumeMetrics immersed(const VolumeMetrics& own, const Pose& X_AB, double surface, double rounding,
                       double depth) {
  VolumeMetrics m = transformed(own, X_AB);
  m.counter_area = surface;
  m.depth = depth;
  m.depth_moment = -m.centroid.z() * m.volume;
  m.volume_error = 8.0 * kEpsilon * m.volume + rounding * surface;
  m.status = Status::kContained;
  return m;
}

}  // namespace

VolumeMetrics clip(const HalfSpace&, const Box& b, const Pose& X_AB,
                   ClipScratch& scratch) noexcept {
  const Vec3& half = b.half_sizes();
  const double height = X_AB.translation.z();
  const double reach = X_AB.rotation.row(2).cwiseAbs().dot(half);
  if (!(height < reach) || half.minCoeff() <= 0.0) return VolumeMetrics{};
  const double rounding = 4.0 * kEpsilon * (std::abs(height) + half.sum());
  if (height <= -reach) {
    return immersed(b.own_metrics(), X_AB, surface_of(b), rounding, 2.0 * reach);
  }
  Vec3 corners[8];
  place_corners(half, X_AB.rotation, Vec3(0.0, 0.0, height), corners);
  const auto loop = [](int f) { return std::span<const int>(kBoxLoops[f]); };
  const auto normal = [&](int f) { return box_normal(f, X_AB.rotation); };
  return measure_below(corners, 6, loop, normal, rounding,
                       Vec3(X_AB.translation.x(), X_AB.translation.y(), 0.0), scratch.part);
}

VolumeMetrics clip(const HalfSpace&, const ConvexPolytope& b, const Pose& X_AB,
                   ClipScratch& scratch) noexcept {
  const Vec3 up_B = X_AB.rotation.row(2).transpose();
  const double height = X_AB.translation.z();
  const double depth = b.support_height(-up_B) - height;
  if (!(depth > 0.0)) return VolumeMetrics{};
  const Aabb bounds = b.bounds();
  const double size = bounds.min.cwiseAbs().cwiseMax(bounds.max.cwiseAbs()).sum();
  const double rounding = 4.0 * kEpsilon * (std::abs(height) + size);
  const double top = height + b.support_height(up_B);
  if (top <= 0.0) {
    return immersed(b.own_metrics(), X_AB, b.surface_area(), rounding, depth + top);
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

}  // namespace volcontact
