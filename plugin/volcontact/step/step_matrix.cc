// SPDX-License-Identifier: Apache-2.0
#include "volcontact/step/step_matrix.h"

#include <algorithm>

namespace volcontact {
namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

// Numbers for the degrees of freedom of an island, and the envelope of their masses: each has
// inertia in common with those it carries and with those that carry it.
void StepMatrix::number_dofs(const MechanismTrees& mechanism, std::span<const DofRange> trees) {
  std::size_t count = 0;
  for (const DofRange& tree : trees) count += index(tree.size());
  numbers_.resize(mechanism.carrier.size());
  trees_.clear();
  tree_of_.resize(count);
  dofs_.resize(count);
  free_envelope_.resize(count);
  parents_.resize(count);
  int begin = 0;
  for (const DofRange& tree : trees) {
    // The number of a degree of freedom and its own add up to this one.
    const int both = begin + tree.end - 1;
    for (int dof = tree.end - 1; dof >= tree.begin; --dof) {
      const std::size_t i = index(both - dof);
      numbers_[index(dof)] = both - dof;
      tree_of_[i] = begin;
      dofs_[i] = dof;
      free_envelope_[i] = both - dof;
      const int parent = mechanism.carrier[index(dof)];
      parents_[i] = parent < 0 ? -1 : both - parent;
    }
    trees_.push_back({begin, both + 1 - tree.begin});
    begin += tree.size();
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (parents_[i] < 0) continue;
    int& first = free_envelope_[index(parents_[i])];
    first = std::min(first, free_envelope_[i]);
  }
  carriers_.set(parents_);
  marked_.assign(count, 0);
}

void StepMatrix::make_mass(const Mechanism& mechanism) {
  mass_.reset(carriers_, true);
  for (int i = 0; i < size(); ++i) mechanism.mass(dofs_[index(i)], mass_.row(i));
}

// Mh = M + N, of the entries of N. Returns whether there is any.
bool StepMatrix::add_extra() {
  free_.reset(carriers_, false);
  for (const DofEntry& entry : entries_) {
    const int i = number(entry.row), k = number(entry.column);
    (i <= k ? free_(i, k) : free_.mirrored(k, i)) = entry.value;
  }
  bool has_extra = false;
  bool is_symmetric = true;
  for (int i = 0; i < size(); ++i) {
    has_extra = has_extra || free_(i, i) != 0.0;
    free_(i, i) += mass_(i, i);
    for (int k = carriers_.parent(i); k >= 0; k = carriers_.parent(k)) {
      double &below = free_(i, k), &above = free_.mirrored(i, k);
      has_extra = has_extra || below != 0.0 || above != 0.0;
      is_symmetric = is_symmetric && below == above;
      below += mass_(i, k);
      above += mass_(i, k);
    }
  }
  if (is_symmetric) free_.mirror();
  return has_extra;
}

void StepMatrix::build(const Mechanism& mechanism, std::span<const DofRange> trees) {
  number_dofs(*mechanism.trees, trees);
  make_mass(mechanism);
  entries_.clear();
  mechanism.damping(dofs_, entries_);
  is_damped_ = !entries_.empty();
  const bool has_extra = is_damped_ && add_extra();
  free_factor_ = free();
  free_factor_.factor();
  converts_ = has_extra && !mechanism.constraints_see_damping();
  makes_mass_factor_ = converts_;
  column_count_ = 0;
  load_.assign(dofs_.size(), 0.0);
  envelope_ = free_envelope_;
  has_matrix_ = false;
}

void StepMatrix::close(std::vector<int>& numbers) {
  const std::size_t count = numbers.size();
  for (const int i : numbers) marked_[index(i)] = 1;
  for (std::size_t i = 0; i < count; ++i) {
    for (int k = carriers_.parent(numbers[i]); k >= 0 && !marked_[index(k)];
         k = carriers_.parent(k)) {
      marked_[index(k)] = 1;
      numbers.push_back(k);
    }
  }
  std::sort(numbers.begin(), numbers.end());
  for (const int i : numbers) marked_[index(i)] = 0;
}

// In the order of their degrees of freedom, so that those of one tree are near each other.
void StepMatrix::sort_columns(const LinearConstraints& constraints) {
  column_count_ = index(constraints.columns());
  order_.clear();
  for (int c = 0; c < constraints.columns(); ++c) {
    int least = size();
    for (const LinearConstraints::Entry& entry : constraints.column(c)) {
      least = std::min(least, number(entry.dof));
    }
    order_.emplace_back(least, c);
  }
  std::sort(order_.begin(), order_.end());
  if (columns_.size() < column_count_) columns_.resize(column_count_);
}

void StepMatrix::take_columns(const LinearConstraints& constraints) {
  sort_columns(constraints);
  dense_.assign(dofs_.size(), 0.0);
  for (std::size_t c = 0; c < column_count_; ++c) {
    Column& column = columns_[c];
    const auto entries = constraints.column(order_[c].second);
    column.support.clear();
    for (const LinearConstraints::Entry& entry : entries) {
      const int i = number(entry.dof);
      if (!marked_[index(i)]) column.support.push_back(i);
      marked_[index(i)] = 1;
    }
    close(column.support);
    const auto put = [&] {
      for (const LinearConstraints::Entry& entry : entries) {
        dense_[index(number(entry.dof))] += entry.value;
      }
    };
    const auto take = [&](std::vector<double>& out) {
      out.clear();
      for (const int i : column.support) out.push_back(std::exchange(dense_[index(i)], 0.0));
    };
    put();
    take(column.values);
    put();
    free_factor_.carry_upper(column.support, dense_.data());
    for (const int i : column.support) dense_[index(i)] *= free_factor_.inverse_pivot(i);
    take(column.forced);
    put();
    constraint_factor().carry_lower(column.support, dense_.data());
    take(column.constrained);
  }
}

// P has entries where G has, or where it converts in all of their trees.
void StepMatrix::widen_envelope() {
  envelope_ = free_envelope_;
  for (const Column& column : columns()) {
    int first = size();
    for (std::size_t k = 0; k < column.support.size(); ++k) {
      const int i = column.support[k];
      if (column.values[k] != 0.0) first = std::min(first, converts_ ? tree_of_[index(i)] : i);
    }
    int tree = -1;  // the last one; the numbers of each stand together
    for (const int i : column.support) {
      if (!converts_) {
        envelope_[index(i)] = std::min(envelope_[index(i)], first);
        continue;
      }
      if (tree_of_[index(i)] == tree) continue;
      tree = tree_of_[index(i)];
      for (std::size_t k = index(tree); k < dofs_.size() && tree_of_[k] == tree; ++k) {
        envelope_[k] = std::min(envelope_[k], first);
      }
    }
  }
}

// 1 + P' Mh^-1 G: where it converts that is 1 + G' M^-1 G. Columns without a tree in common know
// nothing of each other.
void StepMatrix::couple() {
  const int count = static_cast<int>(column_count_);
  first_of_tree_.assign(dofs_.size(), count);
  first_.resize(column_count_);
  for (int c = 0; c < count; ++c) {
    int& first = first_[index(c)] = c;
    for (const int i : columns_[index(c)].support) {
      int& of_tree = first_of_tree_[index(tree_of_[index(i)])];
      first = std::min(first, of_tree = std::min(of_tree, c));
    }
  }
  coupling_.reset(first_, converts_ || free_factor_.is_symmetric());
  for (int c = 0; c < count; ++c) {
    const Column& column = columns_[index(c)];
    for (std::size_t k = 0; k < column.support.size(); ++k) {
      const int i = column.support[k];
      dense_[index(i)] = column.constrained[k] * (converts_ ? mass_factor_.inverse_pivot(i) : 1.0);
    }
    for (int other = 0; other < (coupling_.is_symmetric() ? c + 1 : count); ++other) {
      if (std::min(c, other) < coupling_.first(std::max(c, other))) continue;
      const Column& to = columns_[index(other)];
      const std::vector<double>& values = converts_ ? to.constrained : to.forced;
      double sum = c == other ? 1.0 : 0.0;
      for (std::size_t k = 0; k < to.support.size(); ++k) {
        sum += dense_[index(to.support[k])] * values[k];
      }
      (other <= c ? coupling_(c, other) : coupling_.mirrored(other, c)) = sum;
    }
    for (const int i : column.support) dense_[index(i)] = 0.0;
  }
  coupling_.factor();
}

// The solver's acceleration is that of M, where it converts.
void StepMatrix::factor_mass() {
  if (!makes_mass_factor_) return;
  makes_mass_factor_ = false;
  mass_factor_ = mass_;
  mass_factor_.factor();
}

void StepMatrix::constrain(const LinearConstraints& constraints) {
  load_.assign(dofs_.size(), 0.0);
  for (const LinearConstraints::Entry& entry : constraints.load()) {
    load_[index(number(entry.dof))] += entry.value;
  }
  has_matrix_ = false;
  column_count_ = index(constraints.columns());
  if (column_count_ == 0) {
    envelope_ = free_envelope_;
    return;
  }
  factor_mass();
  take_columns(constraints);
  widen_envelope();
  couple();
}

const EnvelopeMatrix& StepMatrix::matrix() {
  if (has_matrix_) return matrix_;
  has_matrix_ = true;
  matrix_.reset(envelope_, is_symmetric());
  for (int i = 0; i < size(); ++i) {
    matrix_(i, i) = free()(i, i);
    for (int k = carriers_.parent(i); k >= 0; k = carriers_.parent(k)) {
      matrix_(k, i) = free().mirrored(i, k);
      if (!matrix_.is_symmetric()) matrix_.mirrored(k, i) = free()(i, k);
    }
  }
  for (const Column& column : columns()) {
    for (std::size_t k = 0; k < column.support.size(); ++k) {
      dense_[index(column.support[k])] = column.values[k];
    }
    product_ = dense_;
    if (converts_) {
      shares_ = dense_;
      mass_factor_.solve(shares_.data());
      free().multiply_transposed(shares_.data(), product_.data());
    }
    for (const int row : column.support) {
      const double left = dense_[index(row)];
      for (int k = 0; left != 0.0 && k < size(); ++k) {
        const double right = product_[index(k)];
        if (right == 0.0 || (k > row && matrix_.is_symmetric())) continue;
        (k <= row ? matrix_(row, k) : matrix_.mirrored(k, row)) += left * right;
      }
      dense_[index(row)] = 0.0;
    }
  }
  return matrix_;
}

// Takes off the forces x what the constraints bear of them: x - G (1 + P' Mh^-1 G)^-1 P' Mh^-1 x.
void StepMatrix::release(std::vector<double>& x) {
  if (column_count_ == 0) return;
  product_ = x;
  constraint_factor().solve(product_.data());
  shares_.assign(column_count_, 0.0);
  for (std::size_t c = 0; c < column_count_; ++c) {
    const Column& column = columns_[c];
    for (std::size_t k = 0; k < column.support.size(); ++k) {
      shares_[c] += column.values[k] * product_[index(column.support[k])];
    }
  }
  coupling_.solve(shares_.data(), 0, coupling_.size());
  for (std::size_t c = 0; c < column_count_; ++c) {
    const Column& column = columns_[c];
    for (std::size_t k = 0; k < column.support.size(); ++k) {
      x[index(column.support[k])] -= column.values[k] * shares_[c];
    }
  }
}

void StepMatrix::solve(std::vector<double>& x) {
  release(x);
  free_factor_.solve(x.data());
}

void StepMatrix::accelerate(std::vector<double>& x) {
  factor_mass();
  release(x);
  constraint_factor().solve(x.data());
}

}  // namespace volcontact
