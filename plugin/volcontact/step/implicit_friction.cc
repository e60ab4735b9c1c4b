// SPDX-License-Identifier: Apache-2.0
// What ImplicitStep does about friction.
#include <algorithm>
#include <cmath>

#include "volcontact/base/sizes.h"
#include "volcontact/step/implicit_step.h"

namespace volcontact {
namespace {

// The speed s at which friction of the damping c(s) leaves what would move at `free`:
// s (1 + mobility c(s)) = free. Illinois' rule: c(s) s grows with s, or is constant.
template <typename DampingAt>
double speed_left(double free, double mobility, const DampingAt& damping_at) {
  constexpr int kSteps = 12;
  constexpr double kPrecision = 1e-6;
  if (!(free > 0.0)) return 0.0;
  double low = 0.0, high = free, below = -free, above = mobility * damping_at(free) * free;
  double at = free;
  int side = 0;  // of the last step
  for (int i = 0; i < kSteps && above > 0.0 && high - low > kPrecision * high; ++i) {
    at = (low * above - high * below) / (above - below);
    const double error = at * (1.0 + mobility * damping_at(at)) - free;
    if (error > 0.0) {
      if (side > 0) below *= 0.5;
      high = at;
      above = error;
      side = 1;
    } else {
      if (side < 0) above *= 0.5;
      low = at;
      below = error;
      side = -1;
    }
    if (std::abs(error) <= kPrecision * free) break;
  }
  return at;
}

// Strain of friction that holds with ease: half of what it can.
constexpr double kEase = 0.25;

}  // namespace

// Slip as the friction law sees it: along t_1, along t_2, lever times about n.
Vec3 ImplicitStep::slip_of(const Site& site, const std::vector<double>& u, std::size_t i) const {
  const double* at = &u[i * size(kRows) + 3];
  return {at[0], at[1], site.tangent.friction.lever * at[2]};
}

// For friction that holds by what it remembers of the way.
void ImplicitStep::set_drift(const Mechanism& mechanism, double time) {
  for (const int i : island_) {
    Site& site = sites_[size(i)];
    if (!site.laws.has_friction() || !site.laws.friction_keeps()) continue;
    const ContactPlace& place = places_[size(i)];
    const Vec3 turning = turning_acceleration(mechanism, place.body_a, place.point) -
                         turning_acceleration(mechanism, place.body_b, place.point);
    const Mat3& axes = site.tangent.axes;
    site.drift = time * Vec3(axes.col(0).dot(turning), axes.col(1).dot(turning), 0.0);
  }
}

// How the site slides where friction has this strength under the normal force of the last solution,
// and `viscous` times the slip more. Slip and normal force go straight with friction, between the
// last solution and that without any; before there is friction, by the mobility of the site alone.
ImplicitStep::Slide ImplicitStep::slide_under(std::size_t i, double strength, double viscous,
                                              double step) const {
  // From the slide under the strength alone, and how much a unit of friction slows it.
  const auto with_viscous = [viscous](double force, double speed, double slowed) -> Slide {
    const double left = speed > 0.0 ? speed / (1.0 + viscous * slowed) : speed;
    return {force + viscous * std::max(0.0, left), left};
  };
  const Site& site = this->site(i);
  const double lever = site.tangent.friction.lever;
  const double* f = &force_[i * size(kRows) + 3];
  const Vec3 acting(f[0], f[1], lever > 0.0 ? f[2] / lever : 0.0);
  const Vec3 slip = slip_of(site, velocity_, i);
  const double speed = slip.norm(), borne = acting.norm(), normal = normal_force(i);
  if (borne > 0.0 && site.free_speed > speed && normal > 0.0) {
    const double mu = strength / normal, less = 1.0 - mu * (normal - site.free_normal) / borne;
    const double most = less > 0.0 ? mu * site.free_normal / less : strength;
    const double slowed = (site.free_speed - speed) / borne;
    return with_viscous(most, speed + (site.free_speed - speed) * (1.0 - most / borne), slowed);
  }
  const Vec3 direction = speed > 0.0 ? Vec3(slip / speed) : Vec3::UnitX();
  const Vec3 scaled(direction[0], direction[1], lever * direction[2]);
  const double mobility = scaled.dot(space_.mobility(i).block<3, 3>(3, 3) * scaled);
  const double slowed = step * mobility;
  return with_viscous(strength, speed - slowed * (strength + acting.dot(direction)), slowed);
}

// Friction as it will be where nothing slides, by the forces and the motion at the begin of the
// step: where all is held with ease that is right as a rule, and one solution will do. Returns
// whether the solution asks for the same, and no more than friction can hold.
bool ImplicitStep::solve_at_rest(double step) {
  take_explicit();
  std::copy(space_.velocity().begin(), space_.velocity().end(), velocity_.begin());
  for (std::size_t i = 0; i < island_.size(); ++i) {
    Site& site = this->site(i);
    if (!site.laws.has_friction()) continue;
    if (!site.laws.friction_keeps()) return false;
    set_friction_of(site, i, step);
    if (!(site.strain <= kEase)) return false;
  }
  solve_active(true, step);
  if (set_friction(step)) return false;
  return std::all_of(island_.begin(), island_.end(),
                     [this](int i) { return sites_[size(i)].strain <= 1.0; });
}

// Friction under the normal forces of the last solution. Returns whether it is another at a site.
bool ImplicitStep::set_friction(double step) {
  bool changed = false;
  for (std::size_t i = 0; i < island_.size(); ++i) {
    Site& site = this->site(i);
    if (!site.laws.has_friction()) continue;
    const Vec3 held = site.held;
    const double rub = site.rub, lever = site.tangent.friction.lever;
    set_friction_of(site, i, step);
    changed =
        changed || site.held != held || site.rub != rub || site.tangent.friction.lever != lever;
  }
  return changed;
}

// At the slip of the last solution: a spring and a damper while it holds, Coulomb's where it would
// have to hold more.
void ImplicitStep::set_friction_of(Site& site, std::size_t i, double step) {
  const double normal_force = this->normal_force(i);
  const Vec3 slip = slip_of(site, velocity_, i);
  const Mat3& axes = site.tangent.axes;
  const Vec3 along = slip[0] * axes.col(0) + slip[1] * axes.col(1);
  const double spin = velocity_[i * size(kRows) + 5];
  if (!site.laws.friction_keeps()) {
    set_damper(site, normal_force, along, spin, slip.norm());
    return;
  }
  const FrictionOutput still = site.laws.friction(normal_force, Vec3::Zero(), 0.0);
  const FrictionSlope slope = site.laws.friction_slope(normal_force, along, spin);
  site.tangent.friction = slope;
  const double lever = slope.lever;
  const Vec3 held(axes.col(0).dot(still.force), axes.col(1).dot(still.force),
                  lever > 0.0 ? still.torque / lever : 0.0);
  const double holds = slope.damping + step * slope.stiffness;
  const Vec3 at_rest = held - holds * site.drift;
  const Vec3 wanted = at_rest - holds * slip;
  const double square = (wanted + slope.viscous * slip).squaredNorm();
  const double most = slope.strength * slope.strength;
  site.strain = most > 0.0 ? square / most : square > 0.0 ? kInfinity : 0.0;
  const bool gives_way = square > most;
  const Slide slide = gives_way ? slide_under(i, slope.strength, slope.viscous, step) : Slide{};
  if (slide.speed > 0.0) {
    site.held.setZero();
    site.rub = slide.force / slide.speed;
  } else {
    site.held = {at_rest[0], at_rest[1], lever * at_rest[2]};
    site.rub = holds;
  }
}

// Friction that keeps nothing: a damper, that at the slip which it leaves. How much it slows the
// slip is known from the last solution.
void ImplicitStep::set_damper(Site& site, double normal_force, const Vec3& along, double spin,
                              double speed) const {
  const auto slope_at = [&](double at) {
    const double share = speed > 0.0 ? at / speed : 0.0;
    return site.laws.friction_slope(normal_force, share * along, share * spin);
  };
  double at = speed;
  if (site.rub > 0.0 && speed > 0.0 && speed < site.free_speed) {
    const double mobility = (site.free_speed / speed - 1.0) / site.rub;
    at = speed_left(site.free_speed, mobility, [&](double s) { return slope_at(s).damping; });
  }
  const FrictionSlope slope = slope_at(at);
  site.tangent.friction = slope;
  site.held.setZero();
  site.rub = slope.damping;
}

// How much friction can hold at a site, and how much it was solved to hold.
ImplicitStep::Load ImplicitStep::load(std::size_t i) const {
  const Site& site = this->site(i);
  if (!site.laws.has_friction()) return {};
  const double* f = &force_[i * size(kRows)];
  const Vec3 slip = slip_of(site, velocity_, i);
  const Mat3& axes = site.tangent.axes;
  const Vec3 along = slip[0] * axes.col(0) + slip[1] * axes.col(1);
  const FrictionSlope slope =
      site.laws.friction_slope(normal_force(i), along, velocity_[i * size(kRows) + 5]);
  return {slope.strength, slope.viscous, slope.strength + slope.viscous * slip.norm(),
          std::hypot(f[3], f[4], slope.lever > 0.0 ? f[5] / slope.lever : 0.0)};
}

// Shortens what friction was solved to hold to what it can hold.
void ImplicitStep::bound_friction() {
  for (std::size_t i = 0; i < island_.size(); ++i) {
    const double share = site(i).held_share;
    if (share == 1.0) continue;
    double* f = &force_[i * size(kRows)];
    for (int k = 3; k < kRows; ++k) f[k] *= share;
  }
}

// Makes dampers of what friction cannot hold, so weak that it can, and solves again. Leaves the
// share that it can hold of what it was solved to.
void ImplicitStep::damp_friction(double step) {
  constexpr int kPasses = 3;
  constexpr double kSlight = 0.99;
  for (int pass = 0; pass < kPasses; ++pass) {
    bool changed = false;
    for (std::size_t i = 0; i < island_.size(); ++i) {
      const Load load = this->load(i);
      Site& site = this->site(i);
      site.held_share = load.share();
      if (site.held_share > kSlight) continue;
      const Slide slide = slide_under(i, load.strength, load.viscous, step);
      site.held.setZero();
      site.rub = slide.speed > 0.0 ? slide.force / slide.speed : 0.0;
      changed = true;
    }
    if (!changed) return;
    solve_active(true, step);
  }
  for (std::size_t i = 0; i < island_.size(); ++i) site(i).held_share = load(i).share();
}

}  // namespace volcontact
