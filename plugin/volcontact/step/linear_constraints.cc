// SPDX-License-Identifier: Apache-2.0
#include "volcontact/step/linear_constraints.h"

#include <algorithm>
#include <cmath>

namespace volcontact {

void LinearConstraints::begin_rows() {
  jacobian_.clear();
  row_begin_.assign(1, 0);
  reference_.clear();
  joined_.clear();
  guess_.clear();
}

std::span<const LinearConstraints::Entry> LinearConstraints::end_row(double reference) {
  reference_.push_back(reference);
  row_begin_.push_back(static_cast<int>(jacobian_.size()));
  return row(static_cast<int>(reference_.size()) - 1);
}

void LinearConstraints::select(const ContactIslands& islands, int island) {
  const std::size_t count = reference_.size();
  rows_.clear();
  violation_.assign(count, 0.0);
  force_.assign(count, 0.0);
  slope_.assign(count, 0.0);
  for (int i = 0; i < static_cast<int>(count); ++i) {
    const std::span<const Entry> row = this->row(i);
    if (row.empty() || islands.island_of(row.front().dof) != island) continue;
    rows_.push_back(i);
    double guessed = 0.0;
    for (const Entry& entry : row) {
      if (!guess_.empty()) guessed += entry.value * guess_[size(entry.dof)];
    }
    violation_[size(i)] = (std::isfinite(guessed) ? guessed : 0.0) - reference_[size(i)];
  }
  evaluate();
}

bool LinearConstraints::improve(std::span<const double> acceleration) {
  constexpr double kChange = 1e-10;
  way_ = violation_;
  linear_ = force_;
  for (const int i : rows_) {
    double& x = violation_[size(i)];
    x = -reference_[size(i)];
    for (const Entry& entry : row(i)) x += entry.value * acceleration[size(entry.dof)];
    way_[size(i)] = x - way_[size(i)];
  }
  subtract_slope(way_, linear_);
  evaluate();
  double change = 0.0, largest = 0.0;
  for (const int i : rows_) {
    change = std::max(change, std::abs(force_[size(i)] - linear_[size(i)]));
    largest = std::max(largest, std::abs(force_[size(i)]));
  }
  if (change <= kChange * largest) return true;
  hold_what_turned();
  return false;
}

// Dry friction that turned round from one guess to the next may hold in between: there it is looked
// at next. Without that it goes on from one side to the other.
void LinearConstraints::hold_what_turned() {
  if (is_curved()) return;
  bool turned = false;
  for (const int i : rows_) {
    if (slope_[size(i)] != 0.0 || !(linear_[size(i)] * force_[size(i)] < 0.0)) continue;
    violation_[size(i)] = 0.0;
    turned = true;
  }
  if (turned) evaluate();
}

// The forces at the guess, and how they change.
void LinearConstraints::evaluate() {
  cones_.clear();
  load_.clear();
  columns_.clear();
  column_begin_.assign(1, 0);
  if (rows_.empty()) return;
  respond(rows_, violation_);
  make_columns();
}

void LinearConstraints::set_response(int row, double force, double slope) {
  force_[size(row)] = force;
  slope_[size(row)] = slope;
}

// The slope is semidefinite: it has no curvature along the way to the tip of the cone.
void LinearConstraints::add_cone(int first, int count, const double* numbers) {
  constexpr double kFlat = 1e-12;
  Matrix<6, 6> slope = Matrix<6, 6>::Zero();
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < count; ++k) slope(i, k) = numbers[i * count + k];
  }
  Cone cone{first, count, Matrix<6, 6>::Zero()};
  const double least = kFlat * slope.diagonal().maxCoeff();
  for (int k = 0; k < count; ++k) {
    if (!(slope(k, k) > least)) continue;
    cone.factor.col(k) = slope.col(k) / std::sqrt(slope(k, k));
    std::fill_n(cone.factor.col(k).begin(), k, 0.0);
    slope -= outer(cone.factor.col(k), cone.factor.col(k));
  }
  cones_.push_back(cone);
}

void LinearConstraints::subtract_slope(const std::vector<double>& x,
                                       std::vector<double>& force) const {
  for (const int i : rows_) force[size(i)] -= slope_[size(i)] * x[size(i)];
  for (const Cone& cone : cones_) {
    Vector<6> along = Vector<6>::Zero();
    std::copy_n(&x[size(cone.row)], cone.count, along.begin());
    const Vector<6> less = cone.factor * cone.factor.transposed_times(along);
    for (int i = 0; i < cone.count; ++i) force[size(cone.row + i)] -= less[i];
  }
}

void LinearConstraints::make_columns() {
  const auto add = [this](std::vector<Entry>& to, int row, double scale) {
    for (const Entry& entry : this->row(row)) to.push_back({entry.dof, scale * entry.value});
  };
  // f at a = 0, as linear: against the way from there to the guess.
  constant_ = force_;
  way_.assign(violation_.size(), 0.0);
  for (const int i : rows_) way_[size(i)] = -(violation_[size(i)] + reference_[size(i)]);
  subtract_slope(way_, constant_);
  for (const int i : rows_) {
    if (slope_[size(i)] != 0.0) constant_[size(i)] = slope_[size(i)] * reference_[size(i)];
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

}  // namespace volcontact
