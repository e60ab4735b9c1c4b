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
  void make_slopes(int places);
  void add_slope(const ContactSpace& space, int place, double step);
  // Forces by the first K coordinates of each place alone: the others have no columns.
  template <int K>
  void solve_blocks(const ContactSpace& space, double step, BlockMatrix<K>& matrix,
                    std::vector<double>& force);

  EnvelopeMatrix matrix_;
  BlockMatrix<3> normal_;
  BlockMatrix<kRows> all_;
  std::vector<ContactSpace::Square> slopes_;   // C by places
  std::vector<ContactSpace::Square> factors_;  // L of C = L L'
  std::vector<int> active_;                    // the places with columns
  std::vector<double> right_, response_;
};

}  // namespace volcontact
