// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/base/types.h"
#include "volcontact/force/law_state.h"
#include "volcontact/force/patch.h"

namespace volcontact {

/// All a friction law knows of a contact site. Vectors are in the world frame.
struct FrictionInput {
  double normal_force = 0.0;    ///< f_n >= 0 [N]
  Vec3 normal = Vec3::UnitZ();  ///< on A, from B to A, unit
  Vec3 slip = Vec3::Zero();     ///< tangential velocity of A against B at the centroid [m/s]
  double spin = 0.0;            ///< angular velocity of A against B about the normal [rad/s]
  Vec3 travel = Vec3::Zero();   ///< way of A against B along the patch since the committed time [m]
  double turn = 0.0;            ///< angle of A against B about the normal since then [rad]
  Patch patch;                  ///< what carries the normal force
  double normal_stiffness = 0.0;  ///< elastic part of the normal force per depth V/|S| [N/m]
  double mass = 0.0;              ///< reduced mass of the two bodies, 0 where not known [kg]
};

struct FrictionOutput {
  Vec3 force = Vec3::Zero();  ///< on A, tangential [N]
  double torque = 0.0;        ///< on A, about the normal [N m]
  double slide_energy = 0.0;  ///< stored in tangential deflection [J]
  double spin_energy = 0.0;   ///< stored in twist [J]
  double slide_power = 0.0;   ///< dissipated by sliding: work done against friction less what is
                              ///< being stored [W]
  double spin_power = 0.0;    ///< dissipated by spinning [W]
};

/// Friction as a step sees it that is implicit in the contact. All three act on the 3-vector of
/// the slip (v_x, v_y, r w_n) with r the lever of the spin: docs/theory.md, "Implicit step".
struct FrictionSlope {
  double stiffness = 0.0;  ///< per way along the patch, while it holds [N/m]
  double damping = 0.0;    ///< per slip: the force that grows with the slip, over the slip [N s/m]
  double strength = 0.0;   ///< most it can hold under this normal force [N]
  double lever = 0.0;      ///< r, by which a spin is a slip; 0 for no torque [m]
  double viscous = 0.0;    ///< the part of the damping that a slip beyond `strength` has [N s/m]
};

/// Force that resists sliding and spinning. Const once made; what lasts is in LawState.
class Friction {
 public:
  virtual ~Friction() = default;
  virtual const char* name() const noexcept = 0;
  /// What the law keeps for each contact site; a law that keeps nothing needs no override.
  virtual std::span<const StateField> states() const noexcept { return {}; }
  virtual FrictionOutput evaluate(const FrictionInput& in,
                                  const LawState& state) const noexcept = 0;

  /// What a step needs that is implicit in the contact. By default from differences of `evaluate`:
  /// stiffness where the law keeps something; damping as force over slip; strength as the force
  /// at the present slip, or at 1 m/s where that is more, with a memory after 1 m of it.
  /// `state.pending` stays, or is left as `evaluate` at `in` leaves it.
  virtual FrictionSlope slope(const FrictionInput& in, const LawState& state) const noexcept;

  int state_size() const noexcept { return size_of(states()); }
};

}  // namespace volcontact
