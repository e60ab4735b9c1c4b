// SPDX-License-Identifier: Apache-2.0
#include "adaptor/step/step_matrix.h"

#include <algorithm>

namespace volcontact::adaptor {
namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

// Numbers for the degrees of freedom of an island, and the envelope of their masses: each has
// inertia in common with those it carries and with those that carry it.
void StepMatrix::number_dofs(const mjModel* m, std::span<const DofRange> trees) noexcept {
  trees_.clear();
  dofs_.clear();
  numbers_.resize(index(static_cast<int>(m->nv)));
  limits_.resize(numbers_.size());
  for (const DofRange& tree : trees) {
    const int begin = static_cast<int>(dofs_.size());
    for (int dof = tree.end - 1; dof >= tree.begin; --dof) {
      numbers_[index(dof)] = static_cast<int>(dofs_.size());
      dofs_.push_back(dof);
    }
    trees_.push_back({begin, static_cast<int>(dofs_.size())});
    for (int dof = tree.begin; dof < tree.end; ++dof) limits_[index(dof)] = dof;
    for (int dof = tree.end - 1; dof >= tree.begin; --dof) {
      const int parent = m->dof_parentid[dof];
      if (parent < 0) continue;
      limits_[index(parent)] = std::max(limits_[index(parent)], limits_[index(dof)]);
    }
  }
  envelope_.resize(dofs_.size());
  for (std::size_t i = 0; i < dofs_.size(); ++i) envelope_[i] = number(limits_[index(dofs_[i])]);
}

void StepMatrix::make_mass(const mjModel* m, const mjData* d) noexcept {
  mass_.reset(envelope_);
  for (std::size_t i = 0; i < dofs_.size(); ++i) {
    for_row_of_mass(m, d, dofs_[i], [&](int other, double mass) {
      mass_(number(other), static_cast<int>(i)) = mass;  // those that carry it come after it
    });
  }
}

void StepMatrix::make_extra(const mjModel* m, const mjData* d, Damping damping) noexcept {
  extra_.reset(envelope_, false);
  const double h = m->opt.timestep;
  const auto set = [&](int row, int column, double x) {
    const int i = number(row), k = number(column);
    (k <= i ? extra_(i, k) : extra_.mirrored(k, i)) = x;
  };
  for (const int dof : dofs_) {
    for_row_of_damping(m, d, damping, dof, [&](int other, double b) {
      set(dof, other, h * b);
      if (damping == Damping::kAllSymmetric) set(other, dof, h * b);
    });
  }
  for (const DofRange& tree : trees_) {
    double matrix[36];
    const int last = dofs_[index(tree.begin)], joint = m->dof_jntid[last];
    if (!matrix_of_free_body(m, d, damping, joint, matrix)) continue;
    const int first = m->jnt_dofadr[joint];
    for (int i = 0; i < 36; ++i) {
      const int low = std::min(number(first + i / 6), number(first + i % 6));
      const int high = std::max(number(first + i / 6), number(first + i % 6));
      set(first + i / 6, first + i % 6, matrix[i] - mass_(high, low));
    }
  }
  has_extra_ = false;
  extra_is_symmetric_ = true;
  for (int i = 0; i < extra_.size(); ++i) {
    has_extra_ = has_extra_ || extra_(i, i) != 0.0;
    for (int k = extra_.first(i); k < i; ++k) {
      has_extra_ = has_extra_ || extra_(i, k) != 0.0 || extra_.mirrored(i, k) != 0.0;
      extra_is_symmetric_ = extra_is_symmetric_ && extra_(i, k) == extra_.mirrored(i, k);
    }
  }
}

void StepMatrix::take_constraints(const NativeConstraints& constraints) noexcept {
  load_.assign(dofs_.size(), 0.0);
  for (const NativeConstraints::Entry& entry : constraints.load()) {
    load_[index(number(entry.dof))] += entry.value;
  }
  column_count_ = index(constraints.columns());
  if (columns_.size() < column_count_) columns_.resize(column_count_);
  product_.assign(dofs_.size(), 0.0);
  for (std::size_t c = 0; c < column_count_; ++c) {
    dense_.assign(dofs_.size(), 0.0);
    for (const NativeConstraints::Entry& entry : constraints.column(static_cast<int>(c))) {
      dense_[index(number(entry.dof))] += entry.value;
    }
    if (converts_) {
      solved_ = dense_;
      mass_factor_.solve(solved_.data(), 0, size());
      extra_.multiply_transposed(solved_.data(), product_.data());
    }
    Column& column = columns_[c];
    column.numbers.clear();
    column.left.clear();
    column.right.clear();
    for (std::size_t i = 0; i < dofs_.size(); ++i) {
      if (dense_[i] == 0.0 && product_[i] == 0.0) continue;
      column.numbers.push_back(static_cast<int>(i));
      column.left.push_back(dense_[i]);
      column.right.push_back(dense_[i] + product_[i]);
    }
  }
}

void StepMatrix::add_constraints() noexcept {
  for (std::size_t c = 0; c < column_count_; ++c) {
    const Column& column = columns_[c];
    for (std::size_t i = 0; i < column.numbers.size(); ++i) {
      for (std::size_t k = 0; k <= i; ++k) {
        matrix_(column.numbers[i], column.numbers[k]) += column.left[i] * column.right[k];
        if (k == i || matrix_.is_symmetric()) continue;
        matrix_.mirrored(column.numbers[i], column.numbers[k]) += column.left[k] * column.right[i];
      }
    }
  }
}

void StepMatrix::build(const mjModel* m, const mjData* d, Damping damping,
                       std::span<const DofRange> trees,
                       const NativeConstraints& constraints) noexcept {
  number_dofs(m, trees);
  make_mass(m, d);
  has_extra_ = false;
  extra_is_symmetric_ = true;
  if (damping != Damping::kNone) make_extra(m, d, damping);
  converts_ = has_extra_ && !constraints.empty() && !solves_with_step_matrix(m);
  if (converts_) {
    mass_factor_ = mass_;
    mass_factor_.factor();
  }
  take_constraints(constraints);
  for (std::size_t c = 0; c < column_count_; ++c) {
    const std::vector<int>& numbers = columns_[c].numbers;
    for (const int i : numbers)
      envelope_[index(i)] = std::min(envelope_[index(i)], numbers.front());
  }
  matrix_.reset(envelope_, extra_is_symmetric_ && (!converts_ || column_count_ == 0));
  matrix_.add(mass_);
  if (has_extra_) matrix_.add(extra_);
  add_constraints();
  factor_ = matrix_;
  factor_.factor();
}

void StepMatrix::to_acceleration(std::vector<double>& change, double step) noexcept {
  if (converts_) {
    product_.assign(change.size(), 0.0);
    extra_.multiply(change.data(), product_.data());
    mass_factor_.solve(product_.data(), 0, size());
    for (std::size_t i = 0; i < change.size(); ++i) change[i] += product_[i];
  }
  for (double& x : change) x /= step;
}

}  // namespace volcontact::adaptor
