// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "volcontact/base/fields.h"
#include "volcontact/force/coupling.h"
#include "volcontact/force/friction.h"
#include "volcontact/force/material_rule.h"

namespace volcontact {

/// Coulomb's friction behind a spring and a damper, the slider of Prandtl and of Cundall and Strack
/// 1979: sticks within the cone, slides at it, never creeps. The spring is that of the patch, a
/// share of its normal stiffness; the damper is critical for the bodies' mass. Slip, deflection and
/// force are 3-vectors as those of `Bristle`. docs/theory.md, "Friction". Throws
/// std::invalid_argument on values out of range.
class ElasticCoulomb final : public Friction {
 public:
  static constexpr const char* kName = "elastic_coulomb";
  struct Params {
    double friction = 0.2;
    double tangential_ratio = 0.8;
    double tangential_damping = 10.0;
    double presliding = 1e-6;
    Coupling coupling = Coupling::kEllipsoid;
  };
  static constexpr std::array kFields{
      Field<Params>{"friction", "-", &Params::friction, kNonNegative, "mu", &rules::kFriction},
      Field<Params>{"tangential_ratio", "-", &Params::tangential_ratio, kPositive,
                    "k_t/k_n, tangential over normal stiffness of a patch", &rules::kLargerOfTwo},
      Field<Params>{"tangential_damping", "-", &Params::tangential_damping, kNonNegative,
                    "zeta, damping ratio of sticking (1: critical for a ball)",
                    &rules::kLargerOfTwo},
      Field<Params>{"presliding", "m", &Params::presliding, kNonNegative,
                    "smallest deflection at which a patch begins to slide", &rules::kLargerOfTwo}};
  static constexpr std::array kChoices{
      Choice<Params, Coupling, 3>{"coupling", &Params::coupling, kCouplingWords, kCouplingMeaning}};
  static constexpr std::array kStates{
      StateField{"deflection", "m", Keeping::kVectorValue, "of the spring along the plane"},
      StateField{"twist", "m", Keeping::kValue, "deflection of the spin, at the radius r_g"},
      StateField{"stiffness", "N/m", Keeping::kAmount, "k_t, the largest since it last slid"},
      StateField{"strength", "N", Keeping::kAmount, "most that it could hold since then"}};

  explicit ElasticCoulomb(const Params& params) : p_(validated<ElasticCoulomb>(params)) {}
  const Params& params() const { return p_; }
  const char* name() const noexcept override { return kName; }
  std::span<const StateField> states() const noexcept override { return kStates; }

  FrictionOutput evaluate(const FrictionInput& in, const LawState& state) const noexcept override;
  FrictionSlope slope(const FrictionInput& in, const LawState& state) const noexcept override;

 private:
  double stiffness(const FrictionInput& in) const noexcept;                  // k_t [N/m]
  double damping(const FrictionInput& in, double stiffness) const noexcept;  // [N s/m]
  struct Spring;
  Spring spring(const FrictionInput& in, const LawState& state, double now) const noexcept;

  Params p_;
};

}  // namespace volcontact
