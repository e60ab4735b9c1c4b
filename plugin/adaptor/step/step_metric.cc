// SPDX-License-Identifier: Apache-2.0
#include "adaptor/step/step_metric.h"

#include <algorithm>
#include <functional>

#include "volcontact/base/sizes.h"

namespace volcontact::adaptor {

void StepMetric::read(const mjModel* m, const mjData* ahead) {
  rows_.clear();
  entries_.clear();
  fluid_ = nullptr;
  ahead_ = ahead;
  if (!is_known()) return;
  const std::size_t dofs = size(static_cast<int>(m->nv));
  const StepDiagonal own = step_diagonal(ahead);
  diagonal_.assign(dofs, 0.0);
  shift_.assign(dofs, 0.0);
  held_.assign(dofs, 0);
  if (own.added) diagonal_.assign(own.added, own.added + dofs);
  if (own.stiffness) {
    std::transform(own.stiffness, own.stiffness + dofs, ahead->qvel, shift_.begin(),
                   std::multiplies<>());
  }
  fluid_ = own.fluid;
  for_each_step_row(m, ahead, [&](double scale, double stiffness, auto row, auto numbers) {
    double speed = 0.0;
    for (std::size_t i = 0; i < row.size(); ++i) speed += numbers[i] * ahead->qvel[row[i]];
    for (std::size_t i = 0; i < row.size(); ++i) {
      shift_[size(row[i])] += stiffness * speed * numbers[i];
      held_[size(row[i])] = 1;
    }
    if (row.size() == 1) {
      diagonal_[size(row[0])] += scale * numbers[0] * numbers[0];
    } else if (scale > 0.0) {
      const std::size_t begin = entries_.size();
      for (std::size_t i = 0; i < row.size(); ++i) entries_.push_back({row[i], numbers[i]});
      rows_.push_back({scale, begin, entries_.size()});
    }
  });
  for (int i = 0; i < ahead->nefc; ++i) {
    for_row_of_constraint(m, ahead, i, [&](int dof, double value) {
      if (value != 0.0) held_[size(dof)] = 1;
    });
  }
}

void StepMetric::shift(std::span<double> forces) const {
  if (!is_known()) return;
  std::transform(forces.begin(), forces.end(), shift_.begin(), forces.begin(), std::minus<>());
}

}  // namespace volcontact::adaptor
