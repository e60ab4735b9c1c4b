// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/base/types.h"
#include "volcontact/force/law_state.h"

namespace volcontact {

/// All a friction law knows of a contact site. Vectors are in the world frame.
struct FrictionInput {
  double normal_force = 0.0;     ///< f_n >= 0 [N]
  Vec3 normal = Vec3::UnitZ();   ///< on A, from B to A, unit
  Vec3 slip = Vec3::Zero();      ///< tangential velocity of A against B at the centroid [m/s]
  double spin = 0.0;             ///< angular velocity of A against B about the normal [rad/s]
  double gyration_radius = 0.0;  ///< r_g = sqrt(J_nn / V) of the patch [m]
};

struct FrictionOutput {
  Vec3 force = Vec3::Zero();    ///< on A, tangential [N]
  double torque = 0.0;          ///< on A, about the normal [N m]
  double slide_power = 0.0;     ///< dissipated by sliding, >= 0 [W]
  double spin_power = 0.0;      ///< dissipated by spinning, >= 0 [W]
  double elastic_energy = 0.0;  ///< stored in tangential deflection [J]
};

/// Force that resists sliding and spinning. Const once made; what lasts is in LawState.
class Friction {
 public:
  virtual ~Friction() = default;
  virtual const char* name() const noexcept = 0;
  /// Doubles of state per contact site.
  virtual int state_size() const noexcept { return 0; }
  virtual FrictionOutput evaluate(const FrictionInput& in,
                                  const LawState& state) const noexcept = 0;
};

}  // namespace volcontact
