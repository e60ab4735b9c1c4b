// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "adaptor/step/contact_space.h"

namespace volcontact::adaptor {

/// The equations of a linearly implicit step: f = e - C u' at contact places, u' = u_free + h
/// Lambda f, with C = L L' positive semidefinite and the columns of L within three coordinates of a
/// place each. docs/theory.md, "Implicit step". Memory is reused from solution to solution.
struct ContactEquations {
  /// A column of L: its numbers and the first of the three coordinates they are for.
  struct Column {
    Vec3 numbers;
    int first;
  };
  std::vector<Column> columns;
  std::vector<double> constant;  ///< e

  /// Writes f and u'. In the form that is the smaller one: for the forces,
  /// (1 + h L' Lambda L) y = L' (u_free + h Lambda e), f = e - L y, or for the velocities,
  /// (H + h J' C J) dv = h (t + J' (e - C u)), the only one where H is not symmetric or joins
  /// trees.
  void solve(const ContactSpace& space, double step, std::vector<double>& force,
             std::vector<double>& velocity) noexcept;

  // The two forms, of which a test wants both.
  void solve_for_forces(const ContactSpace& space, double step, std::vector<double>& force,
                        std::vector<double>& velocity) noexcept;
  void solve_for_dofs(const ContactSpace& space, double step, std::vector<double>& force,
                      std::vector<double>& velocity) noexcept;

 private:
  using Slope = Eigen::Matrix<double, kRows, kRows>;

  void add_slope(const ContactSpace& space, int place, double step) noexcept;

  EnvelopeMatrix matrix_;
  std::vector<Slope> slopes_;  // C by places
  std::vector<double> right_, response_;
  std::vector<int> full_;
};

}  // namespace volcontact::adaptor
