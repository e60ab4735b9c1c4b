// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adaptor/mujoco/mujoco_compat.h"
#include "adaptor/step/step_metric.h"
#include "volcontact/step/mechanism.h"

namespace volcontact::adaptor {

/// How the bodies of a model hang on its degrees of freedom.
MechanismTrees trees_of(const mjModel* m);

/// Change of speed by gravity in a step [m/s].
double fall_of(const mjModel* m);

/// The bodies of a model at the positions and velocities that are current in its data.
class MujocoMechanism final : public Mechanism {
 public:
  /// Overwrites mjData.qDeriv, as the integrator will. `of_model`: its trees, and `metric`, which
  /// stay.
  MujocoMechanism(const mjModel* m, mjData* d, const MechanismTrees& of_model,
                  const StepMetric& metric);

  void mass(int dof, double* row) const override;
  void damping(std::span<const int> dofs, std::vector<DofEntry>& out) const override;
  bool constraints_see_damping() const override { return solves_with_step_matrix(m_); }

 private:
  void dampen(int dof, std::vector<DofEntry>& out) const;
  void fly(int dof, std::vector<DofEntry>& out) const;

  const mjModel* m_;
  const mjData* d_;
  const StepMetric& metric_;
  Damping damping_;
};

/// All that acts on the degrees of freedom beside the contacts and MuJoCo's constraints, nv
/// numbers: passive forces so far, bias, actuators at the present state, and what the user applied,
/// given as `user_qfrc` (nv) and `user_xfrc` (6 nbody).
void known_forces(const mjModel* m, mjData* d, const double* user_qfrc, const double* user_xfrc,
                  std::vector<double>& out);

}  // namespace volcontact::adaptor
