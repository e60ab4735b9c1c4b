// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/nearest_face.h"

namespace volcontact {

FaceReach nearest_face(const Aabb& a, const SurfaceView& b, const Pose& X_BA, double margin,
                       ColumnPrism& prism, Pose& X_BC) {
  const std::vector<SurfacePlane>& planes = *b.planes;
  const Vec3 middle = X_BA * a.center(), half = a.half_sizes();
  const SurfacePlane* face = nullptr;
  double highest = -kInfinity, reach = 0.0;
  for (const SurfacePlane& plane : planes) {
    const double here = half.dot((X_BA.rotation.transpose() * plane.normal).cwiseAbs());
    const double low = plane.normal.dot(middle) - here - plane.offset;
    if (low > highest) highest = low, reach = here, face = &plane;
  }
  if (highest >= 0.0) return FaceReach::kApart;
  if (highest + 2.0 * reach <= 0.0) return FaceReach::kWhole;
  X_BC = {basis_with_z(face->normal), face->offset * face->normal};
  const Pose X_CB = X_BC.inverse();
  prism.margin = margin;
  prism.sides.clear();
  for (const SurfacePlane& plane : planes) {
    if (&plane == face) continue;
    const Vec3 normal = X_CB.rotation * plane.normal;
    prism.sides.push_back({normal, plane.offset - plane.normal.dot(X_BC.translation)});
  }
  const Vec3 center = X_CB * b.bounds.center(),
             size = X_CB.rotation.cwiseAbs() * b.bounds.half_sizes() + Vec3::Constant(2.0 * margin);
  prism.bounds = {center - size, center + size};
  return FaceReach::kPart;
}

}  // namespace volcontact
