// SPDX-License-Identifier: Apache-2.0
#include "adaptor/step/contact_space.h"

#include <algorithm>

#include "adaptor/mujoco/mjgeoms.h"
#include "adaptor/mujoco/sizes.h"

namespace volcontact::adaptor {

// Adds the motion that each degree of freedom beyond the world gives the body at the place.
void ContactSpace::add_body(const mjModel* m, const mjData* d, const ContactPlace& place, int body,
                            double sign) noexcept {
  while (body > 0 && m->body_dofnum[body] == 0) body = m->body_parentid[body];
  const Vec3 offset = place.point - vec3_at(d->subtree_com, m->body_rootid[body]);
  const Mat3 to_site = sign * place.axes.transpose();
  int dof = m->body_dofadr[body] + m->body_dofnum[body] - 1;
  for (; dof >= 0; dof = m->dof_parentid[dof]) {
    const Vec3 angular = vec3_at(d->cdof, 2 * dof);
    const Vec3 turn = to_site * angular;
    const Vec3 way = to_site * (vec3_at(d->cdof, 2 * dof + 1) + angular.cross(offset));
    const double column[kRows] = {way[2], turn[0], turn[1], way[0], way[1], turn[2]};
    double* to = &dense_[size(kRows * matrix_.number(dof))];
    for (int i = 0; i < kRows; ++i) to[i] += column[i];
  }
}

void ContactSpace::add_place(const mjModel* m, const mjData* d, const ContactPlace& place,
                             std::pair<int, int> trees) noexcept {
  const auto [tree_a, tree_b] = trees;
  std::array<Side, 2> sides;
  int count = 0;
  const auto add_side = [&](int tree) {
    sides[size(count++)] = {matrix_.tree(tree).begin, matrix_.tree(tree).end, 0};
  };
  if (tree_a >= 0) {
    add_side(tree_a);
    add_body(m, d, place, place.body_a, 1.0);
  }
  if (tree_b >= 0) {
    if (tree_b != tree_a) add_side(tree_b);
    add_body(m, d, place, place.body_b, -1.0);
  }
  for (int side = 0; side < count; ++side) {
    for (int dof = sides[size(side)].begin; dof < sides[size(side)].end; ++dof) {
      Eigen::Map<Block> column(&dense_[size(kRows * dof)]);
      if (column.isZero(0.0)) continue;
      moves_.push_back({column, dof});
      column.setZero();
    }
  }
  move_begin_.push_back(moves_.size());
  sides_.push_back(sides);
  side_count_.push_back(count);
}

// What moves at the place without any degree of freedom.
void ContactSpace::add_driven(const ContactPlace& place) noexcept {
  const Vec3 way = place.axes.transpose() * place.driven.linear;
  const Vec3 turn = place.axes.transpose() * place.driven.angular;
  velocity_.insert(velocity_.end(), {way[2], turn[0], turn[1], way[0], way[1], turn[2]});
}

// All that a place moves has to do with each other.
void ContactSpace::widen_envelope(int place) noexcept {
  int least = dofs();
  for (const Move& move : moves(place)) least = std::min(least, move.dof);
  for (const Move& move : moves(place)) {
    int& first = envelope_[size(move.dof)];
    first = std::min(first, least);
  }
}

void ContactSpace::build_mobility() noexcept {
  mobility_.resize(size(places()));
  response_.clear();
  for (int place = 0; place < places(); ++place) {
    respond(place);
    mobility_[size(place)] = moved_by(place, place);
  }
  choose_form();
  if (!prefers_dofs_) build_delassus();
}

// The form of less work, counted in multiplications and weighed as measured.
void ContactSpace::choose_form() noexcept {
  constexpr double kBlocks = 20.0, kPairs = 120.0;
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

// H^-1 J' of one place: of its trees, where H has no entries between trees, else of all.
void ContactSpace::respond(int place) noexcept {
  std::array<Side, 2>& sides = sides_[size(place)];
  if (!matrix_.is_by_trees()) {
    sides[0] = {0, dofs(), 0};
    side_count_[size(place)] = 1;
  }
  for (int i = 0; i < side_count_[size(place)]; ++i) {
    Side& side = sides[size(i)];
    side.start = response_.size();
    response_.resize(side.start + size(kRows * (side.end - side.begin)), 0.0);
    double* const at = &response_[side.start];
    for (const Move& move : moves(place)) {
      if (move.dof < side.begin || move.dof >= side.end) continue;
      std::copy_n(move.column.data(), kRows, at + kRows * (move.dof - side.begin));
    }
    matrix_.factor().solve<kRows>(at, side.begin, side.end);
  }
}

// The block of Lambda by which forces at `other` move `place`.
ContactSpace::Square ContactSpace::moved_by(int place, int other) const noexcept {
  Square out = Square::Zero();
  for (const Side& side : sides(other)) {
    for (const Move& move : moves(place)) {
      if (move.dof < side.begin || move.dof >= side.end) continue;
      const Eigen::Map<const Block> response(
          &response_[side.start + size(kRows * (move.dof - side.begin))]);
      out.noalias() += move.column * response.transpose();
    }
  }
  return out;
}

void ContactSpace::build_delassus() noexcept {
  const int count = places();
  delassus_.resize(size(count) * size(count));
  for (int i = 0; i < count; ++i) {
    const int end = matrix_.matrix().is_symmetric() ? i + 1 : count;
    for (int k = 0; k < end; ++k) {
      delassus_[size(i) * size(count) + size(k)] = i == k ? mobility_[size(i)] : moved_by(i, k);
    }
  }
}

void ContactSpace::move_by_delassus(const double* f, double* u) const noexcept {
  const int count = places();
  const bool is_symmetric = matrix_.matrix().is_symmetric();
  std::fill(u, u + rows(), 0.0);
  for (int i = 0; i < count; ++i) {
    Eigen::Map<Block> motion(u + kRows * i);
    const Eigen::Map<const Block> force(f + kRows * i);
    for (int k = 0; k < (is_symmetric ? i + 1 : count); ++k) {
      const Square& block = delassus(i, k);
      motion.noalias() += block * Eigen::Map<const Block>(f + kRows * k);
      if (!is_symmetric || k == i) continue;
      Eigen::Map<Block>(u + kRows * k).noalias() += block.transpose() * force;
    }
  }
  for (std::size_t i = 0; i < free_.size(); ++i) u[i] = free_[i] + step_ * u[i];
}

void ContactSpace::add_load(const double* f, double* load) const noexcept {
  for (int place = 0; place < places(); ++place) {
    const Eigen::Map<const Block> force(f + kRows * place);
    for (const Move& move : moves(place)) load[move.dof] += move.column.dot(force);
  }
}

void ContactSpace::add_motion(const double* x, double* u) const noexcept {
  for (int place = 0; place < places(); ++place) {
    Eigen::Map<Block> motion(u + kRows * place);
    for (const Move& move : moves(place)) motion += x[move.dof] * move.column;
  }
}

void ContactSpace::move(const std::vector<double>& f, std::vector<double>& u) noexcept {
  generalized_.assign(size(dofs()), 0.0);
  add_load(f.data(), generalized_.data());
  for (double& load : generalized_) load *= step_;
  matrix_.factor().solve(generalized_.data(), 0, dofs());
  std::copy(free_.begin(), free_.end(), u.begin());
  add_motion(generalized_.data(), u.data());
}

void ContactSpace::accelerate(const std::vector<double>& f, std::vector<double>& a) noexcept {
  generalized_ = known_;
  add_load(f.data(), generalized_.data());
  for (double& load : generalized_) load *= step_;
  matrix_.factor().solve(generalized_.data(), 0, dofs());
  matrix_.to_acceleration(generalized_, step_);
  for (int i = 0; i < dofs(); ++i) a[size(matrix_.dofs()[size(i)])] = generalized_[size(i)];
}

void ContactSpace::build(const mjModel* m, mjData* d, Damping damping,
                         std::span<const ContactPlace> places, const ContactIslands& islands,
                         int island, const NativeConstraints& constraints,
                         const double* known) noexcept {
  step_ = m->opt.timestep;
  matrix_.build(m, d, damping, islands.trees(island), constraints);
  envelope_.assign(matrix_.envelope().begin(), matrix_.envelope().end());
  sides_.clear();
  side_count_.clear();
  moves_.clear();
  move_begin_.assign(1, 0);
  known_.resize(size(matrix_.size()));
  dense_.assign(size(kRows * dofs()), 0.0);
  for (const int place : islands.places(island)) {
    add_place(m, d, places[size(place)], islands.trees_of(place));
    widen_envelope(this->places() - 1);
  }
  generalized_.resize(known_.size());
  for (std::size_t i = 0; i < known_.size(); ++i) {
    const int dof = matrix_.dofs()[i];
    known_[i] = known[dof] + matrix_.load()[i];
    generalized_[i] = d->qvel[dof];
  }
  velocity_.clear();
  for (const int place : islands.places(island)) add_driven(places[size(place)]);
  add_motion(generalized_.data(), velocity_.data());
  for (std::size_t i = 0; i < known_.size(); ++i) generalized_[i] = step_ * known_[i];
  matrix_.factor().solve(generalized_.data(), 0, dofs());
  free_ = velocity_;
  add_motion(generalized_.data(), free_.data());
}

void known_forces(const mjModel* m, mjData* d, const double* user_qfrc, const double* user_xfrc,
                  std::vector<double>& out) noexcept {
  const int nv = static_cast<int>(m->nv);
  out.resize(size(nv));
  mj_rne(m, d, 0, out.data());
  const bool actuated = m->nu > 0;
  if (actuated) mj_fwdActuation(m, d);
  for (int i = 0; i < nv; ++i) {
    double& force = out[size(i)];
    force = d->qfrc_passive[i] - force + user_qfrc[i];
    if (actuated) force += d->qfrc_actuator[i];
  }
  for (int body = 1; body < m->nbody; ++body) {
    const double* load = user_xfrc + 6 * body;
    if (std::all_of(load, load + 6, [](double x) { return x == 0.0; })) continue;
    mj_applyFT(m, d, load, load + 3, d->xipos + 3 * body, body, out.data());
  }
}

}  // namespace volcontact::adaptor
