// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

#include "volcontact/base/types.h"
#include "volcontact/force/patch.h"

namespace volcontact {

/// How sliding and spinning share one patch's friction (the Contensou effect).
enum class Coupling : int {
  kEllipsoid = 0,   ///< friction acts on (v_x, v_y, r_g w_n): sliding and spin weaken each other
  kQuadrature = 1,  ///< Coulomb friction integrated over the patch
  kNone = 2,        ///< plain Coulomb force at the centroid, no spin torque
};
inline constexpr std::array<const char*, 3> kCouplingWords{"ellipsoid", "quadrature", "none"};
inline constexpr const char* kCouplingMeaning = "how sliding and spinning share the friction";

/// Generalised slip of a patch: the speed on which the friction law acts and, per unit of friction
/// force, the force vector and the spin torque. docs/theory.md, "Coupling of sliding and spin".
struct GeneralizedSlip {
  double speed = 0.0;                   ///< sqrt(|v|^2 + (r_g w)^2) [m/s]
  Vec3 force_direction = Vec3::Zero();  ///< against v, at most 1 long [-]
  double torque_arm = 0.0;              ///< against w, at most r_g long [m]
};

/// Coulomb friction of unit strength integrated over the patch: an ellipse with the second moments
/// of the volume, whose pressure is a mixture of the uniform one and the paraboloid that has the
/// patch's area. Exact for a disc under uniform pressure and for the shallow cap of a ball.
GeneralizedSlip integrated_slip(const Vec3& slip, double spin, const Vec3& normal,
                                const Patch& patch) noexcept;

inline GeneralizedSlip generalized_slip(Coupling coupling, const Vec3& slip, double spin,
                                        const Vec3& normal, const Patch& patch) noexcept {
  if (coupling == Coupling::kQuadrature) return integrated_slip(slip, spin, normal, patch);
  const double r = coupling == Coupling::kEllipsoid ? patch.gyration_radius : 0.0;
  const double speed = std::sqrt(slip.squaredNorm() + r * r * spin * spin);
  if (!(speed > 0.0)) return {};
  return {speed, -slip / speed, -r * r * spin / speed};
}

}  // namespace volcontact
