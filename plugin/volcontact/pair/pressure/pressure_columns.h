// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/pressure/pressure_field.h"
#include "volcontact/shape/ellipsoid.h"

namespace volcontact {

/// Depth below the surface of a solid and its gradient, at a point inside.
struct Depth {
  double value;
  Vec3 gradient;
};

/// The signed distance of an ellipsoid is a bound, with the root d of d^2/s^2 + 2 m d = 1 - f^2,
/// f = |x/a|, m = |x/a^2|, s the shortest semi-axis. It has the slope 1 on the surface only.
Depth depth_in(const Ellipsoid& solid, const Vec3& x);

/// Pressure field of two ellipsoids, which have no parallel ellipsoids, by a fixed rule over
/// columns along the normal, exact at their ends. In A's frame.
PressureField pressure_columns(const Ellipsoid& a, const Ellipsoid& b, const Pose& X_AB,
                               const VolumeMetrics& site, double share_of_a);

}  // namespace volcontact
