// SPDX-License-Identifier: Apache-2.0
#include "adaptor/step/native_constraints.h"

#include "adaptor/step/look_ahead.h"

namespace volcontact::adaptor {

void NativeConstraints::read(const mjModel* m, mjData* d, const mjData* ahead,
                             const StepMetric& metric) {
  m_ = m;
  d_ = d;
  metric_ = &metric;
  begin_rows();
  count_ = complete_constraints(d, ahead) ? static_cast<int>(d->nefc) : 0;
  held_.assign(size(count_), {});
  if (count_ > 0) mj_referenceConstraint(m, d);
  // MuJoCo's solver begins there, too. Cones are curved: what is found there hangs on the begin.
  const bool is_curved = d->ncon > 0 && m->opt.cone == mjCONE_ELLIPTIC;
  if (!is_curved && (m->opt.disableflags & mjDSBL_WARMSTART) == 0) {
    guess({d->qacc_warmstart, size(static_cast<int>(m->nv))});
  }
  for (int i = 0; i < count_; ++i) {
    for_row_of_constraint(m, d, i, [&](int dof, double value) {
      if (value != 0.0) add_entry(dof, value);
    });
    end_joining_row(m, d->efc_aref[i]);
  }
  for (const StepMetric::Row& row : metric.rows()) {
    for (const StepMetric::Entry& entry : metric.entries(row)) {
      if (entry.value != 0.0) add_entry(entry.dof, entry.value);
    }
    end_joining_row(m, 0.0);
  }
}

void NativeConstraints::end_joining_row(const mjModel* m, double reference) {
  const std::span<const Entry> row = end_row(reference);
  for (std::size_t k = 1; k < row.size(); ++k) {
    if (m->dof_bodyid[row[k].dof] == m->dof_bodyid[row[k - 1].dof]) continue;
    join(row[k - 1].dof, row[k].dof);
  }
}

void NativeConstraints::respond(std::span<const int> rows, std::span<const double> violation) {
  if (count_ > 0) mj_constraintUpdate(m_, d_, violation.data(), nullptr, 1);
  for (const int i : rows) {
    if (i >= count_) {
      const double scale = metric_->rows()[size(i - count_)].scale;
      set_response(i, -scale * violation[size(i)], scale);
      continue;
    }
    if (is_made_stiff(i) && hold(i, violation[size(i)])) continue;
    const int state = d_->efc_state[i];
    set_response(i, d_->efc_force[i], state == mjCNSTRSTATE_QUADRATIC ? d_->efc_D[i] : 0.0);
    if (state != mjCNSTRSTATE_CONE) continue;
    const mjContact& contact = d_->contact[d_->efc_id[i]];
    if (contact.efc_address == i) add_cone(i, contact.dim, contact.H);
  }
}

// Dry friction of a joint or tendon, with noslip iterations after the solver has converged.
bool NativeConstraints::is_made_stiff(int row) const {
  const int type = d_->efc_type[row];
  return m_->opt.noslip_iterations > 0 &&
         (type == mjCNSTR_FRICTION_DOF || type == mjCNSTR_FRICTION_TENDON);
}

// As much as it takes to hold, up to what there is. The force is so steep that Newton's method
// would go from one side to the other for ever: in between it is tried whether it holds. Where that
// comes to no end, since contact under its limit of work yields the more the less it is moved, it
// stays as soft as the solver has it: false.
bool NativeConstraints::hold(int row, double violation) {
  constexpr double kStiff = 1e4;
  constexpr int kTrials = 2;
  Held& held = held_[size(row)];
  if (held.trials > kTrials) return false;
  const double most = d_->efc_frictionloss[row], slope = kStiff * d_->efc_D[row];
  const double force = -slope * violation;
  const int side = force > most ? 1 : force < -most ? -1 : 0;
  const bool slips = side != 0 && side * held.side >= 0;
  held.side = slips ? side : 0;
  if (slips) {
    set_response(row, side * most, 0.0);
    return true;
  }
  if (side != 0 && ++held.trials > kTrials) return false;
  set_response(row, force, slope);
  return true;
}

}  // namespace volcontact::adaptor
