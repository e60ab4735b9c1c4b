// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/step/block_matrix.h"
#include "volcontact/step/contact_space.h"

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
  // A matrix that was factored, of this C.
  struct Factored {
    std::vector<Slope> slopes;
    bool is_valid = false;
  };
  // L of one place: lower triangular, and its diagonal.
  struct Root {
    Mat3 normal;
    Vec3 friction;
  };
  struct ByDofs : Factored {
    EnvelopeMatrix matrix;
  };
  template <int K>
  struct ByForces : Factored {
    BlockMatrix<K> matrix;
    std::vector<Root> roots;  // by places
    std::vector<int> active;  // the places where C is not zero
  };

  bool has_friction() const;
  bool is_of_slopes(const Factored& factored) const;
  void add_slope(const ContactSpace& space, int place, double step, EnvelopeMatrix& matrix) const;
  void factor(ContactSpace& space, double step, ByDofs& out) const;
  template <int K>
  void factor(const ContactSpace& space, double step, ByForces<K>& out) const;
  template <int K>
  void solve_blocks(const ContactSpace& space, double step, ByForces<K>& by,
                    std::vector<double>& force);

  // Without and with friction: one of the two comes back as it was, under other constants.
  ByDofs normal_by_dofs_, by_dofs_;
  ByForces<3> normal_by_forces_;  // by the first three coordinates of each place alone
  ByForces<kRows> by_forces_;
  std::vector<double> right_, response_;
};

}  // namespace volcontact
