// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/pressure/pressure_field.h"

#include <type_traits>

#include "volcontact/pair/pressure/pressure_cells.h"
#include "volcontact/pair/pressure/pressure_columns.h"
#include "volcontact/pair/pressure/pressure_ellipsoid.h"
#include "volcontact/pair/pressure/pressure_faces.h"
#include "volcontact/pair/pressure/pressure_layers.h"
#include "volcontact/pair/pressure/pressure_meshes.h"
#include "volcontact/shape/parallel_solid.h"

namespace volcontact {
namespace {

template <typename S>
constexpr bool is_half_space = std::is_same_v<S, HalfSpace>;
template <typename S>
constexpr bool is_flat = std::is_same_v<S, Box> || std::is_same_v<S, ConvexPolytope>;
template <typename S>
constexpr bool is_polytope = std::is_same_v<S, ConvexPolytope>;
template <typename S>
constexpr bool is_mesh = std::is_same_v<S, Mesh>;
template <typename S>
constexpr bool is_ellipsoid = std::is_same_v<S, Ellipsoid>;

enum class Method { kNone, kPlane, kCells, kColumns, kLayers, kFaces, kEllipsoid, kMeshes };

Method method_of(const Shape& a, const Shape& b) {
  return std::visit(
      [&](const auto& solid_a, const auto& solid_b) {
        using A = std::decay_t<decltype(solid_a)>;
        using B = std::decay_t<decltype(solid_b)>;
        if constexpr (is_half_space<A> && is_half_space<B>) return Method::kNone;
        if constexpr (is_half_space<A> || is_half_space<B>) return Method::kPlane;
        if constexpr (is_flat<A> && is_flat<B>) return Method::kCells;
        if constexpr (is_ellipsoid<A> && is_ellipsoid<B>) return Method::kColumns;
        const bool layers = has_parallel_solids(a) || has_parallel_solids(b) ||
                            has_composed_parallels(a) || has_composed_parallels(b);
        if (layers) return Method::kLayers;
        if constexpr (is_polytope<A> || is_polytope<B>) return Method::kFaces;
        if constexpr (is_ellipsoid<A> && is_mesh<B>) return Method::kEllipsoid;
        if constexpr (is_mesh<A> && is_ellipsoid<B>) return Method::kEllipsoid;
        if constexpr (is_mesh<A> || is_mesh<B>) return Method::kMeshes;
        return Method::kNone;
      },
      a, b);
}

// Depth below a plane: Archimedes. `up` is its normal, out of the half-space.
PressureField below_plane(const Vec3& up, const Vec3& point, const VolumeMetrics& site,
                          bool half_space_is_a) {
  PressureField field;
  field.energy = site.volume * up.dot(point - site.centroid);
  field.force = (half_space_is_a ? -site.volume : site.volume) * up;
  return field;
}

PressureField on_plane(const Shape& a, const Pose& X_AB, const VolumeMetrics& site) {
  if (std::holds_alternative<HalfSpace>(a)) {
    return below_plane(Vec3::UnitZ(), Vec3::Zero(), site, true);
  }
  return below_plane(X_AB.rotation.col(2), X_AB.translation, site, false);
}

PressureField in_cells(const Shape& a, const Shape& b, const Pose& X_AB, const PressureSite& site,
                       PressureScratch& scratch) {
  return std::visit(
      [&](const auto& solid_a, const auto& solid_b) -> PressureField {
        using A = std::decay_t<decltype(solid_a)>;
        using B = std::decay_t<decltype(solid_b)>;
        if constexpr (is_flat<A> && is_flat<B>) {
          return pressure_cells(solid_a, solid_b, X_AB, site.metrics().centroid, site.share_of_a,
                                scratch);
        }
        return {};
      },
      a, b);
}

}  // namespace

const std::vector<FaceCell>& PressureScratch::cells_of(const ConvexPolytope& solid) {
  for (const CellsOf& known : cells) {
    if (&known.solid.faces() == &solid.faces()) return known.cells;  // the same data block
  }
  return cells.emplace_back(CellsOf{solid, make_face_cells(solid)}).cells;
}

std::size_t PressureSite::nearest(const Vec3& place) const {
  std::size_t nearest = 0;
  double least = kInfinity;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const Mat3 spread = sites[i].second_moment() / sites[i].volume;
    const Mat3 widened = spread + 1e-6 * spread.trace() * Mat3::Identity();
    const Vec3 offset = place - sites[i].centroid;
    const double distance = offset.dot(widened.inverse() * offset);
    if (distance < least) least = distance, nearest = i;
  }
  return nearest;
}

PressureField field_on_a(const PressureField& on_carrier, const Pose& X_AC, bool is_a,
                         const Vec3& centroid_A) {
  const Vec3 middle_C = X_AC.inverse() * centroid_A;
  PressureField field = on_carrier;
  field.force = X_AC.rotation * on_carrier.force;
  field.couple = X_AC.rotation * (on_carrier.couple - middle_C.cross(on_carrier.force));
  if (!is_a) field.force = -field.force, field.couple = -field.couple;
  return field;
}

std::string why_no_pressure_field(const Shape& a, const Shape& b, Engine engine) {
  switch (method_of(a, b)) {
    case Method::kNone:
      return "neither has layers, and neither is a mesh or polytope: at least one must be, or a "
             "half-space, sphere, capsule, cylinder, frustum, box or torus, or composed of these";
    case Method::kLayers:
    case Method::kFaces:
    case Method::kMeshes:
      if (engine == Engine::kAuto && engine_for(a, b) == Engine::kOctree) {
        return "only the octree serves it, which takes about a second for each evaluation; choose "
               "the engine octree to have it nevertheless";
      }
      return {};
    default:
      return {};
  }
}

PressureField pressure_field(const Shape& a, const Shape& b, const Pose& X_AB,
                             const PressureSite& site, PressureScratch& scratch) {
  if (!site.metrics().touching()) return {};
  switch (method_of(a, b)) {
    case Method::kPlane:
      return on_plane(a, X_AB, site.metrics());
    case Method::kCells:
      return in_cells(a, b, X_AB, site, scratch);
    case Method::kColumns:
      return pressure_columns(std::get<Ellipsoid>(a), std::get<Ellipsoid>(b), X_AB, site.metrics(),
                              site.share_of_a);
    case Method::kLayers:
      return pressure_layers(a, b, X_AB, site, scratch);
    case Method::kFaces:
      return pressure_faces(a, b, X_AB, site, scratch);
    case Method::kEllipsoid:
      return pressure_ellipsoid(a, b, X_AB, site, scratch);
    case Method::kMeshes:
      return pressure_meshes(a, b, X_AB, site, scratch);
    case Method::kNone:
      break;
  }
  return {};
}

}  // namespace volcontact
