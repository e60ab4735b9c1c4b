// SPDX-License-Identifier: Apache-2.0
#include "volcontact/step/contact_equations.h"

#include <algorithm>

#include "volcontact/base/cholesky.h"
#include "volcontact/base/sizes.h"

namespace volcontact {

void ContactEquations::solve(ContactSpace& space, double step, std::vector<double>& force,
                             std::vector<double>& velocity) {
  if (space.prefers_dofs()) {
    solve_for_dofs(space, step, force, velocity);
  } else {
    solve_for_forces(space, step, force, velocity);
  }
}

void ContactEquations::forget() {
  for (Factored* factored :
       {static_cast<Factored*>(&normal_by_dofs_), static_cast<Factored*>(&by_dofs_),
        static_cast<Factored*>(&normal_by_forces_), static_cast<Factored*>(&by_forces_)}) {
    factored->is_valid = false;
  }
}

bool ContactEquations::has_friction() const {
  return std::any_of(slopes.begin(), slopes.end(),
                     [](const Slope& slope) { return !slope.friction.isZero(0.0); });
}

bool ContactEquations::is_of_slopes(const Factored& factored) const {
  return factored.is_valid && factored.slopes == slopes;
}

template <int K>
void ContactEquations::factor(const ContactSpace& space, double step, ByForces<K>& out) const {
  out.is_valid = false;
  out.slopes = slopes;
  out.roots.resize(slopes.size());
  out.active.clear();
  for (int place = 0; place < space.places(); ++place) {
    const Slope& slope = slopes[size(place)];
    if (slope.is_zero()) continue;
    out.active.push_back(place);
    out.roots[size(place)] = {cholesky(slope.normal), slope.friction.cwiseSqrt()};
  }
  const bool is_symmetric = space.is_symmetric();
  const int count = static_cast<int>(out.active.size());
  out.matrix.reset(count, is_symmetric);
  for (int i = 0; i < count; ++i) {
    const int place = out.active[size(i)];
    const Root& root = out.roots[size(place)];
    const Root left{step * root.normal, step * root.friction};
    for (int k = 0; k < (is_symmetric ? i + 1 : count); ++k) {
      const int other = out.active[size(k)];
      const ContactSpace::Square& lambda = space.delassus(place, other);
      const Root& right = out.roots[size(other)];
      auto& block = out.matrix(i, k);
      const Mat3 left_normal = left.normal.transpose();
      block.set_block(0, 0, left_normal * (lambda.block<3, 3>(0, 0) * right.normal));
      if constexpr (K > 3) {
        const auto left_friction = left.friction.asDiagonal();
        const auto right_friction = right.friction.asDiagonal();
        block.set_block(0, 3, left_normal * (lambda.block<3, 3>(0, 3) * right_friction));
        block.set_block(3, 0, left_friction * (lambda.block<3, 3>(3, 0) * right.normal));
        block.set_block(3, 3, left_friction * lambda.block<3, 3>(3, 3) * right_friction);
      }
    }
    for (int k = 0; k < K; ++k) out.matrix(i, i)(k, k) += 1.0;
  }
  out.matrix.factor();
  out.is_valid = true;
}

template <int K>
void ContactEquations::solve_blocks(const ContactSpace& space, double step, ByForces<K>& by,
                                    std::vector<double>& force) {
  if (!is_of_slopes(by)) factor(space, step, by);
  const int count = static_cast<int>(by.active.size());
  right_.resize(size(K * count));
  for (int i = 0; i < count; ++i) {
    const int place = by.active[size(i)];
    const Root& root = by.roots[size(place)];
    const double* const motion = &response_[size(kRows * place)];
    double* const right = &right_[size(K * i)];
    root.normal.transposed_times(Vec3::from(motion)).to(right);
    for (int r = 3; r < K; ++r) right[r] = root.friction[r - 3] * motion[r];
  }
  by.matrix.solve(right_.data());
  for (int i = 0; i < count; ++i) {
    const int place = by.active[size(i)];
    const Root& root = by.roots[size(place)];
    const double* const solved = &right_[size(K * i)];
    double* const f = &force[size(kRows * place)];
    (Vec3::from(f) - root.normal * Vec3::from(solved)).to(f);
    for (int r = 3; r < K; ++r) f[r] -= root.friction[r - 3] * solved[r];
  }
}

void ContactEquations::solve_for_forces(const ContactSpace& space, double step,
                                        std::vector<double>& force, std::vector<double>& velocity) {
  const int rows = space.rows();
  force.assign(constant.begin(), constant.end());
  velocity.resize(size(rows));
  response_.resize(size(rows));
  space.move_by_delassus(force.data(), response_.data());
  if (has_friction()) {
    solve_blocks(space, step, by_forces_, force);
  } else {
    solve_blocks(space, step, normal_by_forces_, force);
  }
  space.move_by_delassus(force.data(), velocity.data());
}

// Adds h J' C J of one place to the matrix.
void ContactEquations::add_slope(const ContactSpace& space, int place, double step,
                                 EnvelopeMatrix& matrix) const {
  const Slope& slope = slopes[size(place)];
  for (const ContactSpace::Move& from : space.moves(place)) {
    const ContactSpace::Block response = step * (slope * from.column);
    for (const ContactSpace::Move& to : space.moves(place)) {
      if (to.dof >= from.dof) matrix.add_both(to.dof, from.dof, to.column.dot(response));
    }
  }
}

void ContactEquations::factor(ContactSpace& space, double step, ByDofs& out) const {
  out.is_valid = false;
  out.slopes = slopes;
  out.matrix.reset(space.envelope(), space.is_symmetric());
  out.matrix.add(space.matrix().matrix());
  for (int place = 0; place < space.places(); ++place) {
    if (!slopes[size(place)].is_zero()) add_slope(space, place, step, out.matrix);
  }
  out.matrix.factor();
  out.is_valid = true;
}

void ContactEquations::solve_for_dofs(ContactSpace& space, double step, std::vector<double>& force,
                                      std::vector<double>& velocity) {
  const int rows = space.rows(), n = space.dofs();
  ByDofs& by = has_friction() ? by_dofs_ : normal_by_dofs_;
  if (!is_of_slopes(by)) factor(space, step, by);
  // What the contacts would bear at the velocities of now.
  force.assign(constant.begin(), constant.end());
  velocity.resize(size(rows));
  std::copy(space.velocity().begin(), space.velocity().end(), velocity.begin());
  const auto bear = [&](int place) {
    double* const f = &force[size(place * kRows)];
    const auto u = ContactSpace::Block::from(&velocity[size(place * kRows)]);
    (ContactSpace::Block::from(f) - slopes[size(place)] * u).to(f);
  };
  for (int place = 0; place < rows / kRows; ++place) {
    if (!slopes[size(place)].is_zero()) bear(place);
  }
  right_ = space.known();
  space.add_load(force.data(), right_.data());
  for (double& load : right_) load *= step;
  by.matrix.solve(right_.data(), 0, n);
  space.add_motion(right_.data(), velocity.data());
  std::copy(constant.begin(), constant.end(), force.begin());
  for (int place = 0; place < rows / kRows; ++place) bear(place);
}

}  // namespace volcontact
