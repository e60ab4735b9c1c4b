// SPDX-License-Identifier: Apache-2.0
#include "volcontact/step/contact_equations.h"

#include <algorithm>
#include <cmath>

#include "volcontact/base/sizes.h"

namespace volcontact {
namespace {

using Vector = Eigen::Map<Eigen::VectorXd>;
constexpr std::size_t kFriction = 3;  // the first coordinate of friction

Eigen::Map<Vec3> part(std::vector<double>& numbers, std::size_t first) {
  return Eigen::Map<Vec3>(&numbers[first]);
}

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

// Of the block of Lambda of two places, the rows and columns from these on.
Mat3 part_of(const ContactSpace& space, int i, Eigen::Index row, int k, Eigen::Index column) {
  if (space.is_symmetric() && k > i)
    return space.delassus(k, i).block<3, 3>(column, row).transpose();
  return space.delassus(i, k).block<3, 3>(row, column);
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
  slopes_.normal.assign(size(places), Mat3::Zero());
  slopes_.friction.assign(size(places), Mat3::Zero());
  for (const Column& column : columns) {
    Squares& block = column.first % kRows == 0 ? slopes_.normal : slopes_.friction;
    block[size(column.first / kRows)].noalias() += column.numbers * column.numbers.transpose();
  }
}

void ContactEquations::forget() {
  normal_by_dofs_.is_valid = by_dofs_.is_valid = false;
  normal_.is_valid = friction_.is_valid = is_coupled_ = false;
}

bool ContactEquations::has_friction() const {
  return std::any_of(slopes_.friction.begin(), slopes_.friction.end(),
                     [](const Mat3& slope) { return !slope.isZero(0.0); });
}

// L of the places that have this block.
void ContactEquations::take_factors(const Squares& slopes, ByForces& out) const {
  out.slopes = slopes;
  out.factors.resize(slopes.size());
  out.active.clear();
  for (std::size_t place = 0; place < slopes.size(); ++place) {
    if (slopes[place].isZero(0.0)) continue;
    out.active.push_back(static_cast<int>(place));
    out.factors[place] = root_of(slopes[place]);
  }
}

// 1 + h L' Lambda L of the normal forces.
void ContactEquations::factor_normal(const ContactSpace& space, double step) {
  if (normal_.is_valid && normal_.slopes == slopes_.normal) return;
  normal_.is_valid = friction_.is_valid = is_coupled_ = false;
  take_factors(slopes_.normal, normal_);
  const bool is_symmetric = space.is_symmetric();
  const int count = static_cast<int>(normal_.active.size());
  normal_.matrix.reset(count, is_symmetric);
  for (int i = 0; i < count; ++i) {
    const int place = normal_.active[size(i)];
    const Mat3 left = step * normal_.factors[size(place)].transpose();
    for (int k = 0; k < (is_symmetric ? i + 1 : count); ++k) {
      const int other = normal_.active[size(k)];
      const Mat3 moved =
          space.delassus(place, other).topLeftCorner<3, 3>() * normal_.factors[size(other)];
      normal_.matrix(i, k).noalias() = left * moved;
    }
    normal_.matrix(i, i).diagonal().array() += 1.0;
  }
  normal_.matrix.factor();
  normal_.is_valid = true;
}

// How friction moves the places of friction when the normal forces answer.
void ContactEquations::couple(const ContactSpace& space, double step) {
  const auto has_slope = [this](int place) { return !slopes_.friction[size(place)].isZero(0.0); };
  const auto are_same = [&] {
    const auto count = std::count_if(slopes_.friction.begin(), slopes_.friction.end(),
                                     [](const Mat3& slope) { return !slope.isZero(0.0); });
    return count == std::ssize(friction_.active) &&
           std::all_of(friction_.active.begin(), friction_.active.end(), has_slope);
  };
  if (is_coupled_ && are_same()) return;
  is_coupled_ = friction_.is_valid = false;
  friction_.active.clear();
  for (int place = 0; place < space.places(); ++place) {
    if (has_slope(place)) friction_.active.push_back(place);
  }
  const std::size_t normals = normal_.active.size(), count = friction_.active.size();
  const bool is_symmetric = space.is_symmetric();
  forth_.resize(count * normals);
  back_.resize(count * normals);
  mobility_.resize(count * count);
  for (std::size_t i = 0; i < count; ++i) {
    const int place = friction_.active[i];
    for (std::size_t a = 0; a < normals; ++a) {
      const int other = normal_.active[a];
      const Mat3& factor = normal_.factors[size(other)];
      back_[i * normals + a].noalias() =
          factor.transpose() * part_of(space, other, 0, place, kFriction);
      forth_[i * normals + a] =
          is_symmetric
              ? back_[i * normals + a]
              : Mat3(factor.transpose() * part_of(space, place, kFriction, other, 0).transpose());
    }
    if (normals > 0) normal_.matrix.solve<3>(back_[i * normals].data());
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < (is_symmetric ? i + 1 : count); ++k) {
      Mat3 answered = Mat3::Zero();
      for (std::size_t a = 0; a < normals; ++a) {
        answered.noalias() += forth_[i * normals + a].transpose() * back_[k * normals + a];
      }
      mobility_[i * count + k] =
          part_of(space, friction_.active[i], kFriction, friction_.active[k], kFriction) -
          step * answered;
    }
  }
  is_coupled_ = true;
}

// 1 + h L' Lambda L of friction, with that Lambda.
void ContactEquations::factor_friction(const ContactSpace& space, double step) {
  if (friction_.is_valid && friction_.slopes == slopes_.friction) return;
  friction_.is_valid = false;
  take_factors(slopes_.friction, friction_);
  const bool is_symmetric = space.is_symmetric();
  const int count = static_cast<int>(friction_.active.size());
  friction_.matrix.reset(count, is_symmetric);
  for (int i = 0; i < count; ++i) {
    const Mat3 left = step * friction_.factors[size(friction_.active[size(i)])].transpose();
    for (int k = 0; k < (is_symmetric ? i + 1 : count); ++k) {
      const Mat3 moved =
          mobility_[size(i * count + k)] * friction_.factors[size(friction_.active[size(k)])];
      friction_.matrix(i, k).noalias() = left * moved;
    }
    friction_.matrix(i, i).diagonal().array() += 1.0;
  }
  friction_.matrix.factor();
  friction_.is_valid = true;
}

// Friction, and how the normal forces in `right_` answer.
void ContactEquations::solve_friction(const ContactSpace& space, double step,
                                      std::vector<double>& force) {
  couple(space, step);
  factor_friction(space, step);
  const std::size_t normals = normal_.active.size(), count = friction_.active.size();
  friction_right_.resize(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = size(friction_.active[i]);
    Vec3 answered = Vec3::Zero();
    for (std::size_t a = 0; a < normals; ++a) {
      answered.noalias() += forth_[i * normals + a].transpose() * part(right_, 3 * a);
    }
    const Vec3 motion = part(response_, size(kRows) * place + kFriction);
    part(friction_right_, 3 * i) =
        friction_.factors[place].transpose() * (motion - step * answered);
  }
  friction_.matrix.solve(friction_right_.data());
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = size(friction_.active[i]);
    const Vec3 borne = friction_.factors[place] * part(friction_right_, 3 * i);
    part(force, size(kRows) * place + kFriction) -= borne;
    for (std::size_t a = 0; a < normals; ++a) {
      part(right_, 3 * a).noalias() -= step * (back_[i * normals + a] * borne);
    }
  }
}

void ContactEquations::solve_for_forces(const ContactSpace& space, double step,
                                        std::vector<double>& force, std::vector<double>& velocity) {
  const int rows = space.rows();
  make_slopes(space.places());
  force.assign(constant.begin(), constant.end());
  velocity.resize(size(rows));
  response_.resize(size(rows));
  space.move_by_delassus(force.data(), response_.data());
  factor_normal(space, step);
  const std::size_t normals = normal_.active.size();
  right_.resize(3 * normals);
  for (std::size_t a = 0; a < normals; ++a) {
    const std::size_t place = size(normal_.active[a]);
    part(right_, 3 * a).noalias() =
        normal_.factors[place].transpose() * part(response_, size(kRows) * place);
  }
  normal_.matrix.solve(right_.data());
  if (has_friction()) solve_friction(space, step, force);
  for (std::size_t a = 0; a < normals; ++a) {
    const std::size_t place = size(normal_.active[a]);
    part(force, size(kRows) * place).noalias() -= normal_.factors[place] * part(right_, 3 * a);
  }
  space.move_by_delassus(force.data(), velocity.data());
}

// Adds h J' C J of one place to the matrix.
void ContactEquations::add_slope(const ContactSpace& space, int place, double step,
                                 EnvelopeMatrix& matrix) const {
  const Mat3 normal = step * slopes_.normal[size(place)];
  const Mat3 friction = step * slopes_.friction[size(place)];
  const bool rubs = !friction.isZero(0.0);
  const std::span<const ContactSpace::Move> moves = space.moves(place);
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const ContactSpace::Move& from = moves[i];
    const Vec3 pressed = normal * from.column.head<3>();
    const Vec3 rubbed = friction * from.column.tail<3>();
    for (std::size_t k = i; k < moves.size(); ++k) {
      const ContactSpace::Move& to = moves[k];
      double both = to.column.head<3>().dot(pressed);
      if (rubs) both += to.column.tail<3>().dot(rubbed);
      matrix.add_both(std::max(from.dof, to.dof), std::min(from.dof, to.dof), both);
    }
  }
}

void ContactEquations::factor(ContactSpace& space, double step, ByDofs& out) const {
  if (out.is_valid && out.slopes == slopes_) return;
  out.is_valid = false;
  out.slopes = slopes_;
  out.matrix.reset(space.envelope(), space.is_symmetric());
  out.matrix.add(space.matrix().matrix());
  for (int place = 0; place < space.places(); ++place) {
    const bool bears =
        !slopes_.normal[size(place)].isZero(0.0) || !slopes_.friction[size(place)].isZero(0.0);
    if (bears) add_slope(space, place, step, out.matrix);
  }
  out.matrix.factor();
  out.is_valid = true;
}

void ContactEquations::solve_for_dofs(ContactSpace& space, double step, std::vector<double>& force,
                                      std::vector<double>& velocity) {
  const int rows = space.rows(), n = space.dofs();
  make_slopes(space.places());
  ByDofs& by = has_friction() ? by_dofs_ : normal_by_dofs_;
  factor(space, step, by);
  // What the contacts would bear at the velocities of now.
  force.assign(constant.begin(), constant.end());
  velocity.resize(size(rows));
  Vector u(velocity.data(), rows);
  u = space.velocity();
  const auto bear = [&](int place) {
    const std::size_t first = size(place * kRows);
    part(force, first).noalias() -= slopes_.normal[size(place)] * part(velocity, first);
    part(force, first + kFriction).noalias() -=
        slopes_.friction[size(place)] * part(velocity, first + kFriction);
  };
  for (int place = 0; place < rows / kRows; ++place) bear(place);
  right_.resize(size(n));
  Vector right(right_.data(), n);
  right = space.known();
  space.add_load(force.data(), right_.data());
  right *= step;
  by.matrix.solve(right_.data(), 0, n);
  space.add_motion(right_.data(), velocity.data());
  std::copy(constant.begin(), constant.end(), force.begin());
  for (int place = 0; place < rows / kRows; ++place) bear(place);
}

}  // namespace volcontact
