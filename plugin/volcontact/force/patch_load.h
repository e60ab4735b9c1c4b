// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "volcontact/force/coupling.h"
#include "volcontact/force/friction.h"

// What friction laws with a memory share: a load on a patch, and how much of it friction can hold.

namespace volcontact {

/// Slip, deflection or force of a patch: along the plane, and of the spin at the radius r_g.
struct Generalized {
  Vec3 along = Vec3::Zero();
  double twist = 0.0;

  double norm() const { return std::sqrt(along.squaredNorm() + twist * twist); }
  double dot(const Generalized& other) const {
    return along.dot(other.along) + twist * other.twist;
  }
};
inline Generalized operator+(const Generalized& a, const Generalized& b) {
  return {a.along + b.along, a.twist + b.twist};
}
inline Generalized operator-(const Generalized& a, const Generalized& b) {
  return {a.along - b.along, a.twist - b.twist};
}
inline Generalized operator*(double factor, const Generalized& a) {
  return {factor * a.along, factor * a.twist};
}

/// The direction in which a patch that slips with `u` is held, as the coupling has it: at most 1
/// long, less where spinning or mixed slip finds less resistance than r_g would give it.
inline Generalized resisted(Coupling coupling, const Generalized& u, const FrictionInput& in) {
  const double r = in.patch.gyration_radius;
  const double spin = r > 0.0 ? u.twist / r : 0.0;
  const GeneralizedSlip slip = generalized_slip(coupling, u.along, spin, in.normal, in.patch);
  return {-slip.force_direction, r > 0.0 ? -slip.torque_arm / r : 0.0};
}

/// How far the limit surface of unit strength reaches in the direction of the unit vector `load`.
/// No slip does more work than its support, so each slip `u` gives a bound, here one near to the
/// slip that this load would cause: never too little, too much by 0.6 % at most for a disc.
inline double reach(Coupling coupling, const Generalized& load, const FrictionInput& in) {
  const Generalized first = resisted(coupling, load, in);
  const Generalized u = load + (load - (1.0 / first.norm()) * first);
  return resisted(coupling, u, in).dot(u) / load.dot(u);
}

/// Shortens `load` to what friction of the strength `most` can hold; whether it had to.
inline bool limit(Coupling coupling, double most, const FrictionInput& in, Generalized& load) {
  constexpr double kLeastReach = 0.5;  // the integrated surface is nowhere nearer than that
  const double size = load.norm();
  const bool integrated = coupling == Coupling::kQuadrature && in.patch.volume > 0.0;
  if (!(size > (integrated ? kLeastReach * most : most))) return false;
  const double farthest = integrated ? most * reach(coupling, (1.0 / size) * load, in) : most;
  if (!(size > farthest)) return false;
  load = (farthest / size) * load;
  return true;
}

}  // namespace volcontact
