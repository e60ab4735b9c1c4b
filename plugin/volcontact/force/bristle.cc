// SPDX-License-Identifier: Apache-2.0
#include "volcontact/force/bristle.h"

#include <algorithm>
#include <cmath>

namespace volcontact {
namespace {

// Slip, deflection or force of a patch: along the plane, and of the spin at the radius r_g.
struct Generalized {
  Vec3 along = Vec3::Zero();
  double twist = 0.0;

  double norm() const { return std::sqrt(along.squaredNorm() + twist * twist); }
  double dot(const Generalized& other) const {
    return along.dot(other.along) + twist * other.twist;
  }
};
Generalized operator+(const Generalized& a, const Generalized& b) {
  return {a.along + b.along, a.twist + b.twist};
}
Generalized operator-(const Generalized& a, const Generalized& b) {
  return {a.along - b.along, a.twist - b.twist};
}
Generalized operator*(double factor, const Generalized& a) {
  return {factor * a.along, factor * a.twist};
}

// The direction in which a patch that slips with `u` is held, as the coupling has it: at most 1
// long, less where spinning or mixed slip finds less resistance than r_g would give it.
Generalized resisted(Coupling coupling, const Generalized& u, const FrictionInput& in) {
  const double r = in.patch.gyration_radius;
  const double spin = r > 0.0 ? u.twist / r : 0.0;
  const GeneralizedSlip slip = generalized_slip(coupling, u.along, spin, in.normal, in.patch);
  return {-slip.force_direction, r > 0.0 ? -slip.torque_arm / r : 0.0};
}

// How far the limit surface of unit strength reaches in the direction of the unit vector `load`. No
// slip does more work than its support, so each slip `u` gives a bound, here one near to the slip
// that this load would cause: never too little, too much by 0.6 % at most for a disc.
double reach(Coupling coupling, const Generalized& load, const FrictionInput& in) {
  const Generalized first = resisted(coupling, load, in);
  const Generalized u = load + (load - (1.0 / first.norm()) * first);
  return resisted(coupling, u, in).dot(u) / load.dot(u);
}

// Shortens `load` to what friction of the strength `most` can hold; whether it had to.
bool limit(Coupling coupling, double most, const FrictionInput& in, Generalized& load) {
  constexpr double kLeastReach = 0.5;  // the integrated surface is nowhere nearer than that
  const double size = load.norm();
  const bool integrated = coupling == Coupling::kQuadrature && in.patch.volume > 0.0;
  if (!(size > (integrated ? kLeastReach * most : most))) return false;
  const double farthest = integrated ? most * reach(coupling, (1.0 / size) * load, in) : most;
  if (!(size > farthest)) return false;
  load = (farthest / size) * load;
  return true;
}

// (1 - exp(-x)) / x
double mean_decay(double x) { return x > 1e-8 ? -std::expm1(-x) / x : 1.0 - 0.5 * x; }

}  // namespace

Bristle::Bristle(const Params& params) : p_(validated<Bristle>(params)) {
  require(p_.static_friction >= p_.friction,
          "bristle: static_friction = " + std::to_string(p_.static_friction) +
              " [-] is below friction = " + std::to_string(p_.friction) + " [-]");
}

FrictionSlope Bristle::slope(const FrictionInput& in, const LawState& state) const noexcept {
  evaluate(in, state);
  const double dwell = state.pending[4];
  return {p_.bristle_stiffness, p_.bristle_damping + p_.viscous_friction,
          in.normal_force * (p_.friction + (p_.static_friction - p_.friction) * dwell),
          p_.coupling == Coupling::kNone ? 0.0 : in.patch.gyration_radius};
}

FrictionOutput Bristle::evaluate(const FrictionInput& in, const LawState& state) const noexcept {
  const double r = p_.coupling == Coupling::kNone ? 0.0 : in.patch.gyration_radius;
  const double* before = state.committed;
  const Generalized slip{in.slip, r * in.spin}, way{in.travel, r * in.turn};
  const Generalized old{Vec3(before[0], before[1], before[2]), r > 0.0 ? before[3] : 0.0};

  const double ratio = slip.norm() / p_.stribeck_speed;
  const double sticking = std::exp(-ratio * ratio), sliding = -std::expm1(-ratio * ratio);
  const double relaxing = p_.bristle_stiffness / p_.bristle_damping;  // [1/s]

  const double dwell_time = sticking >= before[4] ? p_.dwell_time : 1.0 / relaxing;
  const double dwell = sticking + (before[4] - sticking) * std::exp(-state.elapsed / dwell_time);
  const double kinetic = p_.friction * in.normal_force;
  const double most = kinetic + (p_.static_friction - p_.friction) * in.normal_force * dwell;

  // The deflection follows the way while sticking and relaxes to its kinetic value while sliding:
  // exact for a slip that stays constant, so stable for any step.
  const Generalized pulled = kinetic / p_.bristle_damping * resisted(p_.coupling, slip, in);
  const double decays = sliding * relaxing * state.elapsed;
  Generalized z = std::exp(-decays) * old +
                  mean_decay(decays) * (sticking * way + sliding * state.elapsed * pulled);
  const bool bounded = limit(p_.coupling, most / p_.bristle_stiffness, in, z);

  Generalized rate = sticking * slip + sliding * (pulled - relaxing * z);
  Generalized force = p_.bristle_stiffness * z + p_.bristle_damping * rate;
  limit(p_.coupling, most, in, force);
  if (in.normal_force > 0.0) force = force + p_.viscous_friction * slip;
  // A deflection at its bound stores no more.
  if (bounded && z.dot(rate) > 0.0) rate = rate - z.dot(rate) / z.dot(z) * z;

  for (int i = 0; i < 3; ++i) state.pending[i] = z.along[i];
  state.pending[3] = z.twist;
  state.pending[4] = dwell;
  const double k = p_.bristle_stiffness;
  FrictionOutput out;
  out.force = -force.along;
  out.torque = -r * force.twist;
  out.slide_energy = 0.5 * k * z.along.squaredNorm();
  out.spin_energy = 0.5 * k * z.twist * z.twist;
  out.slide_power = force.along.dot(slip.along) - k * z.along.dot(rate.along);
  out.spin_power = force.twist * slip.twist - k * z.twist * rate.twist;
  return out;
}

}  // namespace volcontact
