// SPDX-License-Identifier: Apache-2.0
#include "volcontact/step/contact_equations.h"

#include <algorithm>
#include <cmath>

#include "volcontact/base/sizes.h"

namespace volcontact {
namespace {

using Vector = Eigen::Map<Eigen::VectorXd>;

// The lower triangular L of L L', of a matrix that may be semidefinite.
Mat3 root_of(Mat3 rest) {
  Mat3 out = Mat3::Zero();
  for (int k = 0; k < 3; ++k) {
    if (!(rest(k, k) > 0.0)) continue;
    out.col(k) = rest.col(k) / std::sqrt(rest(k, k));
    out.col(k).head(k).setZero();
    rest -= out.col(k) * out.col(k).transpose();
  }
  return out;
}

}  // namespace

void ContactEquations::solve(ContactSpace& space, double step, std::vector<double>& force,
                             std::vector<double>& velocity) {
  if (space.prefers_dofs()) {
    solve_for_dofs(space, step, force, velocity);
  } else {
    solve_for_forces(space, step, force, velocity);
  }
}

void ContactEquations::make_slopes(int places) {
  slopes_.assign(size(places), ContactSpace::Square::Zero());
  for (const Column& column : columns) {
    const int at = column.first % kRows;
    slopes_[size(column.first / kRows)].block<3, 3>(at, at).noalias() +=
        column.numbers * column.numbers.transpose();
  }
}

template <int K>
void ContactEquations::solve_blocks(const ContactSpace& space, double step, BlockMatrix<K>& matrix,
                                    std::vector<double>& force) {
  using Block = typename BlockMatrix<K>::Block;
  using Part = typename BlockMatrix<K>::Vector;
  const bool is_symmetric = space.is_symmetric();
  const int count = static_cast<int>(active_.size());
  matrix.reset(count, is_symmetric);
  right_.resize(size(K * count));
  for (int i = 0; i < count; ++i) {
    const int place = active_[size(i)];
    const Block left = step * factors_[size(place)].topLeftCorner<K, K>();
    for (int k = 0; k < (is_symmetric ? i + 1 : count); ++k) {
      const int other = active_[size(k)];
      const Block moved = space.delassus(place, other).template topLeftCorner<K, K>() *
                          factors_[size(other)].topLeftCorner<K, K>();
      matrix(i, k).noalias() = left.transpose() * moved;
    }
    matrix(i, i).diagonal().array() += 1.0;
    const Eigen::Map<const Part> motion(&response_[size(kRows * place)]);
    Eigen::Map<Part> right(&right_[size(K * i)]);
    right.noalias() = factors_[size(place)].topLeftCorner<K, K>().transpose() * motion;
  }
  matrix.factor();
  matrix.solve(right_.data());
  for (int i = 0; i < count; ++i) {
    const int place = active_[size(i)];
    Eigen::Map<Part>(&force[size(kRows * place)]).noalias() -=
        factors_[size(place)].topLeftCorner<K, K>() * Eigen::Map<const Part>(&right_[size(K * i)]);
  }
}

void ContactEquations::solve_for_forces(const ContactSpace& space, double step,
                                        std::vector<double>& force, std::vector<double>& velocity) {
  const int rows = space.rows();
  make_slopes(space.places());
  factors_.resize(slopes_.size());
  active_.clear();
  bool is_normal = true;
  for (int place = 0; place < space.places(); ++place) {
    const ContactSpace::Square& slope = slopes_[size(place)];
    if (slope.isZero(0.0)) continue;
    active_.push_back(place);
    ContactSpace::Square& factor = factors_[size(place)];
    factor.setZero();
    factor.topLeftCorner<3, 3>() = root_of(slope.topLeftCorner<3, 3>());
    factor.bottomRightCorner<3, 3>() = root_of(slope.bottomRightCorner<3, 3>());
    is_normal = is_normal && slope.bottomRightCorner<3, 3>().isZero(0.0);
  }
  force.assign(constant.begin(), constant.end());
  velocity.resize(size(rows));
  response_.resize(size(rows));
  space.move_by_delassus(force.data(), response_.data());
  if (is_normal) {
    solve_blocks(space, step, normal_, force);
  } else {
    solve_blocks(space, step, all_, force);
  }
  space.move_by_delassus(force.data(), velocity.data());
}

// Adds h J' C J of one place to the matrix.
void ContactEquations::add_slope(const ContactSpace& space, int place, double step) {
  const ContactSpace::Square slope = step * slopes_[size(place)];
  for (const ContactSpace::Move& from : space.moves(place)) {
    const ContactSpace::Block response = slope * from.column;
    for (const ContactSpace::Move& to : space.moves(place)) {
      if (to.dof >= from.dof) matrix_.add_both(to.dof, from.dof, to.column.dot(response));
    }
  }
}

void ContactEquations::solve_for_dofs(ContactSpace& space, double step, std::vector<double>& force,
                                      std::vector<double>& velocity) {
  const int rows = space.rows(), n = space.dofs();
  make_slopes(space.places());
  matrix_.reset(space.envelope(), space.is_symmetric());
  matrix_.add(space.matrix().matrix());
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
    if (slopes_[size(place)].isZero(0.0)) continue;
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

}  // namespace volcontact
