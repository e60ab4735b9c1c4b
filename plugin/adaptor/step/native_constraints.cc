// SPDX-License-Identifier: Apache-2.0
#include "adaptor/step/native_constraints.h"

#include "adaptor/step/look_ahead.h"

namespace volcontact::adaptor {

void NativeConstraints::read(const mjModel* m, mjData* d) {
  m_ = m;
  d_ = d;
  begin_rows();
  const int count = static_cast<int>(d->nefc);
  if (count == 0 || !complete_constraints(m, d)) return;
  mj_referenceConstraint(m, d);
  for (int i = 0; i < count; ++i) {
    for_row_of_constraint(m, d, i, [&](int dof, double value) {
      if (value != 0.0) add_entry(dof, value);
    });
    const std::span<const Entry> row = end_row(d->efc_aref[i]);
    for (std::size_t k = 1; k < row.size(); ++k) {
      if (m->dof_bodyid[row[k].dof] == m->dof_bodyid[row[k - 1].dof]) continue;
      join(row[k - 1].dof, row[k].dof);
    }
  }
}

void NativeConstraints::respond(std::span<const int> rows, std::span<const double> violation) {
  mj_constraintUpdate(m_, d_, violation.data(), nullptr, 1);
  for (const int i : rows) {
    const int state = d_->efc_state[i];
    set_response(i, d_->efc_force[i], state == mjCNSTRSTATE_QUADRATIC ? d_->efc_D[i] : 0.0);
    if (state != mjCNSTRSTATE_CONE) continue;
    const mjContact& contact = d_->contact[d_->efc_id[i]];
    if (contact.efc_address == i) add_cone(i, contact.dim, contact.H);
  }
}

}  // namespace volcontact::adaptor
