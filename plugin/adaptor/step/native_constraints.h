// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "adaptor/mujoco/mujoco_compat.h"
#include "adaptor/step/step_metric.h"
#include "volcontact/step/linear_constraints.h"

namespace volcontact::adaptor {

/// MuJoCo's own constraints in one step: joint and tendon limits, equalities, dry friction of
/// joints, native contacts. And what the integrator takes implicitly of tendons and actuators that
/// join degrees of freedom: forces that are linear in the acceleration, as of constraints.
class NativeConstraints final : public LinearConstraints {
 public:
  /// Takes the constraints that are at hand in `d`, which answers for them during the step; `ahead`
  /// of look_ahead.h, `metric` of that.
  void read(const mjModel* m, mjData* d, const mjData* ahead, const StepMetric& metric);

 private:
  void respond(std::span<const int> rows, std::span<const double> violation) override;

  void end_joining_row(const mjModel* m, double reference);
  bool is_made_stiff(int row) const;
  bool hold(int row, double violation);

  const mjModel* m_ = nullptr;
  mjData* d_ = nullptr;
  const StepMetric* metric_ = nullptr;
  int count_ = 0;  // of MuJoCo's constraints; the rows of the metric follow
  // Dry friction that is made stiff: the sign of its force at the guess before, where that was the
  // most there is, and how often it was tried whether it holds.
  struct Held {
    int side = 0;
    int trials = 0;
  };
  std::vector<Held> held_;
};

}  // namespace volcontact::adaptor
