// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/pressure/pressure_faces.h"

#include <algorithm>

namespace volcontact {
namespace {

constexpr double kTolerance = 1e-8;  // asked of lines; columns of meshes are exact

// Bounds of a solid in another frame.
Aabb bounds_in(const Shape& solid, const Pose& X) {
  const Aabb own = bounds_of(solid);
  const Vec3 middle = X * own.center(), reach = X.rotation.cwiseAbs() * own.half_sizes();
  return {middle - reach, middle + reach};
}

bool apart(const Aabb& a, const Aabb& b) { return a.min.exceeds(b.max) || b.min.exceeds(a.max); }

}  // namespace

PressureField pressure_faces(const Shape& a, const Shape& b, const Pose& X_AB,
                             const PressureSite& site, PressureScratch& scratch) {
  if (!scratch.engines) scratch.engines = std::make_unique<InterferenceWorkspace>();
  const bool a_carries = std::holds_alternative<ConvexPolytope>(a);
  const Shape& rigid = a_carries ? b : a;
  const ConvexPolytope& carrier = std::get<ConvexPolytope>(a_carries ? a : b);
  const Pose X_CR = a_carries ? X_AB : X_AB.inverse();  // of the rigid one in the carrier
  const Pose X_AC = a_carries ? Pose{} : X_AB;
  const Aabb reach = bounds_in(rigid, X_CR);
  InterferenceOptions options = site.options;
  options.tolerance = std::min(options.tolerance, kTolerance);

  PressureField field;  // on the carrier, in its frame; the couple about its origin
  for (const FaceCell& cell : scratch.cells_of(carrier)) {
    if (apart(cell.solid.bounds(), reach)) continue;
    scratch.inner_a = cell.solid;
    interference(scratch.inner_a, rigid, X_CR, options, *scratch.engines, scratch.level);
    const ConvexPolytope::Face& face = carrier.faces()[static_cast<std::size_t>(cell.face)];
    const auto add = [&](const VolumeMetrics& part) {
      field.energy += part.volume * (face.offset - face.normal.dot(part.centroid));
      const Vec3 force = -part.volume * face.normal;
      field.force += force;
      field.couple += part.centroid.cross(force);
    };
    if (site.sites.size() < 2) {
      if (scratch.level.total.touching()) add(scratch.level.total);
      continue;
    }
    for (const VolumeMetrics& part : scratch.level.sites) {
      if (site.nearest(X_AC * part.centroid) == site.index) add(part);
    }
  }
  return field_on_a(field, X_AC, a_carries, site.metrics().centroid);
}

}  // namespace volcontact
