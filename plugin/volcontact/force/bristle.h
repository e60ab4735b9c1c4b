// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "volcontact/base/fields.h"
#include "volcontact/force/coupling.h"
#include "volcontact/force/friction.h"
#include "volcontact/force/material_rule.h"

namespace volcontact {

/// Friction of elastic bristles with seven parameters, Gonthier et al. 2004: true sticking,
/// stiction that grows with the time of rest, and the Stribeck effect. Its slip, deflection and
/// force are 3-vectors: two components in the contact plane and one of the spin, scaled by the
/// patch's radius of gyration. docs/theory.md, "Bristles". Throws std::invalid_argument on values
/// out of range and on static_friction below friction.
class Bristle final : public Friction {
 public:
  static constexpr const char* kName = "bristle";
  struct Params {
    double friction = 0.2;
    double static_friction = 0.2;
    double bristle_stiffness = 1e5;
    double bristle_damping = 500.0;
    double viscous_friction = 0.0;
    double stribeck_speed = 1e-2;
    double dwell_time = 0.1;
    Coupling coupling = Coupling::kEllipsoid;
  };
  static constexpr std::array kFields{
      Field<Params>{"friction", "-", &Params::friction, kNonNegative, "mu_C, kinetic",
                    &rules::kFriction},
      Field<Params>{"static_friction", "-", &Params::static_friction, kNonNegative,
                    "mu_S, after a long rest; at least mu_C", &rules::kStaticFriction},
      Field<Params>{"bristle_stiffness", "N/m", &Params::bristle_stiffness, kPositive,
                    "sigma_0, tangential stiffness of a contact site", &rules::kLargerOfTwo},
      Field<Params>{"bristle_damping", "N s/m", &Params::bristle_damping, kPositive,
                    "sigma_1, damping of the deflection", &rules::kLargerOfTwo},
      Field<Params>{"viscous_friction", "N s/m", &Params::viscous_friction, kNonNegative,
                    "sigma_2, viscous friction per slip speed", &rules::kLargerOfTwo},
      Field<Params>{"stribeck_speed", "m/s", &Params::stribeck_speed, kPositive,
                    "v_s, where sticking gives way to sliding", &rules::kLargerOfTwo},
      Field<Params>{"dwell_time", "s", &Params::dwell_time, kPositive,
                    "tau_dw, time constant with which friction at rest grows to mu_S",
                    &rules::kLargerOfTwo}};
  static constexpr std::array kChoices{
      Choice<Params, Coupling, 3>{"coupling", &Params::coupling, kCouplingWords, kCouplingMeaning}};
  static constexpr std::array kStates{
      StateField{"deflection", "m", Keeping::kVector, "of the bristles along the plane"},
      StateField{"twist", "m", Keeping::kAmount, "deflection of the spin, at the radius r_g"},
      StateField{"dwell", "-", Keeping::kValue, "how much of the rise to mu_S is there, 0 to 1"}};

  explicit Bristle(const Params& params);
  const Params& params() const { return p_; }
  const char* name() const noexcept override { return kName; }
  std::span<const StateField> states() const noexcept override { return kStates; }

  FrictionOutput evaluate(const FrictionInput& in, const LawState& state) const noexcept override;
  FrictionSlope slope(const FrictionInput& in, const LawState& state) const noexcept override;

 private:
  struct Sticking;
  struct Past;
  Sticking sticking_at(double speed) const noexcept;
  double relaxing() const noexcept { return p_.bristle_stiffness / p_.bristle_damping; }  // [1/s]
  Past past(const FrictionInput& in, const LawState& state) const noexcept;

  Params p_;
};

}  // namespace volcontact
