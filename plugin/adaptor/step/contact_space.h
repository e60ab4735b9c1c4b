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
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using Block = Eigen::Matrix<double, kRows, 1>;
  /// A row a coordinate of the place, a column a degree of freedom of one tree.
  using Rows = Eigen::Map<const Eigen::Matrix<double, kRows, Eigen::Dynamic>>;

  /// What a place has to do with one tree: columns begin ... end - 1 of J and of J H^-1.
  struct Side {
    int begin = 0;
    int end = 0;
    std::ptrdiff_t start = 0;  // of its numbers

    int size() const { return end - begin; }
  };

  /// `known`: t, all generalized forces but those at the places and of constraints, nv numbers.
  /// Uses the mass matrix and the positions that are current in `d`, and what make_damping() left.
  void build(const mjModel* m, mjData* d, Damping damping, std::span<const ContactPlace> places,
             const ContactIslands& islands, int island, const NativeConstraints& constraints,
             const double* known) noexcept;

  int rows() const { return static_cast<int>(sides_.size()) * kRows; }
  int dofs() const { return static_cast<int>(known_.size()); }
  /// The trees of a place: one or two.
  std::span<const Side> sides(int place) const {
    return {sides_[static_cast<std::size_t>(place)].data(),
            static_cast<std::size_t>(side_count_[static_cast<std::size_t>(place)])};
  }
  Rows jacobian(const Side& side) const { return {&jacobian_[at(side)], kRows, side.size()}; }
  Rows response(const Side& side) const { return {&response_[at(side)], kRows, side.size()}; }
  /// H.
  const EnvelopeMatrix& matrix() const { return matrix_.matrix(); }
  /// The first column of each row of H + J' C J, whatever C is.
  std::span<const int> envelope() const { return envelope_; }
  /// Whether it is cheaper to solve for the velocities of the degrees of freedom than for forces.
  bool prefers_dofs() const { return prefers_dofs_; }
  /// Makes J H^-1 and what is made of it: `mobility`, and `delassus` where it is of use.
  void build_mobility() noexcept;
  void build_delassus() noexcept;
  /// Lambda.
  Eigen::Map<const RowMajor> delassus() const { return {delassus_.data(), rows(), rows()}; }
  /// The block of Lambda of one place.
  const Eigen::Matrix<double, kRows, kRows>& mobility(std::size_t place) const {
    return mobility_[place];
  }
  Eigen::Map<const Eigen::VectorXd> known() const { return {known_.data(), dofs()}; }
  Eigen::Map<const Eigen::VectorXd> velocity() const { return {velocity_.data(), rows()}; }
  Eigen::Map<const Eigen::VectorXd> free_velocity() const { return {free_.data(), rows()}; }
  /// u' under the forces f.
  void move(const std::vector<double>& f, std::vector<double>& u) noexcept;
  /// The acceleration that MuJoCo's solver finds under the forces f, into those of the nv numbers
  /// that are of the island.
  void accelerate(const std::vector<double>& f, std::vector<double>& a) noexcept;
  /// Adds J' f to numbers by degree of freedom, and J x to those by row.
  void add_load(const double* f, double* load) const noexcept;
  void add_motion(const double* x, double* u) const noexcept;

 private:
  std::size_t at(const Side& side) const { return static_cast<std::size_t>(side.start); }
  void add_place(const mjModel* m, const mjData* d, const ContactPlace& place,
                 std::pair<int, int> trees) noexcept;
  Side add_side(int tree) noexcept;
  void add_body(const mjModel* m, const mjData* d, const ContactPlace& place, int body, double sign,
                const Side& side) noexcept;
  void add_driven(const ContactPlace& place) noexcept;
  void widen_envelope(std::size_t place) noexcept;
  void respond(int place) noexcept;

  StepMatrix matrix_;
  std::vector<std::array<Side, 2>> sides_;
  std::vector<int> side_count_;
  std::vector<double> jacobian_, response_;
  std::vector<int> envelope_;
  std::vector<Eigen::Matrix<double, kRows, kRows>> mobility_;
  std::vector<double> known_, delassus_, velocity_, free_, generalized_;
  bool prefers_dofs_ = true;
  double step_ = 0.0;
};

/// All that acts on the degrees of freedom beside the contacts and MuJoCo's constraints, nv
/// numbers: passive forces so far, bias, actuators at the present state, and what the user applied,
/// given as `user_qfrc` (nv) and `user_xfrc` (6 nbody).
void known_forces(const mjModel* m, mjData* d, const double* user_qfrc, const double* user_xfrc,
                  std::vector<double>& out) noexcept;

}  // namespace volcontact::adaptor
