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
  normal_by_dofs_.is_valid = by_dofs_.is_valid = by_.is_valid = false;
}

bool ContactEquations::has_friction() const {
  return std::any_of(slopes.begin(), slopes.end(),
                     [](const Slope& slope) { return !slope.friction.isZero(0.0); });
}

bool ContactEquations::is_of_normal_slopes() const {
  return by_.is_valid &&
         std::equal(slopes.begin(), slopes.end(), by_.slopes.begin(), by_.slopes.end(),
                    [](const Slope& slope, const Mat3& normal) { return slope.normal == normal; });
}

void ContactEquations::factor_normal(const ContactSpace& space, double step) {
  by_.is_valid = false;
  by_.slopes.clear();
  by_.pressed.clear();
  by_.roots.clear();
  by_.rubbed.clear();
  for (int place = 0; place < space.places(); ++place) {
    const Mat3& slope = by_.slopes.emplace_back(slopes[size(place)].normal);
    if (slope.isZero(0.0)) continue;
    by_.pressed.push_back(place);
    by_.roots.push_back(cholesky(slope));
  }
  const bool is_symmetric = space.is_symmetric();
  const int count = static_cast<int>(by_.pressed.size());
  by_.normal.reset(count, is_symmetric);
  for (int i = 0; i < count; ++i) {
    const Mat3 left = (step * by_.roots[size(i)]).transpose();
    for (int k = 0; k < (is_symmetric ? i + 1 : count); ++k) {
      const ContactSpace::Square& lambda =
          space.delassus(by_.pressed[size(i)], by_.pressed[size(k)]);
      by_.normal(i, k) = left * (lambda.block<3, 3>(0, 0) * by_.roots[size(k)]);
    }
    for (int k = 0; k < 3; ++k) by_.normal(i, i)(k, k) += 1.0;
  }
  by_.normal.factor();
  by_.is_valid = true;
}

bool ContactEquations::knows_all_that_rub() const {
  std::size_t next = 0;
  for (std::size_t place = 0; place < slopes.size(); ++place) {
    const bool is_known = next < by_.rubbed.size() && by_.rubbed[next] == static_cast<int>(place);
    if (is_known) ++next;
    if (!is_known && !slopes[place].friction.isZero(0.0)) return false;
  }
  return true;
}

bool ContactEquations::is_of_frictions() const {
  return std::equal(
      by_.rubbed.begin(), by_.rubbed.end(), by_.frictions.begin(), by_.frictions.end(),
      [this](int place, const Vec3& friction) { return slopes[size(place)].friction == friction; });
}

// R, and what leads to it.
void ContactEquations::respond_to_friction(const ContactSpace& space, double step) {
  const bool is_symmetric = space.is_symmetric();
  by_.rubbed.clear();
  for (int place = 0; place < space.places(); ++place) {
    if (!slopes[size(place)].friction.isZero(0.0)) by_.rubbed.push_back(place);
  }
  const std::size_t pressed = by_.pressed.size(), rubbed = by_.rubbed.size();
  by_.W.resize(rubbed * pressed);
  by_.V.resize(rubbed * pressed);
  by_.R.resize(rubbed * rubbed);
  by_.whole.resize(rubbed);
  by_.frictions.clear();
  for (std::size_t j = 0; j < rubbed; ++j) {
    const int place = by_.rubbed[j];
    Mat3* const to_press = &by_.W[j * pressed];
    Mat3* const from_press = &by_.V[j * pressed];
    for (std::size_t i = 0; i < pressed; ++i) {
      const int other = by_.pressed[i];
      const Mat3 left = (step * by_.roots[i]).transpose();
      if (is_symmetric && place > other) {
        to_press[i] = left * space.delassus(place, other).block<3, 3>(3, 0).transpose();
      } else {
        to_press[i] = left * space.delassus(other, place).block<3, 3>(0, 3);
      }
      if (is_symmetric) continue;
      from_press[i] = left * space.delassus(place, other).block<3, 3>(3, 0).transpose();
    }
    by_.normal.solve_lower(to_press);
    if (!is_symmetric) by_.normal.solve_transposed_upper(from_press);
    for (std::size_t i = 0; i < pressed; ++i) {
      from_press[i] = (is_symmetric ? to_press[i] : from_press[i]).transpose();
    }
  }
  for (std::size_t j = 0; j < rubbed; ++j) {
    for (std::size_t k = 0; k < (is_symmetric ? j + 1 : rubbed); ++k) {
      const ContactSpace::Square& lambda = space.delassus(by_.rubbed[j], by_.rubbed[k]);
      Mat3 response = step * lambda.block<3, 3>(3, 3);
      if (j == k) by_.whole[j] = response.diagonal();
      for (std::size_t i = 0; i < pressed; ++i) {
        response -= by_.V[j * pressed + i] * by_.W[k * pressed + i];
      }
      by_.R[j * rubbed + k] = response;
    }
  }
}

void ContactEquations::factor_friction() {
  const std::size_t count = by_.rubbed.size();
  const bool is_symmetric = by_.normal.is_symmetric();
  by_.frictions.clear();
  by_.friction_roots.clear();
  rubbing_.clear();
  for (std::size_t j = 0; j < count; ++j) {
    const Vec3& slope = by_.frictions.emplace_back(slopes[size(by_.rubbed[j])].friction);
    by_.friction_roots.push_back(slope.cwiseSqrt());
    rubbing_.push_back(Vec3::Constant(1.0) + slope.cwiseProduct(by_.whole[j]));
  }
  by_.friction.reset(static_cast<int>(count), is_symmetric);
  for (std::size_t j = 0; j < count; ++j) {
    const auto left = by_.friction_roots[j].asDiagonal();
    for (std::size_t k = 0; k < (is_symmetric ? j + 1 : count); ++k) {
      const auto right = by_.friction_roots[k].asDiagonal();
      by_.friction(static_cast<int>(j), static_cast<int>(k)) = left * by_.R[j * count + k] * right;
    }
    Mat3& own = by_.friction(static_cast<int>(j), static_cast<int>(j));
    for (int k = 0; k < 3; ++k) own(k, k) += 1.0;
  }
  by_.friction.factor(rubbing_.data());
}

// Takes L y off the forces.
void ContactEquations::take_off(const ContactSpace& space, double step,
                                std::vector<double>& force) {
  if (!is_of_normal_slopes()) factor_normal(space, step);
  const std::size_t pressed = by_.pressed.size();
  const auto at = [&](int place) { return &response_[size(kRows * place)]; };
  pressing_.resize(pressed);
  for (std::size_t i = 0; i < pressed; ++i) {
    pressing_[i] = by_.roots[i].transposed_times(Vec3::from(at(by_.pressed[i])));
  }
  by_.normal.solve_lower(pressing_.data());
  if (has_friction()) {
    if (!knows_all_that_rub()) respond_to_friction(space, step);
    if (!is_of_frictions()) factor_friction();
    const std::size_t rubbed = by_.rubbed.size();
    rubbing_.resize(rubbed);
    for (std::size_t j = 0; j < rubbed; ++j) {
      Vec3 motion = Vec3::from(at(by_.rubbed[j]) + 3);
      for (std::size_t i = 0; i < pressed; ++i) motion -= by_.V[j * pressed + i] * pressing_[i];
      rubbing_[j] = by_.friction_roots[j].cwiseProduct(motion);
    }
    by_.friction.solve(rubbing_.data());
    for (std::size_t j = 0; j < rubbed; ++j) {
      const Vec3 less = by_.friction_roots[j].cwiseProduct(rubbing_[j]);
      double* const f = &force[size(kRows * by_.rubbed[j] + 3)];
      (Vec3::from(f) - less).to(f);
      for (std::size_t i = 0; i < pressed; ++i) pressing_[i] -= by_.W[j * pressed + i] * less;
    }
  }
  by_.normal.solve_upper(pressing_.data());
  for (std::size_t i = 0; i < pressed; ++i) {
    double* const f = &force[size(kRows * by_.pressed[i])];
    (Vec3::from(f) - by_.roots[i] * pressing_[i]).to(f);
  }
}

void ContactEquations::solve_for_forces(const ContactSpace& space, double step,
                                        std::vector<double>& force, std::vector<double>& velocity) {
  force.assign(constant.begin(), constant.end());
  velocity.resize(size(space.rows()));
  response_.resize(size(space.rows()));
  space.move_by_delassus(force.data(), response_.data());
  take_off(space, step, force);
  space.move_by_delassus(force.data(), velocity.data());
  keep_to_slopes(velocity);
}

// y = L' u': where contact is stiff this knows u' far better than its forces do, whose rounding it
// is that moves what is light.
void ContactEquations::keep_to_slopes(std::vector<double>& velocity) const {
  for (std::size_t i = 0; i < by_.pressed.size(); ++i) {
    double* const u = &velocity[size(kRows * by_.pressed[i])];
    const Mat3& root = by_.roots[i];
    Vec3 left = pressing_[i] - root.transposed_times(Vec3::from(u));
    for (int k = 2; k >= 0; --k) {
      for (int j = k + 1; j < 3; ++j) left[k] -= root(j, k) * left[j];
      left[k] = root(k, k) > 0.0 ? left[k] / root(k, k) : 0.0;
    }
    (Vec3::from(u) + left).to(u);
  }
  if (!has_friction()) return;
  for (std::size_t j = 0; j < by_.rubbed.size(); ++j) {
    double* const u = &velocity[size(kRows * by_.rubbed[j] + 3)];
    for (int k = 0; k < 3; ++k) {
      const double root = by_.friction_roots[j][k];
      if (root > 0.0) u[k] = rubbing_[j][k] / root;
    }
  }
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
  if (!by.is_valid || by.slopes != slopes) factor(space, step, by);
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
