// SPDX-License-Identifier: Apache-2.0
// What laws have by default that do not know their derivatives.
#include <algorithm>
#include <cmath>

#include "volcontact/force/friction.h"
#include "volcontact/force/normal_force.h"

namespace volcontact {
namespace {

// Relative difference of a value: the square root of rounding, where both errors are least.
constexpr double kRelative = 1e-7;
constexpr double kSpeedDifference = 1e-6;  // [m/s]
constexpr double kWayDifference = 1e-9;    // [m]
constexpr double kFastSlip = 1.0;          // from which friction is taken to slide [m/s]
constexpr double kFarTravel = 1.0;         // and over which way, where it has a memory [m]

// The part of friction that works against `along`, a unit vector in the contact plane [N].
double held(const Friction& law, const FrictionInput& in, const Vec3& along,
            const LawState& state) {
  return -law.evaluate(in, state).force.dot(along);
}

}  // namespace

NormalSlope NormalForce::slope(const NormalInput& in, const LawState& state) const noexcept {
  NormalInput more = in;
  more.volume *= 1.0 + kRelative;
  NormalInput faster = in;
  faster.approach_speed += kSpeedDifference;
  const double by_volume = evaluate(more, state).magnitude;
  const double by_speed = evaluate(faster, state).magnitude;
  const double here = evaluate(in, state).magnitude;  // last: what is kept is of `in`
  const double difference = more.volume - in.volume;
  return {difference > 0.0 ? std::max(0.0, (by_volume - here) / difference) : 0.0,
          std::max(0.0, (by_speed - here) / (faster.approach_speed - in.approach_speed))};
}

FrictionSlope Friction::slope(const FrictionInput& in, const LawState& state) const noexcept {
  const double speed = in.slip.norm();
  const Vec3 along = speed > 0.0 ? Vec3(in.slip / speed) : Vec3(basis_with_z(in.normal).col(0));
  FrictionInput fast = in;
  fast.slip = std::max(speed, kFastSlip) * along;
  if (state_size() > 0) fast.travel += kFarTravel * along;  // what it keeps has come to its limit
  FrictionInput slow = in;
  slow.slip = std::max(speed, kSpeedDifference) * along;
  FrictionInput still = in;
  still.slip.setZero();
  still.spin = 0.0;
  FrictionInput moved = still;
  moved.travel += kWayDifference * along;
  FrictionSlope slope;
  slope.strength = std::abs(held(*this, fast, along, state));
  const double at_rest = held(*this, still, along, state);
  const double rise = held(*this, slow, along, state) - at_rest;
  slope.damping = std::max(0.0, rise / slow.slip.norm());
  if (state_size() > 0) {
    const double further = held(*this, moved, along, state) - at_rest;
    slope.stiffness = std::max(0.0, further / kWayDifference);
  }
  const FrictionOutput here = evaluate(in, state);  // last: what is kept is of `in`
  slope.strength = std::max(slope.strength, here.force.norm());
  slope.lever = in.patch.gyration_radius;
  return slope;
}

}  // namespace volcontact
