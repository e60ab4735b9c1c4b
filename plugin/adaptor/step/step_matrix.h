// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "adaptor/step/envelope_matrix.h"
#include "adaptor/step/native_constraints.h"

namespace volcontact::adaptor {

/// The matrix H of one step of an island, H dv = h t: what the integrator divides by, Mh = M + N,
/// and what MuJoCo's constraints add, linear around a guess, G G' M^-1 Mh. N is what the integrator
/// takes implicitly of the forces by velocities. Memory is reused from step to step.
///
/// The degrees of freedom have numbers of their own, tree by tree, in each the last one first: then
/// the limbs of a tree are apart in the matrices.
class StepMatrix {
 public:
  /// Uses the mass matrix that is current in `d`, and what make_damping() left there.
  void build(const mjModel* m, const mjData* d, Damping damping, std::span<const DofRange> trees,
             const NativeConstraints& constraints) noexcept;

  int size() const { return static_cast<int>(dofs_.size()); }
  /// The degrees of freedom of the model, by the numbers here, and the other way.
  std::span<const int> dofs() const { return dofs_; }
  int number(int dof) const { return numbers_[static_cast<std::size_t>(dof)]; }
  /// The trees, by the numbers here.
  const DofRange& tree(int i) const { return trees_[static_cast<std::size_t>(i)]; }

  /// H, its factor, and the first column of each row.
  const EnvelopeMatrix& matrix() const { return matrix_; }
  const EnvelopeMatrix& factor() const { return factor_; }
  std::span<const int> envelope() const { return envelope_; }
  /// Whether it is symmetric, without entries between trees.
  bool is_by_trees() const { return column_count_ == 0 && matrix_.is_symmetric(); }
  /// What the constraints add to the forces t, by the numbers here.
  std::span<const double> load() const { return load_; }

  /// Turns the change of the velocities over a step, by the numbers here, into the acceleration
  /// that MuJoCo's solver finds.
  void to_acceleration(std::vector<double>& change, double step) noexcept;

 private:
  // G G' M^-1 Mh = G P', by columns.
  struct Column {
    std::vector<int> numbers;  // where one of the two is not zero, ascending
    std::vector<double> left, right;
  };
  void number_dofs(const mjModel* m, std::span<const DofRange> trees) noexcept;
  void make_mass(const mjModel* m, const mjData* d) noexcept;
  void make_extra(const mjModel* m, const mjData* d, Damping damping) noexcept;
  void take_constraints(const NativeConstraints& constraints) noexcept;
  void add_constraints() noexcept;

  std::vector<DofRange> trees_;
  std::vector<int> dofs_, numbers_;
  std::vector<int> limits_;  // the last degree of freedom of each subtree
  std::vector<int> envelope_;
  EnvelopeMatrix mass_, mass_factor_;  // M
  EnvelopeMatrix extra_;               // N
  EnvelopeMatrix matrix_, factor_;     // H
  bool has_extra_ = false, extra_is_symmetric_ = true;
  bool converts_ = false;  // whether the solver's acceleration is not that of the step
  std::vector<Column> columns_;
  std::size_t column_count_ = 0;
  std::vector<double> load_, dense_, solved_, product_;
};

}  // namespace volcontact::adaptor
