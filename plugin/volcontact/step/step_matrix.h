// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "volcontact/step/linear_constraints.h"
#include "volcontact/step/matrix/envelope_matrix.h"
#include "volcontact/step/matrix/tree_matrix.h"
#include "volcontact/step/mechanism.h"

namespace volcontact {

/// The matrix H of one step of an island, H dv = h t: what the integrator divides by, Mh = M + N,
/// and what native constraints add, linear around a guess, G P' with P' = G' M^-1 Mh. N is what
/// the integrator takes implicitly of the forces by velocities. Mh is factored along the trees,
/// once a step; what the constraints add has the few columns of G, so that
/// H^-1 = Mh^-1 - Mh^-1 G (1 + P' Mh^-1 G)^-1 P' Mh^-1. Memory is reused from step to step.
///
/// The degrees of freedom have numbers of their own, tree by tree, in each the last one first: then
/// the limbs of a tree are apart in the matrices.
class StepMatrix {
 public:
  /// Without constraints.
  void build(const Mechanism& mechanism, std::span<const DofRange> trees);
  /// Takes the constraints as they are now in place of those before.
  void constrain(const LinearConstraints& constraints);

  int size() const { return static_cast<int>(dofs_.size()); }
  /// The degrees of freedom of the mechanism, by the numbers here, and the other way.
  std::span<const int> dofs() const { return dofs_; }
  int number(int dof) const { return numbers_[static_cast<std::size_t>(dof)]; }
  /// The trees, by the numbers here.
  const DofRange& tree(int i) const { return trees_[static_cast<std::size_t>(i)]; }
  /// Where the tree of a degree of freedom begins.
  int tree_begin(int i) const { return tree_of_[static_cast<std::size_t>(i)]; }

  bool is_symmetric() const {
    return free_factor_.is_symmetric() && (!converts_ || column_count_ == 0);
  }
  /// The first column of each row of H.
  std::span<const int> envelope() const { return envelope_; }
  /// H, made when it is first asked for.
  const EnvelopeMatrix& matrix();
  /// What the constraints add to the forces t, by the numbers here.
  std::span<const double> load() const { return load_; }

  /// H^-1 x, by the numbers here, in place; and the acceleration that the solver of
  /// constraints finds under the forces x.
  void solve(std::vector<double>& x);
  void accelerate(std::vector<double>& x);

  /// A constraint's column of G, and what carries it: numbers, ascending.
  struct Column {
    std::vector<int> support;
    std::vector<double> values;       // G
    std::vector<double> forced;       // D^-1 U^-1 G, of the factors of Mh = U D L
    std::vector<double> constrained;  // L'^-1 G; of the factors of M where it converts
  };
  std::span<const Column> columns() const { return {columns_.data(), column_count_}; }
  /// Whether the solver's acceleration is not that of the step.
  bool converts() const { return converts_; }
  const TreeMatrix& free_factor() const { return free_factor_; }
  /// Of what constraints divide by: M, or Mh where the solver's acceleration is that of the step.
  const TreeMatrix& constraint_factor() const { return converts_ ? mass_factor_ : free_factor_; }
  /// (1 + P' Mh^-1 G)^-1, factored.
  const EnvelopeMatrix& coupling() const { return coupling_; }

  /// With the numbers, those of all that carries them, ascending.
  void close(std::vector<int>& numbers);

 private:
  const TreeMatrix& free() const { return is_damped_ ? free_ : mass_; }
  void number_dofs(const MechanismTrees& mechanism, std::span<const DofRange> trees);
  void make_mass(const Mechanism& mechanism);
  bool add_extra();
  void factor_mass();
  void sort_columns(const LinearConstraints& constraints);
  void take_columns(const LinearConstraints& constraints);
  void widen_envelope();
  void couple();
  void release(std::vector<double>& x);

  std::vector<DofRange> trees_;
  std::vector<int> dofs_, numbers_, parents_, tree_of_;
  DofTrees carriers_;
  std::vector<int> free_envelope_, envelope_;
  std::vector<DofEntry> entries_;  // of the mechanism
  TreeMatrix mass_, mass_factor_;  // M
  TreeMatrix free_, free_factor_;  // Mh, where it is not M
  bool is_damped_ = false;
  bool makes_mass_factor_ = false;
  bool converts_ = false;
  std::vector<Column> columns_;
  std::size_t column_count_ = 0;
  EnvelopeMatrix coupling_, matrix_;
  bool has_matrix_ = false;
  std::vector<std::pair<int, int>> order_;  // of columns: least number, number of the constraint's
  std::vector<int> first_, first_of_tree_;
  std::vector<double> load_, dense_, product_, shares_;
  std::vector<char> marked_;
};

}  // namespace volcontact
