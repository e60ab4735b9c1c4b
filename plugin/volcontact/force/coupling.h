// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "volcontact/base/types.h"

namespace volcontact {

/// How sliding and spinning share one patch's friction (the Contensou effect).
enum class Coupling : int {
  kEllipsoid = 0,  ///< friction acts on (v_x, v_y, r_g w_n): sliding and spin weaken each other
  kNone = 1,       ///< plain Coulomb force at the centroid, no spin torque
};

/// Generalised slip of a patch: the speed on which the friction law acts and, per unit of friction
/// force, the force vector and the spin torque. docs/theory.md, "Friction".
struct GeneralizedSlip {
  double speed;          ///< sqrt(|v|^2 + (r_g w)^2) [m/s]
  Vec3 force_direction;  ///< -v / speed [-]
  double torque_arm;     ///< -r_g^2 w / speed [m]
};

inline GeneralizedSlip generalized_slip(Coupling coupling, const Vec3& slip, double spin,
                                        double gyration_radius) {
  const double r = coupling == Coupling::kEllipsoid ? gyration_radius : 0.0;
  const double speed = std::sqrt(slip.squaredNorm() + r * r * spin * spin);
  if (!(speed > 0.0)) return {0.0, Vec3::Zero(), 0.0};
  return {speed, -slip / speed, -r * r * spin / speed};
}

}  // namespace volcontact
