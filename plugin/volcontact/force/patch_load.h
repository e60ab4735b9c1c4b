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
  const bool integrated = coupling == Coupling::kQuadrature && in.patch.volume > 0.0;
  const double nearest = integrated ? kLeastReach * most : most, square = load.dot(load);
  if (!(square > nearest * nearest)) return false;  // as a rule: no root is needed to see it
  const double size = std::sqrt(square);
  const double farthest = integrated ? most * reach(coupling, (1.0 / size) * load, in) : most;
  if (!(size > farthest)) return false;
  load = (farthest / size) * load;
  return true;
}

/// What a law gives that holds by an elastic deflection `z` of a stiffness, with the generalized
/// `force` against a slip: what is not stored is dissipated. A deflection at its bound stores no
/// more, however it is pulled. `lever`: by which a spin is a slip [m].
inline FrictionOutput held_by(const Generalized& z, double stiffness, bool is_at_bound,
                              const Generalized& force, const Generalized& slip, double lever,
                              Generalized rate) {
  if (is_at_bound && z.dot(rate) > 0.0) rate = rate - z.dot(rate) / z.dot(z) * z;
  FrictionOutput out;
  out.force = -force.along;
  out.torque = -lever * force.twist;
  out.slide_energy = 0.5 * stiffness * z.along.squaredNorm();
  out.spin_energy = 0.5 * stiffness * z.twist * z.twist;
  out.slide_power = force.along.dot(slip.along) - stiffness * z.along.dot(rate.along);
  out.spin_power = force.twist * slip.twist - stiffness * z.twist * rate.twist;
  return out;
}

}  // namespace volcontact
