// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/pressure_field.h"

#include <type_traits>

#include "volcontact/pair/pressure_cells.h"
#include "volcontact/pair/pressure_columns.h"

namespace volcontact {
namespace {

template <typename S>
constexpr bool is_half_space = std::is_same_v<S, HalfSpace>;
// Round everywhere: depth and columns are smooth enough for a fixed rule.
template <typename S>
constexpr bool is_smooth =
    std::is_same_v<S, Sphere> || std::is_same_v<S, Ellipsoid> || std::is_same_v<S, Capsule>;
template <typename S>
constexpr bool is_flat = std::is_same_v<S, Box> || std::is_same_v<S, ConvexPolytope>;

// Depth below a plane: Archimedes. `up` is its normal, out of the half-space.
PressureField below_plane(const Vec3& up, const Vec3& point, const VolumeMetrics& site,
                          bool half_space_is_a) {
  PressureField field;
  field.energy = site.volume * up.dot(point - site.centroid);
  field.force = (half_space_is_a ? -site.volume : site.volume) * up;
  return field;
}

template <typename A, typename B>
PressureField field_of(const A& a, const B& b, const Pose& X_AB, const VolumeMetrics& site,
                       double share_of_a, PressureScratch& scratch) {
  if constexpr (is_half_space<A> && is_half_space<B>) {
    return {};
  } else if constexpr (is_half_space<A>) {
    return below_plane(Vec3::UnitZ(), Vec3::Zero(), site, true);
  } else if constexpr (is_half_space<B>) {
    return below_plane(X_AB.rotation.col(2), X_AB.translation, site, false);
  } else if constexpr (is_flat<A> && is_flat<B>) {
    return pressure_cells(a, b, X_AB, site.centroid, share_of_a, scratch);
  } else if constexpr (is_smooth<A> && is_smooth<B>) {
    return pressure_columns(LayerView(a), LayerView(b), X_AB, site, share_of_a);
  } else {
    return {};
  }
}

}  // namespace

bool has_pressure_field(const Shape& a, const Shape& b) {
  return std::visit(
      [](const auto& solid_a, const auto& solid_b) {
        using A = std::decay_t<decltype(solid_a)>;
        using B = std::decay_t<decltype(solid_b)>;
        if constexpr (is_half_space<A> || is_half_space<B>) {
          return !(is_half_space<A> && is_half_space<B>);
        } else {
          return (is_flat<A> && is_flat<B>) || (is_smooth<A> && is_smooth<B>);
        }
      },
      a, b);
}

PressureField pressure_field(const Shape& a, const Shape& b, const Pose& X_AB,
                             const VolumeMetrics& site, double share_of_a,
                             PressureScratch& scratch) noexcept {
  if (!site.touching()) return {};
  return std::visit(
      [&](const auto& solid_a, const auto& solid_b) {
        return field_of(solid_a, solid_b, X_AB, site, share_of_a, scratch);
      },
      a, b);
}

}  // namespace volcontact
