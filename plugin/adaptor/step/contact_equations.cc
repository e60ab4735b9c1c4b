// SPDX-License-Identifier: Apache-2.0
#include "adaptor/step/contact_equations.h"

#include <algorithm>

#include "adaptor/mujoco/sizes.h"

namespace volcontact::adaptor {
namespace {

using Vector = Eigen::Map<Eigen::VectorXd>;
using ConstVector = Eigen::Map<const Eigen::VectorXd>;

}  // namespace

void ContactEquations::solve(const ContactSpace& space, double step, std::vector<double>& force,
                             std::vector<double>& velocity) noexcept {
  if (space.prefers_dofs()) {
    solve_for_dofs(space, step, force, velocity);
  } else {
    solve_for_forces(space, step, force, velocity);
  }
}

void ContactEquations::solve_for_forces(const ContactSpace& space, double step,
                                        std::vector<double>& force,
                                        std::vector<double>& velocity) noexcept {
  const int rows = space.rows(), n = static_cast<int>(columns.size());
  const auto delassus = space.delassus();
  force.resize(size(rows));
  velocity.resize(size(rows));
  full_.assign(size(n), 0);
  matrix_.reset(full_);
  right_.resize(size(n));
  response_.resize(size(rows));
  Vector u(velocity.data(), rows), f(force.data(), rows), response(response_.data(), rows);
  f = ConstVector(constant.data(), rows);
  u.noalias() = delassus.lazyProduct(f);
  u = space.free_velocity() + step * u;
  for (int i = 0; i < n; ++i) {
    const Column& column = columns[size(i)];
    // Lambda is symmetric: its rows are its columns.
    response.noalias() =
        delassus.middleRows<3>(column.first).transpose().lazyProduct(column.numbers);
    for (int k = 0; k <= i; ++k) {
      const Column& other = columns[size(k)];
      matrix_(i, k) = step * other.numbers.dot(response.segment<3>(other.first));
    }
    matrix_(i, i) += 1.0;
    right_[size(i)] = column.numbers.dot(u.segment<3>(column.first));
  }
  matrix_.factor();
  matrix_.solve(right_.data(), 0, n);
  for (int i = 0; i < n; ++i) {
    const Column& column = columns[size(i)];
    f.segment<3>(column.first) -= right_[size(i)] * column.numbers;
  }
  u.noalias() = delassus.lazyProduct(f);
  u = space.free_velocity() + step * u;
}

// Adds h J' C J of one place to the matrix.
void ContactEquations::add_slope(const ContactSpace& space, int place, double step) noexcept {
  const Slope slope = step * slopes_[size(place)];
  for (const ContactSpace::Side& from : space.sides(place)) {
    const ContactSpace::Rows jacobian = space.jacobian(from);
    response_.resize(size(kRows * from.size()));
    Eigen::Map<Eigen::Matrix<double, kRows, Eigen::Dynamic>> response(response_.data(), kRows,
                                                                      from.size());
    for (int k = 0; k < from.size(); ++k) response.col(k).noalias() = slope * jacobian.col(k);
    for (const ContactSpace::Side& to : space.sides(place)) {
      const ContactSpace::Rows other = space.jacobian(to);
      for (int i = to.begin; i < to.end; ++i) {
        const ContactSpace::Block column = other.col(i - to.begin);
        const int begin = std::max(from.begin, matrix_.first(i)), end = std::min(from.end, i + 1);
        for (int k = begin; k < end; ++k) {
          matrix_.add_both(i, k, column.dot(response.col(k - from.begin)));
        }
      }
    }
  }
}

void ContactEquations::solve_for_dofs(const ContactSpace& space, double step,
                                      std::vector<double>& force,
                                      std::vector<double>& velocity) noexcept {
  const int rows = space.rows(), n = space.dofs();
  slopes_.assign(size(rows / kRows), Slope::Zero());
  for (const Column& column : columns) {
    const int at = column.first % kRows;
    slopes_[size(column.first / kRows)].block<3, 3>(at, at).noalias() +=
        column.numbers * column.numbers.transpose();
  }
  matrix_.reset(space.envelope(), space.matrix().is_symmetric());
  matrix_.add(space.matrix());
  // What the contacts would bear at the velocities of now.
  force.assign(constant.begin(), constant.end());
  velocity.resize(size(rows));
  Vector u(velocity.data(), rows);
  u = space.velocity();
  const auto bear = [&](int place) {
    Eigen::Map<ContactSpace::Block>(&force[size(place * kRows)]).noalias() -=
        slopes_[size(place)] * u.segment<kRows>(place * kRows);
  };
  for (int place = 0; place < rows / kRows; ++place) {
    bear(place);
    add_slope(space, place, step);
  }
  right_.resize(size(n));
  Vector right(right_.data(), n);
  right = space.known();
  space.add_load(force.data(), right_.data());
  right *= step;
  matrix_.factor();
  matrix_.solve(right_.data(), 0, n);
  space.add_motion(right_.data(), velocity.data());
  std::copy(constant.begin(), constant.end(), force.begin());
  for (int place = 0; place < rows / kRows; ++place) bear(place);
}

}  // namespace volcontact::adaptor
