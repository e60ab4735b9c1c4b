// SPDX-License-Identifier: Apache-2.0
#include "volcontact/step/implicit_step.h"

#include <algorithm>
#include <cmath>

#include "volcontact/base/sizes.h"
#include "volcontact/base/symmetric_eigen.h"
#include "volcontact/step/explicit_bounds.h"

namespace volcontact {
namespace {

using ConstVector = Eigen::Map<const Eigen::VectorXd>;

// What lies below this bound is left to the explicit force; in between it is shared.
constexpr double kSoftNumber = 0.2 * kStiffNumber;

double implicit_share(double stiffness_number) {
  return std::clamp((stiffness_number - kSoftNumber) / (kStiffNumber - kSoftNumber), 0.0, 1.0);
}

// How much a point settles that comes out of the overlap at `speed`, where free motion changes
// speeds by `fall` in a step: what is as slow as a few of these.
double settling(double speed, double fall) {
  constexpr double kSettles = 5.0, kBounces = 10.0;
  if (!(fall > 0.0)) return 0.0;
  return std::clamp((kBounces - speed / fall) / (kBounces - kSettles), 0.0, 1.0);
}

// Numerical damping of what settles, as a multiple of h K: with less a box rocks from edge to edge
// for ever.
constexpr double kSettling = 1.5;

// The same of all where the force is held while positions move with the mean of the velocities
// before and after the step: without it a stiff contact overshoots, and lifts off again and again.
double holding(double stiffness_number) {
  constexpr double kMost = 2.0, kHalf = 10.0;
  return kMost * stiffness_number / (stiffness_number + kHalf);
}

}  // namespace

void ImplicitStep::clear() {
  sites_.clear();
  limits_.clear();
  places_.clear();
}

void ImplicitStep::add(const ContactModel& model, ContactReport& report, std::size_t site,
                       int body_a, int body_b, const Twist& driven, bool is_stiff) {
  const SiteLaws laws(model, report, site);
  sites_.push_back({laws, &model, &report, site, laws.tangent()});
  sites_.back().is_stiff = is_stiff;
  sites_.back().pair = limits_.size() - 1;
  places_.push_back(
      {body_a, body_b, report.sites[site].metrics.centroid, sites_.back().tangent.axes, driven});
}

// The points of a patch and what each bears: f = f_0 - D (u' - u) - h K u', with the damping's
// share of f_0 taken out again, so that the constant is what a motionless contact would bear.
void ImplicitStep::place_points(Site& site, const Mat3& mobility, const Vec3& falling,
                                double resting, ImplicitParts parts, double step) {
  using Vec2 = Eigen::Vector2d;
  const SiteReport& report = site.report->sites[site.index];
  const SiteTangent& tangent = site.tangent;
  const double k = tangent.stiffness(0, 0), damping = tangent.damping(0, 0);
  const double force = report.normal_force - damping * report.approach_speed;
  const Vec3 torque = tangent.axes.transpose() * site.report->inputs[site.index].elastic_torque;
  // The patch's centre and spread, back from the stiffness: k (1, y, -x) (1, y, -x)'.
  Vec2 centre = Vec2::Zero();
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  if (k > 0.0) {
    centre = Vec2(-tangent.stiffness(0, 2), tangent.stiffness(0, 1)) / k;
    spread << tangent.stiffness(2, 2), -tangent.stiffness(1, 2), -tangent.stiffness(1, 2),
        tangent.stiffness(1, 1);
    spread = spread / k - centre * centre.transpose();
  }
  // Where the force acts, times the force.
  const Vec2 moment(-torque[1], torque[0]);
  const auto principal = symmetric_eigen(spread);
  const double number = step * step * k;
  const double share =
      parts == ImplicitParts::kStiff ? implicit_share(number * mobility(0, 0)) : 1.0;

  Vec2 place = Vec2::Zero();  // of all points together
  if (force > 0.0) place = moment / force;
  double reach[2] = {0.0, 0.0}, lean[2] = {0.0, 0.0};
  bool split[2] = {false, false};
  for (int i = 0; i < 2; ++i) {
    const Vec2 axis = principal.vectors.col(i);
    const double square = std::max(0.0, principal.values[i]);
    const Vec2 turn(axis[1], -axis[0]);
    const double turn_number =
        number * square * turn.dot(mobility.bottomRightCorner<2, 2>() * turn);
    split[i] = square > 0.0 && (parts != ImplicitParts::kStiff || turn_number > kSoftNumber);
    if (!split[i]) continue;
    reach[i] = std::sqrt(square);
    const double at = axis.dot(centre);
    place += (at - axis.dot(place)) * axis;
    lean[i] = (axis.dot(moment) - force * at) / reach[i];
  }
  const int count = (split[0] ? 2 : 1) * (split[1] ? 2 : 1);
  site.point_count = 0;
  double sum = 0.0;
  for (const double s0 : {-1.0, 1.0}) {
    if (!split[0] && s0 > 0.0) continue;
    for (const double s1 : {-1.0, 1.0}) {
      if (!split[1] && s1 > 0.0) continue;
      const Vec2 at = place + s0 * reach[0] * principal.vectors.col(0) +
                      s1 * reach[1] * principal.vectors.col(1);
      Point& point = site.points[size(site.point_count++)];
      point.motion = {1.0, at.y(), -at.x()};
      point.pushes = true;
      point.constant = std::max(0.0, (force + s0 * lean[0] + s1 * lean[1]) / count);
      sum += point.constant;
    }
  }
  for (int i = 0; i < site.point_count; ++i) {
    Point& point = site.points[size(i)];
    if (sum > 0.0) point.constant *= std::max(0.0, force) / sum;
    const double weight = force > 0.0 ? point.constant / force : 1.0 / count;
    const double depth = k > 0.0 ? point.constant * count / k : 0.0;
    const double fall = std::max(std::abs(point.motion.dot(falling)), resting);
    point.full = point.constant;
    const double settles = settling(depth / step, fall);
    const double extra = parts == ImplicitParts::kHeld
                             ? std::max(settles, holding(number * mobility(0, 0)))
                             : kSettling * settles;
    point.slope = step * share * (1.0 + extra) * k / count + damping * weight;
  }
  // Damping of turns about the axes along which there is one point only.
  site.rolls.setZero();
  for (int i = 0; i < 2; ++i) {
    if (split[i]) continue;
    const Vec2 axis = principal.vectors.col(i);
    const Vec3 turn(0.0, axis[1], -axis[0]);
    const double about = turn.dot(tangent.damping * turn);
    site.rolls.col(1 + i) = std::sqrt(std::max(0.0, about)) * turn;
  }
}

void ImplicitStep::make_points(ImplicitParts parts, double step, double resting) {
  for (std::size_t i = 0; i < island_.size(); ++i) {
    const Eigen::Index first = static_cast<Eigen::Index>(i) * kRows;
    const Vec3 falling = (space_.free_velocity() - space_.velocity()).segment<3>(first);
    place_points(site(i), space_.mobility(i).topLeftCorner<3, 3>(), falling, resting, parts, step);
  }
}

// The linear model of the sites as they are now: whether points push, how friction acts.
void ImplicitStep::solve_once(bool with_friction, double step) {
  std::vector<double>& constants = equations_.constant;
  std::vector<ContactEquations::Column>& columns = equations_.columns;
  constants.assign(size(space_.rows()), 0.0);
  columns.clear();
  for (std::size_t i = 0; i < island_.size(); ++i) {
    const Site& site = this->site(i);
    if (!site.pushes()) continue;
    const int first = static_cast<int>(i) * kRows;
    Eigen::Map<Vec3> constant(&constants[size(first)]);
    for (int k = 0; k < site.point_count; ++k) {
      const Point& point = site.points[size(k)];
      if (!point.pushes) continue;
      constant += point.constant * point.motion;
      columns.push_back({std::sqrt(point.slope) * point.motion, first});
    }
    for (int k = 1; k < 3; ++k) {
      if (!site.rolls.col(k).isZero(0.0)) columns.push_back({site.rolls.col(k), first});
    }
    if (!with_friction) continue;
    std::copy_n(site.held.data(), 3, &constants[size(first + 3)]);
    if (!(site.rub > 0.0)) continue;
    const double root = std::sqrt(site.rub);
    columns.push_back({Vec3(root, 0.0, 0.0), first + 3});
    columns.push_back({Vec3(0.0, root, 0.0), first + 3});
    const double lever = site.tangent.friction.lever;
    if (lever > 0.0) columns.push_back({Vec3(0.0, 0.0, root * lever), first + 3});
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
    const Vec3 motion = Eigen::Map<const Vec3>(&velocity_[i * size(kRows)]);
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
  const Eigen::Index first = static_cast<Eigen::Index>(i) * kRows;
  const ConstVector u(velocity_.data(), space_.rows());
  return 0.5 * (space_.velocity().segment<kRows>(first) + u.segment<kRows>(first));
}

// The power that the forces take from the motion over the step.
ByChannel ImplicitStep::taken(const Site& site, std::size_t i) const {
  const ContactSpace::Block mean = mean_motion(i);
  const double* f = &force_[i * size(kRows)];
  const Eigen::Vector2d turning = mean.segment<2>(1);
  ByChannel out;
  out.roll = turning.dot(site.tangent.damping.bottomRightCorner<2, 2>() * turning);
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
    site.force = ConstVector(&force_[i * size(kRows)], kRows);
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
    site.force << force[2], torque[0], torque[1], force[0], force[1], torque[2];
    std::copy_n(site.force.data(), kRows, &force_[i * size(kRows)]);
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
  const ConstVector now(force_.data(), space_.rows()), before(before_.data(), space_.rows());
  return (now - before).lpNorm<Eigen::Infinity>() <= kChange * now.lpNorm<Eigen::Infinity>();
}

// Normal forces and friction, under the shares of now; leaves the motion that they make.
void ImplicitStep::solve_contacts(FrictionBound bound, double step) {
  constexpr int kFrictionPasses = 3;
  solve_active(false, step);
  for (std::size_t i = 0; i < island_.size(); ++i) {
    site(i).rub = 0.0;
    site(i).free_speed = slip_of(site(i), velocity_, i).norm();
    site(i).free_normal = normal_force(i);
  }
  const bool rubs = std::any_of(island_.begin(), island_.end(),
                                [this](int i) { return sites_[size(i)].laws.has_friction(); });
  for (int pass = 0; rubs && pass < kFrictionPasses; ++pass) {
    before_ = force_;
    set_friction(step);
    solve_active(true, step);
    if (is_settled()) break;
  }
  if (rubs) damp_friction(step);
  if (rubs && bound == FrictionBound::kCut) bound_friction();
  space_.move(force_, velocity_);
}

void ImplicitStep::solve_island(ImplicitParts parts, double step, double resting) {
  space_.build_mobility();
  equations_.forget();
  make_points(parts, step, resting);
  set_shares();
  solve_contacts(FrictionBound::kCut, step);
  limit_work(step, resting);
}

// The pairs that have sites in the island; these stand together.
template <typename Use>
void ImplicitStep::for_each_pair(Use use) {
  const WorkLimit* last = nullptr;
  for (const int i : island_) {
    WorkLimit& limit = limits_[sites_[size(i)].pair];
    if (&limit != last) use(limit);
    last = &limit;
  }
}

void ImplicitStep::set_shares() {
  for (std::size_t i = 0; i < island_.size(); ++i) {
    Site& site = this->site(i);
    const double share = limits_[site.pair].share;
    for (Point& point : site.points) point.constant = share * point.full;
  }
}

// The work that the contacts do over the step, by pair.
void ImplicitStep::add_up_work(double step, double resting) {
  constexpr double kRounding = 1e-9;
  for_each_pair([](WorkLimit& limit) {
    limit.normal_work = limit.friction_work = limit.slack = limit.exit = limit.from_free = 0.0;
    limit.pushes = false;
  });
  double from_free = 0.0, allowed = 0.0;
  for (std::size_t i = 0; i < island_.size(); ++i) {
    const Eigen::Index first = static_cast<Eigen::Index>(i) * kRows;
    const ContactSpace::Block impulse = step * ConstVector(&force_[i * size(kRows)], kRows);
    const ContactSpace::Block end = ConstVector(&velocity_[i * size(kRows)], kRows);
    const ContactSpace::Block begin = space_.velocity().segment<kRows>(first);
    const ContactSpace::Block free = space_.free_velocity().segment<kRows>(first);
    const ContactSpace::Block mean = 0.5 * (begin + end), mean_of_free = 0.5 * (free + end);
    WorkLimit& limit = limits_[site(i).pair];
    limit.normal_work += impulse.head<3>().dot(mean.head<3>());
    limit.friction_work += impulse.tail<3>().dot(mean.tail<3>());
    limit.from_free += impulse.head<3>().dot(mean_of_free.head<3>());
    // What gravity does meanwhile: no more than to the weight that may rest on the pair.
    limit.slack += 0.5 * std::min(impulse[0], resting * mass_) * resting +
                   kRounding * impulse.cwiseAbs().dot(begin.cwiseAbs() + end.cwiseAbs());
    limit.pushes = limit.pushes || impulse[0] > 0.0;
    if (impulse[0] > 0.0) limit.exit = std::max(limit.exit, end[0]);
    from_free += impulse.dot(mean_of_free);
  }
  // Where other forces turn velocities round, the energy is that of the free motion and what the
  // contacts of the island add to it; at rest they take it all.
  for_each_pair([&](const WorkLimit& limit) { allowed += limit.allowed() + limit.rubbed; });
  if (from_free <= allowed) return;
  for_each_pair(
      [](WorkLimit& limit) { limit.normal_work = std::max(limit.normal_work, limit.from_free); });
}

// Elastic forces that would do more work on the bodies than these put in act with a share of
// theirs. With none the contacts damp, whatever the poses: docs/theory.md, "No energy from
// nothing". What damps at the end of a step in which other forces turned the motion round does work
// all the same, and waits for the next.
void ImplicitStep::limit_work(double step, double resting) {
  constexpr int kSearches = 8;
  enum { kSearch, kLowest, kNone, kAllNone } last = kSearch;
  for_each_pair([](WorkLimit& limit) { limit.start(); });
  for (int round = 0; last != kAllNone; ++round) {
    add_up_work(step, resting);
    bool changed = false, kept = true;
    for_each_pair([&](const WorkLimit& limit) { kept = kept && limit.is_kept(); });
    if (round < kSearches) {
      for_each_pair([&](WorkLimit& limit) { changed = limit.search() || changed; });
      if (!changed) return;
    } else {
      if (kept) return;
      last = last == kSearch ? kLowest : last == kLowest ? kNone : kAllNone;
      for_each_pair([&](WorkLimit& limit) {
        if (last == kAllNone || (last == kNone && !limit.is_kept())) limit.share = 0.0;
        if (last == kLowest && !limit.is_kept())
          limit.share = limit.low.share < limit.share ? limit.low.share : 0.0;
      });
    }
    set_shares();
    solve_contacts(FrictionBound::kDamped, step);
  }
  add_up_work(step, resting);
  for (bool waits = true; waits;) {
    waits = false;
    for_each_pair([&waits](WorkLimit& limit) {
      if (!limit.acts || limit.is_kept_nearly()) return;
      limit.acts = false;
      waits = true;
    });
    if (!waits) break;
    solve_contacts(FrictionBound::kDamped, step);
    add_up_work(step, resting);
  }
  share_deficit();
}

// Where pairs did more than they hold, their friction or other pairs of the island have paid for
// it: these have put in the less.
void ImplicitStep::share_deficit() {
  for_each_pair([](WorkLimit& limit) { limit.pay_with_friction(); });
  double deficit = 0.0, put_in = 0.0;
  for_each_pair([&](const WorkLimit& limit) {
    deficit += std::max(0.0, limit.work() - limit.allowed());
    put_in += std::max(0.0, -limit.work());
  });
  if (!(deficit > 0.0 && put_in > 0.0)) return;
  const double left = std::max(0.0, 1.0 - deficit / put_in);
  for_each_pair([left](WorkLimit& limit) {
    if (limit.work() < 0.0) limit.normal_work *= left;
  });
}

// Solves again until the native constraints bear what was taken for granted.
void ImplicitStep::solve_with_constraints(const Mechanism& mechanism,
                                          LinearConstraints& constraints, ImplicitParts parts,
                                          int island, const double* known) {
  constexpr int kRounds = 12;
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
  for (int round = 0; round < kRounds; ++round) {
    space_.constrain(constraints);
    force_.resize(size(space_.rows()));
    velocity_.resize(size(space_.rows()));
    if (is_stiff) {
      solve_island(parts, step, resting);
    } else {
      take_explicit();
    }
    if (constraints.empty()) break;
    space_.accelerate(force_, acceleration_);
    if (constraints.improve(acceleration_)) break;
  }
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
  for (int k = 0; k < site.point_count; ++k) {
    const Point& point = site.points[size(k)];
    if (point.pushes) out.head<3>() += point.constant * point.motion;
  }
  out.tail<3>() = site.held;
  return out;
}

Eigen::Matrix<double, 6, 6> ImplicitStep::slope(std::size_t i) const {
  Eigen::Matrix<double, 6, 6> out = Eigen::Matrix<double, 6, 6>::Zero();
  const Site& site = sites_[i];
  if (!site.pushes()) return out;
  for (int k = 0; k < site.point_count; ++k) {
    const Point& point = site.points[size(k)];
    if (!point.pushes) continue;
    out.topLeftCorner<3, 3>() += point.slope * point.motion * point.motion.transpose();
  }
  out.topLeftCorner<3, 3>() += site.rolls * site.rolls.transpose();
  const double lever = site.tangent.friction.lever;
  out.diagonal().tail<3>() = site.rub * Vec3(1.0, 1.0, lever * lever);
  return out;
}

}  // namespace volcontact
