// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/force/law_state.h"

namespace volcontact {

/// All a normal law knows of a contact site: scalars, no shape, no pose.
struct NormalInput {
  double volume = 0.0;          ///< V [m^3]
  double depth_moment = 0.0;    ///< int L^2/2 dA [m^4]
  double approach_speed = 0.0;  ///< v_n at the centroid, > 0 while approaching [m/s]
  double mass = 0.0;            ///< reduced mass of the two bodies, 0 where not known [kg]
};

struct NormalOutput {
  double magnitude = 0.0;       ///< f_n >= 0 [N]
  double elastic = 0.0;         ///< the part of f_n that is stored, >= 0 [N]
  double elastic_energy = 0.0;  ///< [J]
  /// Torque per rolling speed and second moment of the volume, k_v a [N s/m^4].
  double rolling_damping = 0.0;
};

/// How a normal force changes with what it depends on; what would be negative is 0.
struct NormalSlope {
  double stiffness = 0.0;  ///< df/dV [N/m^3]
  double damping = 0.0;    ///< df/dv_n [N s/m]
};

/// Magnitude of the force that keeps two bodies apart. Const once made; what lasts is in LawState.
class NormalForce {
 public:
  virtual ~NormalForce() = default;
  virtual const char* name() const noexcept = 0;
  /// What the law keeps for each contact site; a law that keeps nothing needs no override.
  virtual std::span<const StateField> states() const noexcept { return {}; }
  virtual NormalOutput evaluate(const NormalInput& in, const LawState& state) const noexcept = 0;

  /// The derivatives at `in`, for steps that are implicit in the contact. By default from
  /// differences of `evaluate`, at a fixed depth moment. `state.pending` is left as `evaluate` at
  /// `in` leaves it.
  virtual NormalSlope slope(const NormalInput& in, const LawState& state) const noexcept;

  int state_size() const noexcept { return size_of(states()); }
};

}  // namespace volcontact
