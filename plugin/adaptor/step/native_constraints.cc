// SPDX-License-Identifier: Apache-2.0
#include "adaptor/step/native_constraints.h"

#include <algorithm>
#include <cmath>

#include "adaptor/mujoco/sizes.h"
#include "adaptor/step/look_ahead.h"

namespace volcontact::adaptor {

void NativeConstraints::read(const mjModel* m, mjData* d) {
  jacobian_.clear();
  row_begin_.assign(1, 0);
  joined_.clear();
  const int count = static_cast<int>(d->nefc);
  if (count == 0 || !complete_constraints(m, d)) return;
  mj_referenceConstraint(m, d);
  for (int i = 0; i < count; ++i) {
    for_row_of_constraint(m, d, i, [&](int dof, double value) {
      if (value != 0.0) jacobian_.push_back({dof, value});
    });
    row_begin_.push_back(static_cast<int>(jacobian_.size()));
    const std::span<const Entry> row = this->row(i);
    for (std::size_t k = 1; k < row.size(); ++k) {
      if (m->dof_bodyid[row[k].dof] == m->dof_bodyid[row[k - 1].dof]) continue;
      joined_.emplace_back(row[k - 1].dof, row[k].dof);
    }
  }
}

void NativeConstraints::select(const mjModel* m, mjData* d, const ContactIslands& islands,
                               int island) {
  const std::size_t count = row_begin_.size() - 1;
  rows_.clear();
  violation_.assign(count, 0.0);
  force_.assign(count, 0.0);
  slope_.assign(count, 0.0);
  for (int i = 0; i < static_cast<int>(count); ++i) {
    const std::span<const Entry> row = this->row(i);
    if (row.empty() || islands.island_of(m, row.front().dof) != island) continue;
    rows_.push_back(i);
    violation_[size(i)] = -d->efc_aref[i];
  }
  evaluate(m, d);
}

bool NativeConstraints::improve(const mjModel* m, mjData* d, std::span<const double> acceleration) {
  constexpr double kChange = 1e-10;
  way_ = violation_;
  linear_ = force_;
  for (const int i : rows_) {
    double& x = violation_[size(i)];
    x = -d->efc_aref[i];
    for (const Entry& entry : row(i)) x += entry.value * acceleration[size(entry.dof)];
    way_[size(i)] = x - way_[size(i)];
  }
  subtract_slope(way_, linear_);
  evaluate(m, d);
  double change = 0.0, largest = 0.0;
  for (const int i : rows_) {
    change = std::max(change, std::abs(force_[size(i)] - linear_[size(i)]));
    largest = std::max(largest, std::abs(force_[size(i)]));
  }
  return change <= kChange * largest;
}

// The forces at the guess, and how they change.
void NativeConstraints::evaluate(const mjModel* m, mjData* d) {
  cones_.clear();
  load_.clear();
  columns_.clear();
  column_begin_.assign(1, 0);
  if (rows_.empty()) return;
  mj_constraintUpdate(m, d, violation_.data(), nullptr, 1);
  for (const int i : rows_) {
    const int state = d->efc_state[i];
    force_[size(i)] = d->efc_force[i];
    slope_[size(i)] = state == mjCNSTRSTATE_QUADRATIC ? d->efc_D[i] : 0.0;
    if (state == mjCNSTRSTATE_CONE && d->contact[d->efc_id[i]].efc_address == i) add_cone(d, i);
  }
  make_columns(d);
}

// Its slope is semidefinite: it has no curvature along the way to its tip.
void NativeConstraints::add_cone(const mjData* d, int row) {
  constexpr double kFlat = 1e-12;
  const mjContact& contact = d->contact[d->efc_id[row]];
  const int n = contact.dim;
  Eigen::Matrix<double, 6, 6> slope = Eigen::Matrix<double, 6, 6>::Zero();
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) slope(i, k) = contact.H[i * n + k];
  }
  Cone cone{row, n, Eigen::Matrix<double, 6, 6>::Zero()};
  const double least = kFlat * slope.diagonal().maxCoeff();
  for (int k = 0; k < n; ++k) {
    if (!(slope(k, k) > least)) continue;
    cone.factor.col(k) = slope.col(k) / std::sqrt(slope(k, k));
    cone.factor.col(k).head(k).setZero();
    slope -= cone.factor.col(k) * cone.factor.col(k).transpose();
  }
  cones_.push_back(cone);
}

void NativeConstraints::subtract_slope(const std::vector<double>& x,
                                       std::vector<double>& force) const {
  for (const int i : rows_) force[size(i)] -= slope_[size(i)] * x[size(i)];
  for (const Cone& cone : cones_) {
    const Eigen::Map<const Eigen::VectorXd> along(&x[size(cone.row)], cone.count);
    Eigen::Map<Eigen::VectorXd> out(&force[size(cone.row)], cone.count);
    const auto factor = cone.factor.topLeftCorner(cone.count, cone.count);
    out -= factor * (factor.transpose() * along);
  }
}

void NativeConstraints::make_columns(const mjData* d) {
  const auto add = [this](std::vector<Entry>& to, int row, double scale) {
    for (const Entry& entry : this->row(row)) to.push_back({entry.dof, scale * entry.value});
  };
  // f at a = 0, as linear: against the way from there to the guess.
  constant_ = force_;
  way_.assign(violation_.size(), 0.0);
  for (const int i : rows_) way_[size(i)] = -(violation_[size(i)] + d->efc_aref[i]);
  subtract_slope(way_, constant_);
  for (const int i : rows_) {
    if (constant_[size(i)] != 0.0) add(load_, i, constant_[size(i)]);
    if (slope_[size(i)] == 0.0) continue;
    add(columns_, i, std::sqrt(slope_[size(i)]));
    column_begin_.push_back(static_cast<int>(columns_.size()));
  }
  for (const Cone& cone : cones_) {
    for (int k = 0; k < cone.count; ++k) {
      for (int i = k; i < cone.count; ++i) add(columns_, cone.row + i, cone.factor(i, k));
      column_begin_.push_back(static_cast<int>(columns_.size()));
    }
  }
}

}  // namespace volcontact::adaptor
