// SPDX-License-Identifier: Apache-2.0
#include "volcontact/force/bristle.h"

#include <algorithm>
#include <cmath>

#include "volcontact/force/patch_load.h"

namespace volcontact {
namespace {

// (1 - exp(-x)) / x
double mean_decay(double x) { return x > 1e-8 ? -std::expm1(-x) / x : 1.0 - 0.5 * x; }

}  // namespace

// How much a patch sticks at a slip, and the rest.
struct Bristle::Sticking {
  double share;
  double sliding;
};

Bristle::Bristle(const Params& params) : p_(validated<Bristle>(params)) {
  require(p_.static_friction >= p_.friction,
          "bristle: static_friction = " + std::to_string(p_.static_friction) +
              " [-] is below friction = " + std::to_string(p_.friction) + " [-]");
}

// What the bristles did since the last step hangs on the way since then, not on the speed of now: a
// body at rest on a turntable has no way, and a speed that is old by a step.
struct Bristle::Past {
  Generalized way, mean;  // its mean speed
  Sticking sticking;
  double dwell;  // at its end
};

Bristle::Sticking Bristle::sticking_at(double speed) const noexcept {
  const double ratio = speed / p_.stribeck_speed;
  return {std::exp(-ratio * ratio), -std::expm1(-ratio * ratio)};
}

Bristle::Past Bristle::past(const FrictionInput& in, const LawState& state) const noexcept {
  const double r = p_.coupling == Coupling::kNone ? 0.0 : in.patch.gyration_radius;
  const Generalized way{in.travel, r * in.turn};
  const Generalized mean =
      state.elapsed > 0.0 ? 1.0 / state.elapsed * way : Generalized{in.slip, r * in.spin};
  const Sticking sticking = sticking_at(mean.norm());
  const double before = state.committed[4];
  const double dwell_time = sticking.share >= before ? p_.dwell_time : 1.0 / relaxing();
  const double dwell =
      sticking.share + (before - sticking.share) * std::exp(-state.elapsed / dwell_time);
  return {way, mean, sticking, dwell};
}

FrictionSlope Bristle::slope(const FrictionInput& in, const LawState& state) const noexcept {
  const double dwell = past(in, state).dwell;
  return {p_.bristle_stiffness, p_.bristle_damping + p_.viscous_friction,
          in.normal_force * (p_.friction + (p_.static_friction - p_.friction) * dwell),
          p_.coupling == Coupling::kNone ? 0.0 : in.patch.gyration_radius, p_.viscous_friction};
}

FrictionOutput Bristle::evaluate(const FrictionInput& in, const LawState& state) const noexcept {
  const double r = p_.coupling == Coupling::kNone ? 0.0 : in.patch.gyration_radius;
  const double* before = state.committed;
  const Generalized slip{in.slip, r * in.spin};
  const Generalized old{Vec3(before[0], before[1], before[2]), r > 0.0 ? before[3] : 0.0};
  const auto [way, mean, so_far, dwell] = past(in, state);
  const Sticking now = sticking_at(slip.norm());
  const double kinetic = p_.friction * in.normal_force;
  const double most = kinetic + (p_.static_friction - p_.friction) * in.normal_force * dwell;

  // The deflection follows the way while sticking and relaxes to its kinetic value while sliding:
  // exact for a slip that stays constant, so stable for any step.
  const auto pulled = [&](const Generalized& u) {
    return kinetic / p_.bristle_damping * resisted(p_.coupling, u, in);
  };
  const double decays = so_far.sliding * relaxing() * state.elapsed;
  Generalized z =
      std::exp(-decays) * old +
      mean_decay(decays) * (so_far.share * way + so_far.sliding * state.elapsed * pulled(mean));
  const bool bounded = limit(p_.coupling, most / p_.bristle_stiffness, in, z);

  const Generalized rate = now.share * slip + now.sliding * (pulled(slip) - relaxing() * z);
  Generalized force = p_.bristle_stiffness * z + p_.bristle_damping * rate;
  limit(p_.coupling, most, in, force);
  if (in.normal_force > 0.0) force = force + p_.viscous_friction * slip;

  for (int i = 0; i < 3; ++i) state.pending[i] = z.along[i];
  state.pending[3] = z.twist;
  state.pending[4] = dwell;
  return held_by(z, p_.bristle_stiffness, bounded, force, slip, r, rate);
}

}  // namespace volcontact
