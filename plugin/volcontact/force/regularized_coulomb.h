// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "volcontact/base/fields.h"
#include "volcontact/force/coupling.h"
#include "volcontact/force/friction.h"
#include "volcontact/force/material_rule.h"

namespace volcontact {

/// Coulomb friction whose corner at rest is rounded: full strength mu f_n from `slip_speed` on, a
/// cubic through zero below it. It creeps under load, by construction; use it for comparison.
/// docs/theory.md, "Friction". Throws std::invalid_argument on values out of range.
class RegularizedCoulomb final : public Friction {
 public:
  static constexpr const char* kName = "regularized_coulomb";
  struct Params {
    double friction = 0.2;
    double slip_speed = 1e-3;
    Coupling coupling = Coupling::kEllipsoid;
  };
  static constexpr std::array kFields{
      Field<Params>{"friction", "-", &Params::friction, kNonNegative, "mu, kinetic",
                    &rules::kFriction},
      Field<Params>{"slip_speed", "m/s", &Params::slip_speed, kPositive,
                    "slip speed above which friction has its full strength", &rules::kLargerOfTwo}};
  static constexpr std::array kChoices{
      Choice<Params, Coupling, 3>{"coupling", &Params::coupling, kCouplingWords, kCouplingMeaning}};

  explicit RegularizedCoulomb(const Params& params) : p_(validated<RegularizedCoulomb>(params)) {}
  const Params& params() const { return p_; }
  const char* name() const noexcept override { return kName; }

  FrictionOutput evaluate(const FrictionInput& in, const LawState&) const noexcept override {
    const GeneralizedSlip slip =
        generalized_slip(p_.coupling, in.slip, in.spin, in.normal, in.patch);
    const double strength = p_.friction * in.normal_force * rounded(slip.speed / p_.slip_speed);
    FrictionOutput out;
    out.force = strength * slip.force_direction;
    out.torque = strength * slip.torque_arm;
    out.slide_power = -out.force.dot(in.slip);
    out.spin_power = -out.torque * in.spin;
    return out;
  }
  FrictionSlope slope(const FrictionInput& in, const LawState&) const noexcept override {
    const double lever = p_.coupling == Coupling::kNone ? 0.0 : in.patch.gyration_radius;
    const double speed = std::hypot(in.slip.norm(), lever * in.spin);
    const double strength = p_.friction * in.normal_force;
    const double x = speed / p_.slip_speed;
    return {0.0, x >= 1.0 ? strength / speed : strength * (1.5 - 0.5 * x * x) / p_.slip_speed,
            strength, lever};
  }

 private:
  // 0 at 0, 1 with zero slope from 1 on (Gonthier et al. 2004, direction regularisation).
  static double rounded(double x) { return x >= 1.0 ? 1.0 : x * (1.5 - 0.5 * x * x); }

  Params p_;
};

}  // namespace volcontact
