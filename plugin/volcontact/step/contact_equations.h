// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/step/block_matrix.h"
#include "volcontact/step/contact_space.h"

namespace volcontact {

/// The equations of a linearly implicit step: f = e - C u' at contact places, u' = u_free + h
/// Lambda f, with C = L L' positive semidefinite, of blocks of three coordinates of a place.
/// docs/theory.md, "Implicit step". Memory is reused from solution to solution.
struct ContactEquations {
  /// A part c c' of C: the numbers of c and the first of the three coordinates they are for.
  struct Column {
    Vec3 numbers;
    int first;
  };
  std::vector<Column> columns;
  std::vector<double> constant;  ///< e

  /// To be called when the space, or the step, is another one: until then a matrix of the same C is
  /// factored once.
  void forget();

  /// Writes f and u'. In the form of less work: for the forces,
  /// (1 + h L' Lambda L) y = L' (u_free + h Lambda e), f = e - L y, or for the velocities,
  /// (H + h J' C J) dv = h (t + J' (e - C u)).
  void solve(ContactSpace& space, double step, std::vector<double>& force,
             std::vector<double>& velocity);

  // The two forms, of which a test wants both.
  void solve_for_forces(const ContactSpace& space, double step, std::vector<double>& force,
                        std::vector<double>& velocity);
  void solve_for_dofs(ContactSpace& space, double step, std::vector<double>& force,
                      std::vector<double>& velocity);

 private:
  using Squares = std::vector<ContactSpace::Square>;
  // A matrix that was factored, of these C by places.
  struct Factored {
    Squares slopes;
    bool is_valid = false;
  };
  struct ByDofs : Factored {
    EnvelopeMatrix matrix;
  };
  template <int K>
  struct ByForces : Factored {
    BlockMatrix<K> matrix;
    Squares factors;          // L of C = L L'
    std::vector<int> active;  // the places with columns
  };

  void make_slopes(int places);
  bool has_friction() const;
  bool is_of_slopes(const Factored& factored) const;
  void add_slope(const ContactSpace& space, int place, double step, EnvelopeMatrix& matrix) const;
  void factor(ContactSpace& space, double step, ByDofs& out) const;
  template <int K>
  void factor(const ContactSpace& space, double step, ByForces<K>& out) const;
  template <int K>
  void solve_blocks(const ContactSpace& space, double step, ByForces<K>& by,
                    std::vector<double>& force);

  Squares slopes_;  // C by places
  // Without and with friction: one of the two comes back as it was, under other constants.
  ByDofs normal_by_dofs_, by_dofs_;
  ByForces<3> normal_by_forces_;  // by the first three coordinates of each place alone
  ByForces<kRows> by_forces_;
  std::vector<double> right_, response_;
};

}  // namespace volcontact
