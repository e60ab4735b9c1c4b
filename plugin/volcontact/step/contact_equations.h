// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/step/block_matrix.h"
#include "volcontact/step/contact_space.h"

namespace volcontact {

/// The equations of a linearly implicit step: f = e - C u' at contact places, u' = u_free + h
/// Lambda f, with C = L L' positive semidefinite, of blocks of three coordinates of a place: motion
/// along n and turns about t_1 and t_2, and friction. docs/theory.md, "Implicit step". Memory is
/// reused from solution to solution.
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
  using Squares = std::vector<Mat3>;
  // C by places, its two blocks.
  struct Slopes {
    Squares normal, friction;

    bool operator==(const Slopes&) const = default;
  };
  struct ByDofs {
    Slopes slopes;
    bool is_valid = false;
    EnvelopeMatrix matrix;
  };
  // One of the two blocks of each place that has it; factored under these C.
  struct ByForces {
    Squares slopes;
    bool is_valid = false;
    std::vector<int> active;  // the places that have it
    Squares factors;          // L by place
    BlockMatrix<3> matrix;
  };

  void make_slopes(int places);
  bool has_friction() const;
  void add_slope(const ContactSpace& space, int place, double step, EnvelopeMatrix& matrix) const;
  void factor(ContactSpace& space, double step, ByDofs& out) const;
  void take_factors(const Squares& slopes, ByForces& out) const;
  void factor_normal(const ContactSpace& space, double step);
  void couple(const ContactSpace& space, double step);
  void factor_friction(const ContactSpace& space, double step);
  void solve_friction(const ContactSpace& space, double step, std::vector<double>& force);

  Slopes slopes_;
  // Without and with friction: one of the two comes back as it was, under other constants.
  ByDofs normal_by_dofs_, by_dofs_;
  // Friction alone changes from pass to pass: it is solved for on what moves once the normal forces
  // have answered.
  ByForces normal_, friction_;
  bool is_coupled_ = false;
  Squares forth_;     // by friction place and normal place: L' Lambda
  Squares back_;      // likewise: (1 + h L' Lambda L)^-1 L' Lambda, of the normal forces
  Squares mobility_;  // of two friction places, when the normal forces answer
  std::vector<double> right_, friction_right_, response_;
};

}  // namespace volcontact
