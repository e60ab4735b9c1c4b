// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "adaptor/mujoco/mujoco_compat.h"

namespace volcontact::adaptor {

/// The step of the integrator `discrete`, (M + N) a = t - s: N = h B + h^2 K of all dampers,
/// springs and servos, and s = h K v, so that springs pull as at the end of the step. Memory is
/// reused from step to step.
class StepMetric {
 public:
  struct Entry {
    int dof;
    double value;
  };
  /// A part scale * J' J of N that joins degrees of freedom, of a tendon or an actuator.
  struct Row {
    double scale;
    std::vector<Entry>::size_type begin, end;
  };

  /// Takes what MuJoCo has made in `ahead`: see look_ahead.h. Of null, nothing.
  void read(const mjModel* m, const mjData* ahead);

  /// Whether there is anything: else damping is all that the integrator takes implicitly.
  bool is_known() const { return ahead_ != nullptr; }
  /// Where it is taken from, with all that MuJoCo has when it makes the step: what it has not made
  /// yet in the data of the step is stale there.
  const mjData* ahead() const { return ahead_; }
  /// The part of N that joins no degrees of freedom.
  double diagonal(int dof) const { return diagonal_[static_cast<std::size_t>(dof)]; }
  /// Of fluids, where the mass matrix of `dof` has entries, in the order of these; may be null.
  const double* fluid() const { return fluid_; }
  std::span<const Row> rows() const { return rows_; }
  std::span<const Entry> entries(const Row& row) const {
    return std::span(entries_).subspan(row.begin, row.end - row.begin);
  }
  /// Takes s off the forces t.
  void shift(std::span<double> forces) const;
  /// Whether a constraint or a row acts on it, so that its body does not fly alone.
  bool is_held(int dof) const { return is_known() && held_[static_cast<std::size_t>(dof)] != 0; }

 private:
  const mjData* ahead_ = nullptr;
  std::vector<double> diagonal_, shift_;
  const double* fluid_ = nullptr;
  std::vector<Row> rows_;
  std::vector<Entry> entries_;
  std::vector<char> held_;
};

}  // namespace volcontact::adaptor
