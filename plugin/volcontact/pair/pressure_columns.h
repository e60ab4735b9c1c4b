// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/pressure_field.h"
#include "volcontact/shape/ellipsoid.h"

namespace volcontact {

/// Depth below the surface of a solid and its gradient, at a point inside.
struct Depth {
  double value;
  Vec3 gradient;
};

/// -signed_distance with its gradient, which shapes give as a direction: their signed distances
/// have the slope 1 inside.
template <typename S>
Depth depth_in(const S& solid, const Vec3& x) {
  return {-solid.signed_distance(x), -solid.gradient(x)};
}
/// The signed distance of an ellipsoid is a bound, with the root d of d^2/s^2 + 2 m d = 1 - f^2,
/// f = |x/a|, m = |x/a^2|, s the shortest semi-axis. It has the slope 1 on the surface only.
Depth depth_in(const Ellipsoid& solid, const Vec3& x);

/// A convex solid that carries a layer, through one table of functions. It refers to the solid and
/// must not outlive it.
class LayerView {
 public:
  template <typename S>
  explicit LayerView(const S& solid) : solid_(&solid), table_(&kTable<S>) {}

  RayInterval ray(const Vec3& o, const Vec3& d) const { return table_->ray(solid_, o, d); }
  Depth depth(const Vec3& x) const { return table_->depth(solid_, x); }

 private:
  struct Table {
    RayInterval (*ray)(const void*, const Vec3&, const Vec3&);
    Depth (*depth)(const void*, const Vec3&);
  };
  template <typename S>
  static constexpr Table kTable = {
      [](const void* s, const Vec3& o, const Vec3& d) {
        return static_cast<const S*>(s)->ray(o, d);
      },
      [](const void* s, const Vec3& x) { return depth_in(*static_cast<const S*>(s), x); },
  };

  const void* solid_;
  const Table* table_;
};

/// Pressure field of two convex solids by a fixed rule over columns along the normal, exact at
/// their ends. In A's frame.
PressureField pressure_columns(const LayerView& a, const LayerView& b, const Pose& X_AB,
                               const VolumeMetrics& site, double share_of_a) noexcept;

}  // namespace volcontact
