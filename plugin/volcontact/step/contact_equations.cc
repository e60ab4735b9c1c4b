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
  by_.rubs = may_rub || has_friction();
  by_.slopes.clear();
  by_.pressed.clear();
  by_.roots.clear();
  by_.inverse_roots.clear();
  by_.frictions.clear();
  for (int place = 0; place < space.places(); ++place) {
    const Mat3& slope = by_.slopes.emplace_back(slopes[size(place)].normal);
    if (slopes[size(place)].is_zero()) continue;
    by_.pressed.push_back(place);
    const Mat3& root = by_.roots.emplace_back(cholesky(slope));
    Vec3& inverse = by_.inverse_roots.emplace_back(Vec3::Zero());
    for (int k = 0; k < 3; ++k) {
      if (root(k, k) > 0.0) inverse[k] = 1.0 / root(k, k);
    }
  }
  const bool is_symmetric = space.is_symmetric();
  const int count = static_cast<int>(by_.pressed.size());
  by_.whole.resize(size(count));
  by_.pressing.reset(by_.rubs ? 6 * count : 3 * count, is_symmetric);
  for (int k = 0; k < count; ++k) set_columns(space, step, k);
  by_.pressing.eliminate(3 * count);
  by_.is_valid = true;
}

// The columns of a place, of a symmetric matrix from the diagonal on.
void ContactEquations::set_columns(const ContactSpace& space, double step, int k) {
  const int count = static_cast<int>(by_.pressed.size());
  const bool is_symmetric = by_.pressing.is_symmetric();
  const int place = by_.pressed[size(k)];
  responses_.resize(kRows * space.stride());
  multiply_by_root(space.delassus(place), space.stride(), step * by_.roots[size(k)],
                   responses_.data());
  for (int c = 0; c < 3; ++c) {
    const double* const from = responses_.data() + size(c) * space.stride();
    double* const to = by_.pressing.column(3 * k + c);
    for (int i = is_symmetric ? k : 0; i < count; ++i) {
      const Vec3 moved = Vec3::from(from + kRows * by_.pressed[size(i)]);
      by_.roots[size(i)].transposed_times(moved).to(to + 3 * i);
    }
    to[3 * k + c] += 1.0;
    if (!by_.rubs) continue;
    for (int i = 0; i < count; ++i) {
      Vec3::from(from + kRows * by_.pressed[size(i)] + 3).to(to + 3 * (count + i));
    }
  }
  if (!by_.rubs) return;
  for (int c = 0; c < 3; ++c) {
    const double* const from = space.delassus(place) + size(3 + c) * space.stride();
    double* const to = by_.pressing.column(3 * (count + k) + c);
    for (int i = 0; !is_symmetric && i < count; ++i) {
      const Vec3 moved = step * Vec3::from(from + kRows * by_.pressed[size(i)]);
      by_.roots[size(i)].transposed_times(moved).to(to + 3 * i);
    }
    for (int i = is_symmetric ? k : 0; i < count; ++i) {
      (step * Vec3::from(from + kRows * by_.pressed[size(i)] + 3)).to(to + 3 * (count + i));
    }
    by_.whole[size(k)][c] = to[3 * (count + k) + c];
  }
}

bool ContactEquations::knows_all_that_rub() const {
  if (!by_.rubs) return !has_friction();
  std::size_t next = 0;
  for (std::size_t place = 0; place < slopes.size(); ++place) {
    const bool is_known = next < by_.pressed.size() && by_.pressed[next] == static_cast<int>(place);
    if (is_known) ++next;
    if (!is_known && !slopes[place].friction.isZero(0.0)) return false;
  }
  return true;
}

bool ContactEquations::is_of_frictions() const {
  return by_.frictions.size() == by_.pressed.size() &&
         std::equal(by_.pressed.begin(), by_.pressed.end(), by_.frictions.begin(),
                    [this](int place, const Vec3& friction) {
                      return slopes[size(place)].friction == friction;
                    });
}

void ContactEquations::factor_friction() {
  const int count = static_cast<int>(by_.pressed.size()), first = 3 * count;
  const bool is_symmetric = by_.pressing.is_symmetric();
  by_.frictions.clear();
  by_.friction_roots.clear();
  rubbing_.clear();
  for (int j = 0; j < count; ++j) {
    const Vec3& slope = by_.frictions.emplace_back(slopes[size(by_.pressed[size(j)])].friction);
    by_.friction_roots.push_back(slope.cwiseSqrt());
    const Vec3 whole = Vec3::Constant(1.0) + slope.cwiseProduct(by_.whole[size(j)]);
    rubbing_.insert(rubbing_.end(), whole.begin(), whole.end());
  }
  const double* const root = by_.friction_roots.data()->data();
  by_.rubbing.reset(first, is_symmetric);
  for (int i = 0; i < first; ++i) {
    const double* const from = by_.pressing.column(first + i) + first;
    double* const to = by_.rubbing.column(i);
    for (int k = is_symmetric ? i : 0; k < first; ++k) to[k] = root[i] * from[k] * root[k];
    to[i] += 1.0;
  }
  by_.rubbing.eliminate(first, rubbing_.data());
}

// Takes L y off the forces.
void ContactEquations::take_off(const ContactSpace& space, double step,
                                std::vector<double>& force) {
  if (!is_of_normal_slopes() || !knows_all_that_rub()) factor_normal(space, step);
  const std::size_t pressed = by_.pressed.size();
  const auto at = [&](std::size_t i) { return &response_[size(kRows * by_.pressed[i])]; };
  const bool rubs = has_friction();
  pressing_.assign(size(by_.pressing.size() + kLanes), 0.0);
  for (std::size_t i = 0; i < pressed; ++i) {
    by_.roots[i].transposed_times(Vec3::from(at(i))).to(&pressing_[3 * i]);
    if (rubs) Vec3::from(at(i) + 3).to(&pressing_[3 * (pressed + i)]);
  }
  by_.pressing.go_down(pressing_.data());
  if (rubs) {
    if (!is_of_frictions()) factor_friction();
    rubbing_.assign(3 * pressed + kLanes, 0.0);
    for (std::size_t j = 0; j < pressed; ++j) {
      by_.friction_roots[j]
          .cwiseProduct(Vec3::from(&pressing_[3 * (pressed + j)]))
          .to(&rubbing_[3 * j]);
    }
    by_.rubbing.go_down(rubbing_.data());
    by_.rubbing.go_up(rubbing_.data());
  }
  if (by_.rubs) {
    for (std::size_t j = 0; j < pressed; ++j) {
      Vec3 less = Vec3::Zero();
      if (rubs) less = by_.friction_roots[j].cwiseProduct(Vec3::from(&rubbing_[3 * j]));
      less.to(&pressing_[3 * (pressed + j)]);
      double* const f = &force[size(kRows * by_.pressed[j] + 3)];
      (Vec3::from(f) - less).to(f);
    }
  }
  by_.pressing.go_up(pressing_.data());
  for (std::size_t i = 0; i < pressed; ++i) {
    double* const f = &force[size(kRows * by_.pressed[i])];
    (Vec3::from(f) - by_.roots[i] * Vec3::from(&pressing_[3 * i])).to(f);
  }
}

void ContactEquations::solve_for_forces(ContactSpace& space, double step,
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
    const Vec3& inverse = by_.inverse_roots[i];
    Vec3 left = Vec3::from(&pressing_[3 * i]) - root.transposed_times(Vec3::from(u));
    left[2] = inverse[2] * left[2];
    left[1] = inverse[1] * (left[1] - root(2, 1) * left[2]);
    left[0] = inverse[0] * ((left[0] - root(1, 0) * left[1]) - root(2, 0) * left[2]);
    (Vec3::from(u) + left).to(u);
  }
  if (!has_friction()) return;
  for (std::size_t j = 0; j < by_.pressed.size(); ++j) {
    double* const u = &velocity[size(kRows * by_.pressed[j] + 3)];
    for (int k = 0; k < 3; ++k) {
      const double root = by_.friction_roots[j][k];
      if (root > 0.0) u[k] = rubbing_[3 * j + size(k)] / root;
    }
  }
}

// Adds h J' C J of one place to the matrix.
void ContactEquations::add_slope(const ContactSpace& space, int place, double step,
                                 EnvelopeMatrix& matrix) const {
  const Slope& slope = slopes[size(place)];
  for (const ContactSpace::Move& from : space.moves(place)) {
    const ContactSpace::Block response = step * (slope * from.column.rows());
    for (const ContactSpace::Move& to : space.moves(place)) {
      if (to.dof >= from.dof) matrix.add_both(to.dof, from.dof, to.column.rows().dot(response));
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
