// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "volcontact/base/sizes.h"
#include "volcontact/step/contact_islands.h"
#include "volcontact/step/matrix/place_columns.h"
#include "volcontact/step/step_matrix.h"

namespace volcontact {

/// What one step makes of forces at the contact places of an island: u' = u_free + h
/// Lambda f, with u = J v + w, Lambda = J H^-1 J' and u_free = u + h J H^-1 t; w is the motion of
/// mocap bodies. H is the matrix of the step: step_matrix.h. What does not change with native
/// constraints is made once. Memory is reused from step to step.
class ContactSpace {
 public:
  using Block = Vector<kRows>;
  using Square = Matrix<kRows, kRows>;

  /// A column of J at one place that is not zero.
  struct Move {
    PlaceColumn column;
    int dof;  ///< its number in `matrix`
  };

  /// `known`: t, all generalized forces but those at the places and of constraints, one number a
  /// degree of freedom.
  void build(const Mechanism& mechanism, std::span<const ContactPlace> places,
             const ContactIslands& islands, int island, const double* known);
  /// Takes the native constraints as they are now in place of those before.
  void constrain(const LinearConstraints& constraints);

  int places() const { return static_cast<int>(move_begin_.size()) - 1; }
  int rows() const { return places() * kRows; }
  int dofs() const { return static_cast<int>(known_.size()); }
  /// J at one place, by ascending degrees of freedom of each of its trees.
  std::span<const Move> moves(int place) const {
    const std::size_t i = static_cast<std::size_t>(place);
    return {moves_.data() + move_begin_[i], move_begin_[i + 1] - move_begin_[i]};
  }
  /// H.
  StepMatrix& matrix() { return matrix_; }
  bool is_symmetric() const { return matrix_.is_symmetric(); }
  /// The first column of each row of H + J' C J, whatever C is.
  std::span<const int> envelope() const { return envelope_; }
  /// Whether it is cheaper to solve for the velocities of the degrees of freedom than for forces.
  bool prefers_dofs() const { return prefers_dofs_; }
  /// Makes `mobility`, and `delassus` where it is of use.
  void build_mobility();
  void build_delassus();
  /// Six columns of Lambda, padded to `stride` numbers, after build_delassus().
  const double* delassus(int place) const {
    const std::vector<double>& all = matrix_.columns().empty() ? free_delassus_ : delassus_;
    return all.data() + kRows * size(place) * stride_;
  }
  std::size_t stride() const { return stride_; }
  /// The block of Lambda of one place.
  const Square& mobility(std::size_t place) const {
    return (matrix_.columns().empty() ? free_mobility_ : mobility_)[place];
  }
  const std::vector<double>& known() const { return known_; }
  const std::vector<double>& velocity() const { return velocity_; }
  /// u and u_free of one place.
  Block velocity(std::size_t place) const { return Block::from(&velocity_[kRows * place]); }
  Block free_velocity(std::size_t place) const { return Block::from(&free_[kRows * place]); }
  /// u' under the forces f: by the degrees of freedom, and by Lambda after build_delassus().
  void move(const std::vector<double>& f, std::vector<double>& u);
  void move_by_delassus(const double* f, double* u);
  /// The acceleration that the solver of native constraints finds under the forces f, into those of
  /// all degrees of freedom that are of the island.
  void accelerate(const std::vector<double>& f, std::vector<double>& a);
  /// Adds J' f to numbers by degree of freedom, and J x to those by row.
  void add_load(const double* f, double* load) const;
  void add_motion(const double* x, double* u) const;

 private:
  // What a place moves and what carries that.
  std::span<const CarriedColumn> carried(int place) const {
    const std::size_t i = static_cast<std::size_t>(place);
    return {carried_.data() + carried_begin_[i], carried_begin_[i + 1] - carried_begin_[i]};
  }
  std::span<CarriedColumn> carried(int place) {
    const std::size_t i = static_cast<std::size_t>(place);
    return {carried_.data() + carried_begin_[i], carried_begin_[i + 1] - carried_begin_[i]};
  }
  void add_place(const Mechanism& mechanism, const ContactPlace& place, std::pair<int, int> trees);
  void add_body(const Mechanism& mechanism, const ContactPlace& place, int body, double sign);
  void add_driven(const ContactPlace& place);
  void widen_envelope(int place);
  void choose_form();
  void carry(int place, const TreeMatrix& factor, bool upper, PlaceColumn CarriedColumn::* out);
  void respond();
  void constrain_places();
  void set_free_block(int i, int k, const Square& block);
  void make_free_row(int place, int end);
  void constrain_mobility();

  StepMatrix matrix_;
  std::vector<Move> moves_;
  std::vector<std::size_t> move_begin_ = {0};
  std::vector<CarriedColumn> carried_;
  std::vector<std::size_t> carried_begin_;
  bool is_massed_ = false;
  std::vector<int> support_;
  // J Mh^-1 G by columns, padded; and of each place, (1 + P' Mh^-1 G)^-1 P' Mh^-1 J' by rows.
  std::vector<double> opened_;
  std::vector<Block> closed_;
  std::vector<PlaceColumn> dense_;  // of each degree of freedom, zeros between uses
  std::vector<double> scalars_;     // one a degree of freedom, likewise
  std::vector<char> is_in_tree_;    // of a column, by the tree's first degree of freedom; likewise
  std::vector<int> envelope_;
  std::vector<Square> mobility_, free_mobility_;
  std::vector<double> delassus_, free_delassus_;  // by columns, padded
  std::size_t stride_ = 0;                        // of these
  std::vector<double> impelled_;                  // Lambda f, padded
  bool has_responses_ = false, has_free_delassus_ = false;
  std::vector<double> free_known_, known_, velocity_, free_, generalized_;
  bool prefers_dofs_ = true;
  double step_ = 0.0;
};

}  // namespace volcontact
