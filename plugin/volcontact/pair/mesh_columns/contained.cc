// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/contained.h"

#include <algorithm>

namespace volcontact {
namespace {

// Of the rays that count how often a surface winds around a point: any will do, none of them along
// the edges that people draw.
const Vec3 kRays[] = {Vec3(0.2873, 0.5172, 0.8062), Vec3(-0.6731, 0.3418, 0.6558),
                      Vec3(0.4187, -0.8233, 0.3829), Vec3(0.7641, 0.1409, -0.6295)};

}  // namespace

int winding_around(const SurfaceView& solid, const Vec3& p, CellScratch& scratch) {
  int number = 0;
  for (const Vec3& ray : kRays) {
    const Mat3 R_CM = basis_with_z(ray.normalized()).transpose();
    if (winding(*solid.tree, {R_CM, -(R_CM * p)}, scratch, number)) break;
  }
  return number;
}

namespace {

bool holds(const Aabb& bounds, const Vec3& p) {
  return bounds.min.at_most(p) && p.at_most(bounds.max);
}

// Adds the parts of one solid that lie inside of the other; returns their surface.
double add_parts(const SurfaceView& solid, const Pose& X_AM, const SurfaceView& other,
                 const Pose& X_OM, const std::vector<int>& crossing, CellScratch& scratch,
                 MomentSum& sum) {
  double surface = 0.0;
  for (int i = 0; i < solid.part_count(); ++i) {
    if (std::binary_search(crossing.begin(), crossing.end(), i)) continue;
    const Mesh::Component part = solid.part(i);
    const Vec3 point = X_OM * part.point;
    if (!holds(other.bounds, point)) continue;
    const int around = winding_around(other, point, scratch);
    if (around == 0) continue;
    const double sign = part.cavity ? -around : around;
    const VolumeMetrics own = transformed(part.own, X_AM);
    const Vec3 first = own.volume * own.centroid;
    sum.volume += sign * own.volume;
    sum.first += sign * first;
    sum.second += sign * (own.second_moment() + outer(first, own.centroid));
    surface += around * part.surface_area;
  }
  return surface;
}

}  // namespace

VolumeMetrics contained_parts(const SurfaceView& a, const SurfaceView& b, const Pose& X_AB,
                              const std::vector<int>& crossing_a,
                              const std::vector<int>& crossing_b, CellScratch& scratch) {
  MomentSum sum;
  VolumeMetrics m;
  m.area = add_parts(a, Pose{}, b, X_AB.inverse(), crossing_a, scratch, sum);
  m.counter_area = add_parts(b, X_AB, a, X_AB, crossing_b, scratch, sum);
  m.volume = sum.volume;
  if (sum.volume != 0.0) {
    m.centroid = sum.first / sum.volume;
    const Mat3 second = sum.second - outer(m.centroid, sum.first);
    m.inertia = second.trace() * Mat3::Identity() - second;
    m.status = Status::kContained;
  }
  return m;
}

}  // namespace volcontact
