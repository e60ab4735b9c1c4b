// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "adaptor/step/contact_islands.h"
#include "adaptor/step/step_matrix.h"

namespace volcontact::adaptor {

inline constexpr int kRows = 6;  ///< of a contact place: along and about its three axes

/// What one step of MuJoCo makes of forces at the contact places of an island: u' = u_free + h
/// Lambda f, with u = J v + w, Lambda = J H^-1 J' and u_free = u + h J H^-1 t; w is the motion of
/// mocap bodies. H is the matrix of the step: step_matrix.h. Memory is reused from step to step.
class ContactSpace {
 public:
  using Block = Eigen::Matrix<double, kRows, 1>;
  using Square = Eigen::Matrix<double, kRows, kRows>;

  /// A column of J at one place that is not zero.
  struct Move {
    Block column;
    int dof;  ///< its number in `matrix`
  };

  /// `known`: t, all generalized forces but those at the places and of constraints, nv numbers.
  /// Uses the mass matrix and the positions that are current in `d`, and what make_damping() left.
  void build(const mjModel* m, mjData* d, Damping damping, std::span<const ContactPlace> places,
             const ContactIslands& islands, int island, const NativeConstraints& constraints,
             const double* known) noexcept;

  int places() const { return static_cast<int>(move_begin_.size()) - 1; }
  int rows() const { return places() * kRows; }
  int dofs() const { return static_cast<int>(known_.size()); }
  /// J at one place, by ascending degrees of freedom of each of its trees.
  std::span<const Move> moves(int place) const {
    const std::size_t i = static_cast<std::size_t>(place);
    return {moves_.data() + move_begin_[i], move_begin_[i + 1] - move_begin_[i]};
  }
  /// H.
  const EnvelopeMatrix& matrix() const { return matrix_.matrix(); }
  /// The first column of each row of H + J' C J, whatever C is.
  std::span<const int> envelope() const { return envelope_; }
  /// Whether it is cheaper to solve for the velocities of the degrees of freedom than for forces.
  bool prefers_dofs() const { return prefers_dofs_; }
  /// Makes H^-1 J' and what is made of it: `mobility`, and `delassus` where it is of use.
  void build_mobility() noexcept;
  void build_delassus() noexcept;
  /// The block of Lambda of two places, after build_delassus(); of a symmetric H with k <= i.
  const Square& delassus(int i, int k) const {
    return delassus_[static_cast<std::size_t>(i) * static_cast<std::size_t>(places()) +
                     static_cast<std::size_t>(k)];
  }
  /// The block of Lambda of one place.
  const Square& mobility(std::size_t place) const { return mobility_[place]; }
  Eigen::Map<const Eigen::VectorXd> known() const { return {known_.data(), dofs()}; }
  Eigen::Map<const Eigen::VectorXd> velocity() const { return {velocity_.data(), rows()}; }
  Eigen::Map<const Eigen::VectorXd> free_velocity() const { return {free_.data(), rows()}; }
  /// u' under the forces f: by the degrees of freedom, and by Lambda after build_delassus().
  void move(const std::vector<double>& f, std::vector<double>& u) noexcept;
  void move_by_delassus(const double* f, double* u) const noexcept;
  /// The acceleration that MuJoCo's solver finds under the forces f, into those of the nv numbers
  /// that are of the island.
  void accelerate(const std::vector<double>& f, std::vector<double>& a) noexcept;
  /// Adds J' f to numbers by degree of freedom, and J x to those by row.
  void add_load(const double* f, double* load) const noexcept;
  void add_motion(const double* x, double* u) const noexcept;

 private:
  // The degrees of freedom of one tree, or all of an island, and where their rows of H^-1 J' are.
  struct Side {
    int begin = 0;
    int end = 0;
    std::size_t start = 0;
  };
  std::span<const Side> sides(int place) const {
    const std::size_t i = static_cast<std::size_t>(place);
    return {sides_[i].data(), static_cast<std::size_t>(side_count_[i])};
  }
  void add_place(const mjModel* m, const mjData* d, const ContactPlace& place,
                 std::pair<int, int> trees) noexcept;
  void add_body(const mjModel* m, const mjData* d, const ContactPlace& place, int body,
                double sign) noexcept;
  void add_driven(const ContactPlace& place) noexcept;
  void widen_envelope(int place) noexcept;
  void choose_form() noexcept;
  void respond(int place) noexcept;
  Square moved_by(int place, int other) const noexcept;

  StepMatrix matrix_;
  std::vector<Move> moves_;
  std::vector<std::size_t> move_begin_ = {0};
  std::vector<std::array<Side, 2>> sides_;  // of each place
  std::vector<int> side_count_;
  std::vector<double> response_;
  std::vector<double> dense_;  // kRows numbers a degree of freedom, zeros but within add_place()
  std::vector<int> envelope_;
  std::vector<Square> mobility_, delassus_;
  std::vector<double> known_, velocity_, free_, generalized_;
  bool prefers_dofs_ = true;
  double step_ = 0.0;
};

/// All that acts on the degrees of freedom beside the contacts and MuJoCo's constraints, nv
/// numbers: passive forces so far, bias, actuators at the present state, and what the user applied,
/// given as `user_qfrc` (nv) and `user_xfrc` (6 nbody).
void known_forces(const mjModel* m, mjData* d, const double* user_qfrc, const double* user_xfrc,
                  std::vector<double>& out) noexcept;

}  // namespace volcontact::adaptor
