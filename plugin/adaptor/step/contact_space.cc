// SPDX-License-Identifier: Apache-2.0
#include "adaptor/step/contact_space.h"

#include <algorithm>

#include "adaptor/mujoco/mjgeoms.h"
#include "adaptor/mujoco/sizes.h"

namespace volcontact::adaptor {

// Adds the motion that each degree of freedom beyond the world gives the body at the place.
void ContactSpace::add_body(const mjModel* m, const mjData* d, const ContactPlace& place, int body,
                            double sign, const Side& side) noexcept {
  while (body > 0 && m->body_dofnum[body] == 0) body = m->body_parentid[body];
  const Vec3 offset = place.point - vec3_at(d->subtree_com, m->body_rootid[body]);
  const Mat3 to_site = sign * place.axes.transpose();
  double* columns = &jacobian_[at(side)];
  int dof = m->body_dofadr[body] + m->body_dofnum[body] - 1;
  for (; dof >= 0; dof = m->dof_parentid[dof]) {
    const Vec3 angular = vec3_at(d->cdof, 2 * dof);
    const Vec3 turn = to_site * angular;
    const Vec3 way = to_site * (vec3_at(d->cdof, 2 * dof + 1) + angular.cross(offset));
    const double column[kRows] = {way[2], turn[0], turn[1], way[0], way[1], turn[2]};
    double* to = columns + kRows * (matrix_.number(dof) - side.begin);
    for (int i = 0; i < kRows; ++i) to[i] += column[i];
  }
}

ContactSpace::Side ContactSpace::add_side(int tree) noexcept {
  const DofRange& range = matrix_.tree(tree);
  const std::size_t start = jacobian_.size();
  jacobian_.resize(start + size(kRows * range.size()), 0.0);
  return {range.begin, range.end, static_cast<std::ptrdiff_t>(start)};
}

void ContactSpace::add_place(const mjModel* m, const mjData* d, const ContactPlace& place,
                             std::pair<int, int> trees) noexcept {
  const auto [tree_a, tree_b] = trees;
  std::array<Side, 2> sides;
  int count = 0;
  if (tree_a >= 0) {
    sides[0] = add_side(tree_a);
    add_body(m, d, place, place.body_a, 1.0, sides[0]);
    count = 1;
  }
  if (tree_b >= 0) {
    if (tree_b != tree_a) sides[size(count++)] = add_side(tree_b);
    add_body(m, d, place, place.body_b, -1.0, sides[size(count - 1)]);
  }
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
void ContactSpace::widen_envelope(std::size_t place) noexcept {
  int least = dofs();
  for (const bool finds : {true, false}) {
    for (const Side& side : sides(static_cast<int>(place))) {
      const Rows rows = jacobian(side);
      for (int i = 0; i < side.size(); ++i) {
        if (rows.col(i).isZero(0.0)) continue;
        int& first = envelope_[size(side.begin + i)];
        if (finds) {
          least = std::min(least, side.begin + i);
        } else {
          first = std::min(first, least);
        }
      }
    }
  }
}

void ContactSpace::build_mobility() noexcept {
  mobility_.resize(sides_.size());
  if (!matrix_.is_by_trees()) {
    prefers_dofs_ = true;
    for (int place = 0; place < static_cast<int>(sides_.size()); ++place) respond(place);
    return;
  }
  response_ = jacobian_;
  for (std::size_t place = 0; place < sides_.size(); ++place) {
    mobility_[place].setZero();
    for (const Side& side : sides(static_cast<int>(place))) {
      matrix_.factor().solve<kRows>(&response_[at(side)], side.begin, side.end);
      const Rows moves = jacobian(side), responds = response(side);
      for (int i = 0; i < side.size(); ++i) {
        mobility_[place].noalias() += moves.col(i) * responds.col(i).transpose();
      }
    }
  }
  double work = 0.0;
  for (std::size_t i = 0; i < envelope_.size(); ++i) {
    const double width = static_cast<double>(i) + 1.0 - envelope_[i];
    work += 0.5 * width * width;
  }
  const double all = rows();
  prefers_dofs_ = work <= all * all * all / 2.0;  // as measured
  if (!prefers_dofs_) build_delassus();
}

// The mobility of one place, where what it moves moves other trees.
void ContactSpace::respond(int place) noexcept {
  response_.assign(size(kRows * dofs()), 0.0);
  for (const Side& side : sides(place)) {
    std::copy_n(&jacobian_[at(side)], kRows * side.size(), &response_[size(kRows * side.begin)]);
  }
  matrix_.factor().solve<kRows>(response_.data(), 0, dofs());
  const Rows responds(response_.data(), kRows, dofs());
  mobility_[size(place)].setZero();
  for (const Side& side : sides(place)) {
    const Rows moves = jacobian(side);
    for (int i = 0; i < side.size(); ++i) {
      mobility_[size(place)].noalias() += moves.col(i) * responds.col(side.begin + i).transpose();
    }
  }
}

void ContactSpace::build_delassus() noexcept {
  delassus_.assign(size(rows()) * size(rows()), 0.0);
  Eigen::Map<RowMajor> delassus(delassus_.data(), rows(), rows());
  const int places = static_cast<int>(sides_.size());
  for (int i = 0; i < places; ++i) {
    for (int k = 0; k <= i; ++k) {
      for (const Side& side : sides(i)) {
        for (const Side& other : sides(k)) {
          if (side.begin != other.begin) continue;
          delassus.block<kRows, kRows>(kRows * i, kRows * k).noalias() +=
              jacobian(side).lazyProduct(response(other).transpose());
        }
      }
      if (k == i) continue;
      delassus.block<kRows, kRows>(kRows * k, kRows * i) =
          delassus.block<kRows, kRows>(kRows * i, kRows * k).transpose();
    }
  }
}

void ContactSpace::add_load(const double* f, double* load) const noexcept {
  for (std::size_t place = 0; place < sides_.size(); ++place) {
    const Eigen::Map<const Block> force(f + place * size(kRows));
    for (const Side& side : sides(static_cast<int>(place))) {
      const Rows moves = jacobian(side);
      for (int i = 0; i < side.size(); ++i) load[side.begin + i] += moves.col(i).dot(force);
    }
  }
}

void ContactSpace::add_motion(const double* x, double* u) const noexcept {
  for (std::size_t place = 0; place < sides_.size(); ++place) {
    Eigen::Map<Block> motion(u + place * size(kRows));
    for (const Side& side : sides(static_cast<int>(place))) {
      const Rows moves = jacobian(side);
      for (int i = 0; i < side.size(); ++i) motion += x[side.begin + i] * moves.col(i);
    }
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
  jacobian_.clear();
  known_.resize(size(matrix_.size()));
  for (const int place : islands.places(island)) {
    add_place(m, d, places[size(place)], islands.trees_of(place));
    widen_envelope(sides_.size() - 1);
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
