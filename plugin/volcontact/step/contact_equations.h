// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/step/contact_space.h"
#include "volcontact/step/matrix/dense_matrix.h"

namespace volcontact {

/// The equations of a linearly implicit step: f = e - C u' at contact places, u' = u_free + h
/// Lambda f, with C = L L' positive semidefinite. docs/theory.md, "Implicit step". Memory is reused
/// from solution to solution.
struct ContactEquations {
  /// C of one place. Friction knows nothing of the other three coordinates, nor its own of each
  /// other.
  struct Slope {
    Mat3 normal = Mat3::Zero();    ///< of the first three coordinates
    Vec3 friction = Vec3::Zero();  ///< its diagonal, of the last three

    bool operator==(const Slope&) const = default;
    bool is_zero() const { return friction.isZero(0.0) && normal.isZero(0.0); }
    ContactSpace::Block operator*(const ContactSpace::Block& u) const {
      ContactSpace::Block out;
      (normal * u.head<3>()).to(out.data());
      friction.cwiseProduct(u.tail<3>()).to(out.data() + 3);
      return out;
    }
  };
  std::vector<Slope> slopes;     ///< C, by places
  std::vector<double> constant;  ///< e
  /// Whether friction may come before `forget`: then its unknowns are there from the first matrix.
  bool may_rub = true;

  /// To be called when the space, or the step, is another one: until then a matrix of the same C is
  /// factored once.
  void forget();

  /// Writes f and u', with f = e - C u' to rounding; the motion that f makes, which the space
  /// knows, may be off by more. In the form of less work: for the forces, (1 + h L' Lambda L) y =
  /// L' (u_free + h Lambda e), f = e - L y, or for the velocities, (H + h J' C J) dv = h (t + J' (e
  /// - C u)).
  void solve(ContactSpace& space, double step, std::vector<double>& force,
             std::vector<double>& velocity);

  // The two forms, of which a test wants both.
  void solve_for_forces(ContactSpace& space, double step, std::vector<double>& force,
                        std::vector<double>& velocity);
  void solve_for_dofs(ContactSpace& space, double step, std::vector<double>& force,
                      std::vector<double>& velocity);

 private:
  // A matrix that was factored, of this C.
  struct ByDofs {
    std::vector<Slope> slopes;
    bool is_valid = false;
    EnvelopeMatrix matrix;
  };
  // 1 + h L' Lambda L, where the first three coordinates of all places, n, are eliminated first:
  // friction, which has the others, s, changes from solution to solution. What is left of them
  // before they get their roots is R, and the matrix of friction 1 + Ls' R Ls.
  struct ByForces {
    bool is_valid = false;
    bool rubs = false;                 // has R
    std::vector<Mat3> slopes;          // C of n, by places
    std::vector<int> pressed;          // the places where C is not zero, and there
    std::vector<Mat3> roots;           // Ln
    std::vector<Vec3> inverse_roots;   // of its diagonal, 0 where that is
    DenseMatrix pressing;              // of n, then s
    std::vector<Vec3> whole;           // of h Lambda_ss the diagonal
    std::vector<Vec3> frictions;       // C of s that was factored
    std::vector<Vec3> friction_roots;  // Ls
    DenseMatrix rubbing;
  };

  bool has_friction() const;
  void add_slope(const ContactSpace& space, int place, double step, EnvelopeMatrix& matrix) const;
  void factor(ContactSpace& space, double step, ByDofs& out) const;
  bool is_of_normal_slopes() const;
  void factor_normal(const ContactSpace& space, double step);
  void set_columns(const ContactSpace& space, double step, int k);
  bool knows_all_that_rub() const;
  bool is_of_frictions() const;
  void factor_friction();
  void keep_to_slopes(std::vector<double>& velocity) const;
  void take_off(const ContactSpace& space, double step, std::vector<double>& force);

  // Without and with friction: one of the two comes back as it was, under other constants.
  ByDofs normal_by_dofs_, by_dofs_;
  ByForces by_;
  std::vector<double> pressing_, rubbing_;  // the right sides of n and s, and of s alone
  std::vector<double> right_, response_, responses_;
};

}  // namespace volcontact
