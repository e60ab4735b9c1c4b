// SPDX-License-Identifier: Apache-2.0
#include "volcontact/step/contact_space.h"

#include <algorithm>
#include <utility>

#include "volcontact/base/sizes.h"
#include "volcontact/step/matrix/dense_matrix.h"

namespace volcontact {

// Adds the motion that each degree of freedom beyond the world gives the body at the place.
void ContactSpace::add_body(const Mechanism& mechanism, const ContactPlace& place, int body,
                            double sign) {
  const MechanismTrees& trees = *mechanism.trees;
  const Vec3 offset = place.point - mechanism.origin(trees.tree_of_body[size(body)]);
  const Mat3 to_site = sign * place.axes.transpose();
  for (int dof = trees.last_dof[size(body)]; dof >= 0; dof = trees.carrier[size(dof)]) {
    const Vec3 angular = Mechanism::angular(mechanism.motions, dof);
    const Vec3 turn = to_site * angular;
    const Vec3 way = to_site * (Mechanism::linear(mechanism.motions, dof) + angular.cross(offset));
    const double column[kRows] = {way[2], turn[0], turn[1], way[0], way[1], turn[2]};
    double* const to = dense_[size(matrix_.number(dof))].numbers;
    for (int i = 0; i < kRows; ++i) to[i] += column[i];
  }
}

void ContactSpace::add_place(const Mechanism& mechanism, const ContactPlace& place,
                             std::pair<int, int> trees) {
  const auto [tree_a, tree_b] = trees;
  if (tree_a >= 0) add_body(mechanism, place, place.body_a, 1.0);
  if (tree_b >= 0) add_body(mechanism, place, place.body_b, -1.0);
  const auto take = [&](int tree) {
    for (int dof = matrix_.tree(tree).begin; dof < matrix_.tree(tree).end; ++dof) {
      PlaceColumn& column = dense_[size(dof)];
      if (!column.is_zero()) moves_.push_back({std::exchange(column, {}), dof});
    }
  };
  if (tree_a >= 0) take(tree_a);
  if (tree_b >= 0 && tree_b != tree_a) take(tree_b);
  move_begin_.push_back(moves_.size());
}

// What moves at the place without any degree of freedom.
void ContactSpace::add_driven(const ContactPlace& place) {
  const Vec3 way = place.axes.transpose() * place.driven.linear;
  const Vec3 turn = place.axes.transpose() * place.driven.angular;
  velocity_.insert(velocity_.end(), {way[2], turn[0], turn[1], way[0], way[1], turn[2]});
}

// All that a place moves has to do with each other.
void ContactSpace::widen_envelope(int place) {
  int least = dofs();
  for (const Move& move : moves(place)) least = std::min(least, move.dof);
  for (const Move& move : moves(place)) {
    int& first = envelope_[size(move.dof)];
    first = std::min(first, least);
  }
}

// J of the place, carried through one of the factors, to what carries the place.
void ContactSpace::carry(int place, const TreeMatrix& factor, bool upper,
                         PlaceColumn CarriedColumn::* out) {
  for (const Move& move : moves(place)) dense_[size(move.dof)] = move.column;
  volcontact::carry(factor, upper, support_, dense_.data());
  for (CarriedColumn& one : carried(place)) one.*out = std::exchange(dense_[size(one.dof)], {});
}

// J through the factors of Mh, which fill in nothing but what carries. Forces that stay do without,
// if no native constraint acts.
void ContactSpace::respond() {
  if (has_responses_) return;
  has_responses_ = true;
  const TreeMatrix& factor = matrix_.free_factor();
  const bool is_symmetric = factor.is_symmetric();
  carried_.clear();
  carried_begin_.assign(1, 0);
  is_massed_ = false;
  free_mobility_.resize(size(places()));
  for (int place = 0; place < places(); ++place) {
    support_.clear();
    for (const Move& move : moves(place)) support_.push_back(move.dof);
    matrix_.close(support_);
    const std::size_t begin = carried_.size();
    carried_.resize(begin + support_.size());
    for (std::size_t i = 0; i < support_.size(); ++i) carried_[begin + i].dof = support_[i];
    carried_begin_.push_back(carried_.size());
    carry(place, factor, false, &CarriedColumn::moved);
    if (!is_symmetric) carry(place, factor, true, &CarriedColumn::forced);
    for (CarriedColumn& one : carried(place)) {
      const PlaceColumn& from = is_symmetric ? one.moved : one.forced;
      const double inverse = factor.inverse_pivot(one.dof);
      for (int i = 0; i < kLanes; ++i) one.forced.numbers[i] = inverse * from.numbers[i];
    }
    sum_products(carried(place), free_mobility_[size(place)]);
  }
}

void ContactSpace::set_free_block(int i, int k, const Square& block) {
  double* to = &free_delassus_[kRows * (size(k) * stride_ + size(i))];
  for (int c = 0; c < kRows; ++c, to += stride_) block.col(c).to(to);
}

// J Mh^-1 J' of one place and those before it, or all. That of the place itself is its mobility.
void ContactSpace::make_free_row(int place, int end) {
  set_free_block(place, place, free_mobility_[size(place)]);
  if (place == 0 && end == 1) return;
  const bool is_symmetric = matrix_.free_factor().is_symmetric();
  for (const CarriedColumn& one : carried(place)) dense_[size(one.dof)] = one.moved;
  for (int other = 0; other < end; ++other) {
    if (other == place) continue;
    Square block;
    sum_products(dense_.data(), carried(other), block);
    set_free_block(place, other, block);
    if (is_symmetric) set_free_block(other, place, block.transpose());
  }
  for (const CarriedColumn& one : carried(place)) dense_[size(one.dof)] = {};
}

void ContactSpace::constrain_places() {
  const std::span<const StepMatrix::Column> columns = matrix_.columns();
  opened_.clear();
  closed_.clear();
  if (columns.empty()) return;
  respond();
  if (matrix_.converts() && !is_massed_) {
    is_massed_ = true;
    const TreeMatrix& factor = matrix_.constraint_factor();
    for (int place = 0; place < places(); ++place) {
      support_.clear();
      for (const CarriedColumn& one : carried(place)) support_.push_back(one.dof);
      carry(place, factor, false, &CarriedColumn::massed);
      for (CarriedColumn& one : carried(place)) {
        for (double& number : one.massed.numbers) number *= factor.inverse_pivot(one.dof);
      }
    }
  }
  opened_.assign(stride_ * columns.size(), 0.0);
  closed_.assign(size(places()) * columns.size(), Block::Zero());
  const bool converts = matrix_.converts();
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const StepMatrix::Column& column = columns[c];
    for (const int dof : column.support) is_in_tree_[size(matrix_.tree_begin(dof))] = 1;
    const auto is_near = [&](const CarriedColumn& one) {
      return is_in_tree_[size(matrix_.tree_begin(one.dof))] != 0;
    };
    // For each place of its trees, what the column has in common with J.
    const auto sum_up_all = [&](const std::vector<double>& values,
                                PlaceColumn CarriedColumn::* part, double* out, std::size_t next) {
      for (std::size_t k = 0; k < column.support.size(); ++k) {
        scalars_[size(column.support[k])] = values[k];
      }
      for (int place = 0; place < places(); ++place) {
        const std::span<const CarriedColumn> all = carried(place);
        if (all.empty() || !(is_near(all.front()) || is_near(all.back()))) continue;
        sum_up(all, part, scalars_.data(), out + size(place) * next);
      }
      for (const int dof : column.support) scalars_[size(dof)] = 0.0;
    };
    sum_up_all(column.forced, &CarriedColumn::moved, &opened_[c * stride_], kRows);
    sum_up_all(column.constrained, converts ? &CarriedColumn::massed : &CarriedColumn::forced,
               closed_[c].data(), kRows * columns.size());
    for (const int dof : column.support) is_in_tree_[size(matrix_.tree_begin(dof))] = 0;
  }
  const int count = static_cast<int>(columns.size());
  for (int place = 0; place < places(); ++place) {
    matrix_.coupling().solve<kRows>(closed_[size(place) * columns.size()].data(), 0, count);
  }
}

// Where constraints act, takes off what they do about it.
void ContactSpace::constrain_mobility() {
  const std::size_t count = matrix_.columns().size();
  if (count == 0) return;
  mobility_ = free_mobility_;
  for (std::size_t place = 0; place < mobility_.size(); ++place) {
    for (std::size_t c = 0; c < count; ++c) {
      mobility_[place] -=
          outer(Block::from(&opened_[c * stride_ + kRows * place]), closed_[place * count + c]);
    }
  }
}

void ContactSpace::build_mobility() {
  respond();
  choose_form();
  if (!prefers_dofs_) build_delassus();
  constrain_mobility();
}

// The form of less work, counted in multiplications and weighed as measured. Without symmetry both
// take twice as much.
void ContactSpace::choose_form() {
  constexpr double kBlocks = 2.0, kPairs = 20.0;
  double by_dofs = 0.0;
  for (std::size_t i = 0; i < envelope_.size(); ++i) {
    const double width = static_cast<double>(i) + 1.0 - envelope_[i];
    by_dofs += 0.5 * width * width;
  }
  for (int place = 0; place < places(); ++place) {
    const double count = static_cast<double>(moves(place).size());
    by_dofs += kRows * count * count;
  }
  const double count = places();
  prefers_dofs_ = by_dofs <= (kBlocks * count + kPairs) * count * count;
}

void ContactSpace::build_delassus() {
  const int count = places();
  if (!has_free_delassus_) {
    has_free_delassus_ = true;
    free_delassus_.assign(size(rows()) * stride_, 0.0);
    const bool is_symmetric = matrix_.free_factor().is_symmetric();
    for (int i = 0; i < count; ++i) make_free_row(i, is_symmetric ? i + 1 : count);
  }
  if (matrix_.columns().empty()) return;
  delassus_.resize(free_delassus_.size());
  subtract_product(free_delassus_.data(), rows(), opened_.data(), closed_.data()->data(),
                   static_cast<int>(matrix_.columns().size()), delassus_.data());
}

void ContactSpace::move_by_delassus(const double* f, double* u) {
  impelled_.resize(stride_);
  multiply(delassus(0), rows(), f, impelled_.data());
  for (std::size_t i = 0; i < free_.size(); ++i) u[i] = free_[i] + step_ * impelled_[i];
}

void ContactSpace::add_load(const double* f, double* load) const {
  for (int place = 0; place < places(); ++place) {
    const Block force = Block::from(f + kRows * place);
    for (const Move& move : moves(place)) load[move.dof] += move.column.rows().dot(force);
  }
}

void ContactSpace::add_motion(const double* x, double* u) const {
  for (int place = 0; place < places(); ++place) {
    Block motion = Block::from(u + kRows * place);
    for (const Move& move : moves(place)) motion += x[move.dof] * move.column.rows();
    motion.to(u + kRows * place);
  }
}

void ContactSpace::move(const std::vector<double>& f, std::vector<double>& u) {
  generalized_.assign(size(dofs()), 0.0);
  add_load(f.data(), generalized_.data());
  for (double& load : generalized_) load *= step_;
  matrix_.solve(generalized_);
  std::copy(free_.begin(), free_.end(), u.begin());
  add_motion(generalized_.data(), u.data());
}

void ContactSpace::accelerate(const std::vector<double>& f, std::vector<double>& a) {
  generalized_ = known_;
  add_load(f.data(), generalized_.data());
  matrix_.accelerate(generalized_);
  for (int i = 0; i < dofs(); ++i) a[size(matrix_.dofs()[size(i)])] = generalized_[size(i)];
}

void ContactSpace::build(const Mechanism& mechanism, std::span<const ContactPlace> places,
                         const ContactIslands& islands, int island, const double* known) {
  step_ = mechanism.step;
  matrix_.build(mechanism, islands.trees(island));
  const std::size_t count = matrix_.dofs().size();
  moves_.clear();
  move_begin_.assign(1, 0);
  free_known_.resize(count);
  generalized_.resize(count);
  known_.resize(count);
  // Zeros between uses, but for a step that ran out of memory.
  dense_.assign(count, {});
  scalars_.assign(count, 0.0);
  is_in_tree_.assign(count, 0);
  for (std::size_t i = 0; i < count; ++i) {
    free_known_[i] = known[matrix_.dofs()[i]];
    generalized_[i] = mechanism.speeds[matrix_.dofs()[i]];
  }
  velocity_.clear();
  for (const int place : islands.places(island)) {
    add_place(mechanism, places[size(place)], islands.trees_of(place));
    add_driven(places[size(place)]);
  }
  add_motion(generalized_.data(), velocity_.data());
  stride_ = padded(rows());
  has_responses_ = has_free_delassus_ = false;
}

void ContactSpace::constrain(const LinearConstraints& constraints) {
  matrix_.constrain(constraints);
  constrain_places();
  envelope_.assign(matrix_.envelope().begin(), matrix_.envelope().end());
  for (int place = 0; place < places(); ++place) widen_envelope(place);
  for (std::size_t i = 0; i < known_.size(); ++i) {
    known_[i] = free_known_[i] + matrix_.load()[i];
    generalized_[i] = step_ * known_[i];
  }
  matrix_.solve(generalized_);
  free_ = velocity_;
  add_motion(generalized_.data(), free_.data());
}

}  // namespace volcontact
