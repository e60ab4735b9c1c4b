// SPDX-License-Identifier: Apache-2.0
#include "adaptor/contact_space.h"

#include <algorithm>

#include "adaptor/cholesky.h"
#include "adaptor/solids_of_geoms.h"

namespace volcontact::adaptor {
namespace {

std::size_t size(int count) { return static_cast<std::size_t>(count); }

}  // namespace

// Adds the motion that each degree of freedom beyond the world gives the body at the place.
void ContactSpace::add_body(const mjModel* m, const mjData* d, const ContactPlace& place, int body,
                            double sign, double* rows) noexcept {
  if (m->body_weldid[body] == 0) return;
  while (body > 0 && m->body_dofnum[body] == 0) body = m->body_parentid[body];
  if (body == 0) return;
  const Vec3 offset = place.point - vec3_at(d->subtree_com, m->body_rootid[body]);
  const Mat3 to_site = sign * place.axes.transpose();
  int dof = m->body_dofadr[body] + m->body_dofnum[body] - 1;
  for (; dof >= 0; dof = m->dof_parentid[dof]) {
    const Vec3 angular = vec3_at(d->cdof, 2 * dof);
    const Vec3 turn = to_site * angular;
    const Vec3 way = to_site * (vec3_at(d->cdof, 2 * dof + 1) + angular.cross(offset));
    const double column[kRows] = {way[2], turn[0], turn[1], way[0], way[1], turn[2]};
    for (int i = 0; i < kRows; ++i) rows[i * nv_ + dof] += column[i];
  }
}

void ContactSpace::make_mass(const mjModel* m, mjData* d, bool damped) noexcept {
  mass_.assign(size(nv_) * size(nv_), 0.0);
  mj_addM(m, d, mass_.data(), nullptr, nullptr, nullptr);
  if (!damped) return;
  for (int i = 0; i < nv_; ++i) {
    mass_[size(i) * size(nv_) + size(i)] += m->opt.timestep * m->dof_damping[i];
  }
}

void ContactSpace::divide_by_mass(const mjModel* m) noexcept {
  response_ = jacobian_;
  // The degrees of freedom of a tree stand together.
  for (int first = 0; first < nv_;) {
    const int root = m->body_rootid[m->dof_bodyid[first]];
    int last = first;
    while (last < nv_ && m->body_rootid[m->dof_bodyid[last]] == root) ++last;
    const int n = last - first;
    block_.resize(size(n) * size(n));
    for (int i = 0; i < n; ++i) {
      // Only the lower triangle is filled by every release.
      std::copy_n(&mass_[size((first + i) * nv_ + first)], i + 1, &block_[size(i * n)]);
    }
    factor_in_place(block_.data(), n);
    for (int row = 0; row < rows_; ++row) {
      solve_in_place(block_.data(), n, &response_[size(row * nv_ + first)]);
    }
    first = last;
  }
}

void ContactSpace::build_delassus() noexcept {
  delassus_.resize(size(rows_) * size(rows_));
  Eigen::Map<RowMajor>(delassus_.data(), rows_, rows_).noalias() =
      jacobian().lazyProduct(Eigen::Map<const RowMajor>(response_.data(), rows_, nv_).transpose());
}

void ContactSpace::move(const std::vector<double>& f, std::vector<double>& u) noexcept {
  generalized_.resize(size(nv_));
  Eigen::Map<Eigen::VectorXd> load(generalized_.data(), nv_), out(u.data(), rows_);
  load.noalias() =
      jacobian().transpose().lazyProduct(Eigen::Map<const Eigen::VectorXd>(f.data(), rows_));
  out.noalias() = Eigen::Map<const RowMajor>(response_.data(), rows_, nv_).lazyProduct(load);
  out = free_velocity() + step_ * out;
}

void ContactSpace::build(const mjModel* m, mjData* d, std::span<const ContactPlace> places,
                         const double* known) noexcept {
  rows_ = kRows * static_cast<int>(places.size());
  nv_ = static_cast<int>(m->nv);
  const std::size_t entries = size(rows_) * size(nv_);
  jacobian_.assign(entries, 0.0);
  response_.resize(entries);
  for (std::size_t i = 0; i < places.size(); ++i) {
    double* rows = &jacobian_[i * size(kRows) * size(nv_)];
    add_body(m, d, places[i], places[i].body_a, 1.0, rows);
    add_body(m, d, places[i], places[i].body_b, -1.0, rows);
  }
  known_ = known;
  step_ = m->opt.timestep;
  const bool damped = damps_implicitly(m);
  if (damped || prefers_dofs()) make_mass(m, d, damped);
  if (damped) {
    divide_by_mass(m);
  } else {
    mj_solveM(m, d, response_.data(), jacobian_.data(), rows_);
  }
  velocity_.resize(size(rows_));
  free_.resize(size(rows_));
  const Eigen::Map<const RowMajor> response(response_.data(), rows_, nv_);
  mobility_.resize(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Eigen::Index first = static_cast<Eigen::Index>(i) * kRows;
    mobility_[i].noalias() = jacobian().middleRows<kRows>(first).lazyProduct(
        response.middleRows<kRows>(first).transpose());
  }
  if (!prefers_dofs()) build_delassus();
  const Eigen::Map<const Eigen::VectorXd> v(d->qvel, nv_), t(known, nv_);
  Eigen::Map<Eigen::VectorXd> u(velocity_.data(), rows_), free(free_.data(), rows_);
  u.noalias() = jacobian().lazyProduct(v);
  free.noalias() = response.lazyProduct(t);
  free = u + m->opt.timestep * free;
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
