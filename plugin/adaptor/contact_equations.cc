// SPDX-License-Identifier: Apache-2.0
#include "adaptor/contact_equations.h"

#include "adaptor/cholesky.h"

namespace volcontact::adaptor {
namespace {

using Vector = Eigen::Map<Eigen::VectorXd>;
using ConstVector = Eigen::Map<const Eigen::VectorXd>;

std::size_t size(int count) { return static_cast<std::size_t>(count); }

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
  matrix_.resize(size(n) * size(n));
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
    double* row = &matrix_[size(i) * size(n)];
    for (int k = 0; k <= i; ++k) {
      const Column& other = columns[size(k)];
      row[k] = step * other.numbers.dot(response.segment<3>(other.first));
    }
    row[i] += 1.0;
    right_[size(i)] = column.numbers.dot(u.segment<3>(column.first));
  }
  factor_in_place(matrix_.data(), n);
  solve_in_place(matrix_.data(), n, right_.data());
  for (int i = 0; i < n; ++i) {
    const Column& column = columns[size(i)];
    f.segment<3>(column.first) -= right_[size(i)] * column.numbers;
  }
  u.noalias() = delassus.lazyProduct(f);
  u = space.free_velocity() + step * u;
}

void ContactEquations::solve_for_dofs(const ContactSpace& space, double step,
                                      std::vector<double>& force,
                                      std::vector<double>& velocity) noexcept {
  const int rows = space.rows(), nv = static_cast<int>(space.known().size());
  const auto jacobian = space.jacobian();
  force.resize(size(rows));
  velocity.resize(size(rows));
  matrix_.assign(space.mass().data(), space.mass().data() + size(nv) * size(nv));
  right_.resize(size(nv));
  response_.resize(size(nv));
  Vector u(velocity.data(), rows), f(force.data(), rows);
  Vector right(right_.data(), nv), row(response_.data(), nv);
  u = space.velocity();
  f = ConstVector(constant.data(), rows);
  right.noalias() = jacobian.transpose().lazyProduct(f);
  right += space.known();
  for (const Column& column : columns) {
    row.noalias() = jacobian.middleRows<3>(column.first).transpose().lazyProduct(column.numbers);
    right -= column.numbers.dot(u.segment<3>(column.first)) * row;
    for (int i = 0; i < nv; ++i) {
      if (row[i] == 0.0) continue;  // a site moves few of many bodies
      Vector(&matrix_[size(i) * size(nv)], i + 1) += step * row[i] * row.head(i + 1);
    }
  }
  right *= step;
  factor_in_place(matrix_.data(), nv);
  solve_in_place(matrix_.data(), nv, right_.data());
  u.noalias() += jacobian.lazyProduct(right);
  for (const Column& column : columns) {
    f.segment<3>(column.first) -= column.numbers.dot(u.segment<3>(column.first)) * column.numbers;
  }
}

}  // namespace volcontact::adaptor
