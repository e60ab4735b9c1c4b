// SPDX-License-Identifier: Apache-2.0
#include "volcontact/step/implicit_step.h"

#include <algorithm>
#include <cmath>

#include "volcontact/base/sizes.h"

namespace volcontact {
namespace {

constexpr int kConstraintRounds = 12;

}  // namespace

void ImplicitStep::clear() {
  sites_.clear();
  limits_.clear();
  places_.clear();
}

void ImplicitStep::add(const ContactModel& model, ContactReport& report, std::size_t site,
                       int body_a, int body_b, const Twist& driven, bool is_stiff) {
  Site& added = sites_.emplace_back(SiteLaws(model, report, site), &report, site);
  added.is_stiff = is_stiff;
  added.pair = limits_.size() - 1;
  places_.push_back(
      {body_a, body_b, report.sites[site].metrics.centroid, added.tangent.axes, driven});
}

// The linear model of the sites as they are now: whether points push, how friction acts.
void ImplicitStep::solve_once(bool with_friction, double step) {
  std::vector<double>& constants = equations_.constant;
  std::vector<ContactEquations::Slope>& slopes = equations_.slopes;
  constants.assign(size(space_.rows()), 0.0);
  slopes.assign(island_.size(), {});
  for (std::size_t i = 0; i < island_.size(); ++i) {
    const Site& site = this->site(i);
    if (!site.pushes()) continue;
    const int first = static_cast<int>(i) * kRows;
    Vec3 constant = Vec3::Zero();
    for (int k = 0; k < site.point_count; ++k) {
      const Point& point = site.points[size(k)];
      if (!point.pushes) continue;
      constant += point.constant * point.motion;
    }
    constant.to(&constants[size(first)]);
    slopes[i].normal = site.normal_slope();
    if (!with_friction) continue;
    site.held.to(&constants[size(first + 3)]);
    slopes[i].friction = site.friction_slope();
  }
  equations_.solve(space_, step, force_, velocity_);
}

// Solves with the points that push, leaves out those that would pull and takes back those that
// would push, or not. Returns whether none had to change.
bool ImplicitStep::improve_active(bool with_friction, bool takes_back, double step) {
  solve_once(with_friction, step);
  bool changed = false;
  for (std::size_t i = 0; i < island_.size(); ++i) {
    if (!limits_[site(i).pair].acts) continue;
    const Vec3 motion = Vec3::from(&velocity_[i * size(kRows)]);
    for (int k = 0; k < site(i).point_count; ++k) {
      Point& point = site(i).points[size(k)];
      const bool pushes = point.constant - point.slope * point.motion.dot(motion) > 0.0;
      if (point.pushes == pushes || (pushes && !takes_back)) continue;
      point.pushes = pushes;
      changed = true;
    }
  }
  return !changed;
}

// Finds the points that push, of which none pulls. Those that pushed in the solution before are
// tried first: few change from one solution of a step to the next.
void ImplicitStep::solve_active(bool with_friction, double step) {
  constexpr int kFirstRounds = 6, kRounds = 12;
  const auto set_points = [this](auto pushes) {
    for (std::size_t i = 0; i < island_.size(); ++i) {
      const bool acts = limits_[site(i).pair].acts;
      for (Point& point : site(i).points) point.pushes = acts && pushes(point);
    }
  };
  set_points([](const Point& point) { return point.pushes; });
  for (int round = 0; round < kFirstRounds; ++round) {
    if (improve_active(with_friction, true, step)) return;
  }
  set_points([](const Point&) { return true; });
  // Who was left out comes back where it is needed, in the first rounds: else it might go on.
  for (int round = 0; round < kRounds; ++round) {
    if (improve_active(with_friction, round < kRounds / 2, step)) return;
  }
}

// Of the motion at the begin of the step and that at its end.
ContactSpace::Block ImplicitStep::mean_motion(std::size_t i) const {
  return 0.5 * (space_.velocity(i) + ContactSpace::Block::from(&velocity_[i * size(kRows)]));
}

// The power that the forces take from the motion over the step.
ByChannel ImplicitStep::taken(const Site& site, std::size_t i) const {
  const ContactSpace::Block mean = mean_motion(i);
  const double* f = &force_[i * size(kRows)];
  const Vec2 turning(mean[1], mean[2]);
  ByChannel out;
  out.roll = turning.dot(site.tangent.damping.block<2, 2>(1, 1) * turning);
  out.normal = -(f[0] * mean[0] + f[1] * mean[1] + f[2] * mean[2]) - out.roll;
  out.slide = -(f[3] * mean[3] + f[4] * mean[4]);
  out.spin = -f[5] * mean[5];
  return out;
}

// The reports get the forces, the power they take from the motion, and what friction keeps under
// the normal force that acts.
void ImplicitStep::write_results() {
  for (std::size_t i = 0; i < island_.size(); ++i) {
    Site& site = this->site(i);
    SiteReport& report = site.report->sites[site.index];
    const SiteInputs& inputs = site.report->inputs[site.index];
    const Mat3& axes = site.tangent.axes;
    site.force = ContactSpace::Block::from(&force_[i * size(kRows)]);
    site.is_solved = true;
    const ContactSpace::Block& f = site.force;
    report.normal_force = f[0];
    report.force_on_A = f[0] * axes.col(2) + f[3] * axes.col(0) + f[4] * axes.col(1);
    report.torque_on_A = f[1] * axes.col(0) + f[2] * axes.col(1) + f[5] * axes.col(2);
    site.laws.hold_under(f[0]);
    report.taken = taken(site, i);
    report.power = report.taken;
    report.power.normal += inputs.normal_out.elastic * mean_motion(i)[0];
  }
}

// The forces stay.
void ImplicitStep::take_explicit() {
  for (std::size_t i = 0; i < island_.size(); ++i) {
    Site& site = this->site(i);
    const SiteReport& report = site.report->sites[site.index];
    const Vec3 force = site.tangent.axes.transpose() * report.force_on_A;
    const Vec3 torque = site.tangent.axes.transpose() * report.torque_on_A;
    site.force =
        ContactSpace::Block({force[2], torque[0], torque[1], force[0], force[1], torque[2]});
    site.force.to(&force_[i * size(kRows)]);
  }
}

// The account of a step that is implicit elsewhere wants the power over all of it.
void ImplicitStep::write_explicit() {
  space_.move(force_, velocity_);
  for (std::size_t i = 0; i < island_.size(); ++i) {
    site(i).report->sites[site(i).index].taken = taken(site(i), i);
  }
}

// Whether the last pass changed nothing that counts.
bool ImplicitStep::is_settled() const {
  constexpr double kChange = 1e-9;
  double change = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < force_.size(); ++i) {
    change = std::max(change, std::abs(force_[i] - before_[i]));
    largest = std::max(largest, std::abs(force_[i]));
  }
  return change <= kChange * largest;
}

// Normal forces and friction, under the shares of now; leaves the motion that they make.
void ImplicitStep::solve_contacts(FrictionBound bound, double step) {
  if (equations_.may_rub) {
    solve_with_friction(bound, step);
  } else {
    solve_active(false, step);
  }
  // The solution has the forces of its motion; what counts is the motion of its forces.
  if (space_.prefers_dofs()) {
    space_.move(force_, velocity_);
  } else {
    space_.move_by_delassus(force_.data(), velocity_.data());
  }
}

void ImplicitStep::solve_with_friction(FrictionBound bound, double step) {
  constexpr int kFrictionPasses = 3;
  if (bound == FrictionBound::kCut && solve_at_rest(step)) return;
  solve_active(false, step);
  for (std::size_t i = 0; i < island_.size(); ++i) {
    site(i).rub = 0.0;
    site(i).free_speed = slip_of(site(i), velocity_, i).norm();
    site(i).free_normal = normal_force(i);
  }
  for (int pass = 0; pass < kFrictionPasses; ++pass) {
    before_ = force_;
    const bool changed = set_friction(step);
    if (pass > 0 && !changed) break;
    solve_active(true, step);
    if (is_settled()) break;
  }
  damp_friction(step);
  if (bound == FrictionBound::kCut) bound_friction();
}

void ImplicitStep::solve_island(ImplicitParts parts, double step, double resting) {
  space_.build_mobility();
  equations_.forget();
  equations_.may_rub = std::any_of(island_.begin(), island_.end(),
                                   [this](int i) { return sites_[size(i)].laws.has_friction(); });
  make_points(parts, step, resting);
  set_shares();
  solve_contacts(FrictionBound::kCut, step);
  limit_work(step, resting);
}

// Finds what the native constraints bear under the contact forces of now.
void ImplicitStep::settle(LinearConstraints& constraints) {
  for (int round = 0; round < kConstraintRounds; ++round) {
    space_.constrain(constraints);
    space_.accelerate(force_, acceleration_);
    if (constraints.improve(acceleration_)) return;
  }
}

// The rounds came to no end, so that the motion is not the one that the bodies will have. Under
// forces that stay it can be found; these are the less, down to none, the more work they would do.
void ImplicitStep::bound_unsettled(LinearConstraints& constraints, double step, double resting) {
  constexpr double kLeast = 0.1;
  before_ = force_;
  for (double share = 1.0;; share = share > kLeast ? 0.5 * share : 0.0) {
    for (std::size_t i = 0; i < force_.size(); ++i) force_[i] = share * before_[i];
    settle(constraints);
    space_.move(force_, velocity_);
    add_up_work(step, resting);
    bool kept = true;
    for_each_pair([&kept](const WorkLimit& limit) { kept = kept && limit.is_kept_nearly(); });
    if (kept || share == 0.0) break;
  }
  share_deficit();
}

// Solves again until the native constraints bear what was taken for granted.
void ImplicitStep::solve_with_constraints(const Mechanism& mechanism,
                                          LinearConstraints& constraints, ImplicitParts parts,
                                          int island, const double* known) {
  bool settled = false;
  const double step = mechanism.step, resting = mechanism.fall;
  const bool is_stiff = std::any_of(island_.begin(), island_.end(),
                                    [this](int i) { return sites_[size(i)].is_stiff; });
  mass_ = islands_.mass(island);
  constraints.select(islands_, island);
  for_each_pair([is_stiff](WorkLimit& limit) {
    limit.share = 1.0;
    limit.acts = true;
    limit.is_solved = is_stiff;
  });
  // Where forces are held, positions move with the mean of the velocities before and after.
  if (is_stiff) set_drift(mechanism, parts == ImplicitParts::kHeld ? step : 0.5 * step);
  space_.build(mechanism, places_, islands_, island, known);
  for (int round = 0; round < kConstraintRounds && !settled; ++round) {
    space_.constrain(constraints);
    force_.resize(size(space_.rows()));
    velocity_.resize(size(space_.rows()));
    if (is_stiff) {
      solve_island(parts, step, resting);
    } else {
      take_explicit();
    }
    settled = constraints.empty();
    if (settled) break;
    space_.accelerate(force_, acceleration_);
    settled = constraints.improve(acceleration_);
  }
  if (is_stiff && !settled) bound_unsettled(constraints, step, resting);
  if (is_stiff) {
    write_results();
  } else {
    write_explicit();
  }
}

void ImplicitStep::solve(const Mechanism& mechanism, LinearConstraints& constraints,
                         ImplicitParts parts, const double* known) {
  acceleration_.assign(size(mechanism.trees->dofs()), 0.0);
  islands_.build(*mechanism.trees, places_, constraints.joined());
  for (int island = 0; island < islands_.count(); ++island) {
    island_ = islands_.places(island);
    if (!island_.empty()) solve_with_constraints(mechanism, constraints, parts, island, known);
  }
}

ContactSpace::Block ImplicitStep::constant(std::size_t i) const {
  ContactSpace::Block out = ContactSpace::Block::Zero();
  const Site& site = sites_[i];
  if (!site.pushes()) return out;
  Vec3 pushed = Vec3::Zero();
  for (int k = 0; k < site.point_count; ++k) {
    const Point& point = site.points[size(k)];
    if (point.pushes) pushed += point.constant * point.motion;
  }
  pushed.to(out.data());
  site.held.to(out.data() + 3);
  return out;
}

ContactSpace::Square ImplicitStep::slope(std::size_t i) const {
  ContactSpace::Square out = ContactSpace::Square::Zero();
  const Site& site = sites_[i];
  if (!site.pushes()) return out;
  out.set_block(0, 0, site.normal_slope());
  out.set_block(3, 3, Mat3(site.friction_slope().asDiagonal()));
  return out;
}

}  // namespace volcontact
