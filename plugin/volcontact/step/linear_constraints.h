// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "volcontact/step/contact_islands.h"

namespace volcontact {

/// The native constraints of one step, as the solver of whoever steps the bodies will meet them. It
/// finds the acceleration a with M a = t + Jc' f, where f is minus the slope of a convex cost of Jc
/// a
/// - a_ref. Here f is linear around a guess of a, which an island takes into its step:
/// docs/theory.md, "Native constraints". Memory is reused from step to step.
class LinearConstraints {
 public:
  /// Part of a sparse row.
  struct Entry {
    int dof;
    double value;
  };

  LinearConstraints() = default;
  virtual ~LinearConstraints() = default;

  /// Pairs of degrees of freedom that are joined by some constraint.
  std::span<const std::pair<int, int>> joined() const { return joined_; }

  /// Goes on to an island, with the first guess.
  void select(const ContactIslands& islands, int island);

  /// Whether the island has any.
  bool empty() const { return rows_.empty(); }

  /// Takes the acceleration of all degrees of freedom as the next guess. Returns whether the forces
  /// of the one before were right there already.
  bool improve(std::span<const double> acceleration);

  // The forces of the island around the guess: Jc' f = load - G G' a.

  std::span<const Entry> load() const { return load_; }
  int columns() const { return static_cast<int>(column_begin_.size()) - 1; }
  /// A column of G.
  std::span<const Entry> column(int i) const { return part(columns_, column_begin_, i); }

 protected:
  LinearConstraints(const LinearConstraints&) = default;
  LinearConstraints& operator=(const LinearConstraints&) = default;

  // What the solver's owner says: all rows of Jc with a_ref, by begin_rows(), add_entry() and
  // end_row(); and at each guess, by respond(), how rows answer.

  void begin_rows();
  void add_entry(int dof, double value) { jacobian_.push_back({dof, value}); }
  std::span<const Entry> end_row(double reference);
  void join(int dof, int other) { joined_.emplace_back(dof, other); }
  /// The first guess, by degree of freedom, in place of that nothing accelerates. Where no rows
  /// know each other, it tells nothing but which of them push: the forces at the end are the same.
  void guess(std::span<const double> acceleration) {
    guess_.assign(acceleration.begin(), acceleration.end());
  }

  /// Where x = Jc a - a_ref of all rows is `violation`: answers with set_response() for each of
  /// `rows`, and add_cone() for those that know each other.
  virtual void respond(std::span<const int> rows, std::span<const double> violation) = 0;
  /// The force of a row, and -df/dx where it hangs on no other row: of a force -d x, or of 0 for
  /// one that stays.
  void set_response(int row, double force, double slope);
  /// Of `count` rows from `first` on, at most six, -df/dx: symmetric, positive semidefinite,
  /// row-major.
  void add_cone(int first, int count, const double* slope);

 private:
  // The elliptic cone of a contact that slides: f = -L L' x along its rows.
  struct Cone {
    int row;
    int count;
    Matrix<6, 6> factor;
  };
  static std::span<const Entry> part(const std::vector<Entry>& of, const std::vector<int>& begin,
                                     int i) {
    const std::size_t k = static_cast<std::size_t>(i);
    return {of.data() + begin[k], static_cast<std::size_t>(begin[k + 1] - begin[k])};
  }
  std::span<const Entry> row(int i) const { return part(jacobian_, row_begin_, i); }
  bool is_curved() const { return !cones_.empty(); }
  void evaluate();
  void hold_what_turned();
  void subtract_slope(const std::vector<double>& x, std::vector<double>& force) const;
  void make_columns();

  std::vector<Entry> jacobian_;
  std::vector<int> row_begin_ = {0};
  std::vector<double> reference_;  // a_ref by rows
  std::vector<double> guess_;      // empty: nothing accelerates
  std::vector<std::pair<int, int>> joined_;
  std::vector<int> rows_;  // of the island
  // By rows: x = Jc a - a_ref at the guess, f there, and -df/dx of rows that know no other.
  std::vector<double> violation_, force_, slope_;
  std::vector<double> way_, linear_, constant_;
  std::vector<Cone> cones_;
  std::vector<Entry> load_, columns_;
  std::vector<int> column_begin_ = {0};
};

/// Of a step without any.
class NoConstraints final : public LinearConstraints {
  void respond(std::span<const int> /*rows*/, std::span<const double> /*violation*/) override {}
};

}  // namespace volcontact
