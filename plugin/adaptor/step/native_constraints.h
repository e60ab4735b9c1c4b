// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <utility>
#include <vector>

#include "adaptor/step/contact_islands.h"

namespace volcontact::adaptor {

/// MuJoCo's own constraints in one step, as its solver will meet them: joint and tendon limits,
/// equalities, dry friction of joints, native contacts. It finds the acceleration a with
/// M a = t + Jc' f, where f is minus the slope of a convex cost of Jc a - a_ref. Here f is linear
/// around a guess of a, which the island takes into its step: docs/theory.md, "Native
/// constraints". Memory is reused from step to step.
class NativeConstraints {
 public:
  /// Part of a sparse row.
  struct Entry {
    int dof;
    double value;
  };

  /// Takes the constraints that are at hand in `d`.
  void read(const mjModel* m, mjData* d);

  /// Pairs of degrees of freedom that are joined by some constraint.
  std::span<const std::pair<int, int>> joined() const { return joined_; }

  /// Goes on to an island, with the guess that nothing accelerates: as at rest.
  void select(const mjModel* m, mjData* d, const ContactIslands& islands, int island);

  /// Whether the island has any.
  bool empty() const { return rows_.empty(); }

  /// Takes the acceleration, nv numbers, as the next guess. Returns whether the forces of the one
  /// before were right there already.
  bool improve(const mjModel* m, mjData* d, std::span<const double> acceleration);

  // The forces of the island around the guess: Jc' f = load - G G' a.

  std::span<const Entry> load() const { return load_; }
  int columns() const { return static_cast<int>(column_begin_.size()) - 1; }
  /// A column of G.
  std::span<const Entry> column(int i) const { return part(columns_, column_begin_, i); }

 private:
  // The elliptic cone of a contact that slides: f = -L L' x along its rows.
  struct Cone {
    int row;
    int count;
    Eigen::Matrix<double, 6, 6> factor;
  };
  static std::span<const Entry> part(const std::vector<Entry>& of, const std::vector<int>& begin,
                                     int i) {
    const std::size_t k = static_cast<std::size_t>(i);
    return {of.data() + begin[k], static_cast<std::size_t>(begin[k + 1] - begin[k])};
  }
  std::span<const Entry> row(int i) const { return part(jacobian_, row_begin_, i); }
  void evaluate(const mjModel* m, mjData* d);
  void add_cone(const mjData* d, int row);
  void subtract_slope(const std::vector<double>& x, std::vector<double>& force) const;
  void make_columns(const mjData* d);

  std::vector<Entry> jacobian_;
  std::vector<int> row_begin_ = {0};
  std::vector<std::pair<int, int>> joined_;
  std::vector<int> rows_;  // of the island
  // By rows: x = Jc a - a_ref at the guess, f there, and -df/dx of rows that know no other.
  std::vector<double> violation_, force_, slope_;
  std::vector<double> way_, linear_, constant_;
  std::vector<Cone> cones_;
  std::vector<Entry> load_, columns_;
  std::vector<int> column_begin_ = {0};
};

}  // namespace volcontact::adaptor
