// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/pressure_field.h"

#include <type_traits>

#include "volcontact/pair/pressure_cells.h"
#include "volcontact/pair/pressure_columns.h"
#include "volcontact/pair/pressure_layers.h"
#include "volcontact/shape/parallel_solid.h"

namespace volcontact {
namespace {

template <typename S>
constexpr bool is_half_space = std::is_same_v<S, HalfSpace>;
template <typename S>
constexpr bool is_flat = std::is_same_v<S, Box> || std::is_same_v<S, ConvexPolytope>;
template <typename S>
constexpr bool is_ellipsoid = std::is_same_v<S, Ellipsoid>;

enum class Method { kNone, kPlane, kCells, kColumns, kLayers };

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
        return layers ? Method::kLayers : Method::kNone;
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

std::string why_no_pressure_field(const Shape& a, const Shape& b, Engine engine) {
  switch (method_of(a, b)) {
    case Method::kNone:
      return "neither has layers: at least one must be a half-space, sphere, capsule, cylinder, "
             "frustum, box or torus, or composed of these";
    case Method::kLayers:
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
                             const PressureSite& site, PressureScratch& scratch) noexcept {
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
    case Method::kNone:
      break;
  }
  return {};
}

}  // namespace volcontact
