// SPDX-License-Identifier: Apache-2.0
#include "volcontact/force/elastic_coulomb.h"

#include <algorithm>
#include <cmath>

#include "volcontact/force/patch_load.h"

namespace volcontact {

double ElasticCoulomb::stiffness(const FrictionInput& in) const noexcept {
  constexpr double kUnknown = 1e5;  // for a caller that tells nothing of the normal contact [N/m]
  const double normal = in.normal_stiffness > 0.0 ? in.normal_stiffness : kUnknown;
  constexpr double kRigid = 1e30;  // so that no stiffness times no deflection is a number [N/m]
  const double of_patch = std::min(p_.tangential_ratio * normal, kRigid);
  const double most = p_.friction * in.normal_force;
  return most > 0.0 && p_.presliding > 0.0 ? std::min(of_patch, most / p_.presliding) : of_patch;
}

double ElasticCoulomb::damping(const FrictionInput& in, double stiffness) const noexcept {
  constexpr double kSettling = 5e-4;   // damping over stiffness where no mass is known [s]
  constexpr double kBall = 2.0 / 7.0;  // of its mass, what a solid ball has against sliding [-]
  const double critical =
      in.mass > 0.0 ? 2.0 * std::sqrt(stiffness * kBall * in.mass) : kSettling * stiffness;
  return p_.tangential_damping * critical;
}

// After the way since the last step.
struct ElasticCoulomb::Spring {
  Generalized z;  // its deflection
  double stiffness;
  bool is_at_bound;
};

ElasticCoulomb::Spring ElasticCoulomb::spring(const FrictionInput& in, const LawState& state,
                                              double now) const noexcept {
  const double r = p_.coupling == Coupling::kNone ? 0.0 : in.patch.gyration_radius;
  const double* before = state.committed;
  const double held = before[4];
  const Generalized way{in.travel, r * in.turn};
  Generalized old{Vec3(before[0], before[1], before[2]), r > 0.0 ? before[3] : 0.0};

  // The spring of a patch that grows keeps its energy, that of one that shrinks its stiffness until
  // it slides: no patch makes energy, and none that breathes under a load creeps.
  double stiffness = std::max(now, held);
  if (held > 0.0 && held < now) old = std::sqrt(held / now) * old;
  // The way was made against the strength of before: no spring holds more than was put in.
  const double bound = std::min(p_.friction * in.normal_force, before[5]);
  Generalized z = old + way;
  bool bounded = limit(p_.coupling, bound / stiffness, in, z);
  if (bounded && now < stiffness) {
    stiffness = now;
    z = old + way;
    bounded = limit(p_.coupling, bound / stiffness, in, z);
  }
  return {z, stiffness, bounded};
}

FrictionSlope ElasticCoulomb::slope(const FrictionInput& in, const LawState& state) const noexcept {
  // Only a spring that was stiffer may have lost that by sliding.
  const double now = this->stiffness(in), held = state.committed[4];
  const double stiffness = now < held ? spring(in, state, now).stiffness : now;
  return {stiffness, damping(in, stiffness), p_.friction * in.normal_force,
          p_.coupling == Coupling::kNone ? 0.0 : in.patch.gyration_radius};
}

FrictionOutput ElasticCoulomb::evaluate(const FrictionInput& in,
                                        const LawState& state) const noexcept {
  const double r = p_.coupling == Coupling::kNone ? 0.0 : in.patch.gyration_radius;
  const double most = p_.friction * in.normal_force;
  const Generalized slip{in.slip, r * in.spin};
  const auto [z, stiffness, is_at_bound] = spring(in, state, this->stiffness(in));
  Generalized force = stiffness * z + damping(in, stiffness) * slip;
  limit(p_.coupling, most, in, force);

  for (int i = 0; i < 3; ++i) state.pending[i] = z.along[i];
  state.pending[3] = z.twist;
  state.pending[4] = stiffness;
  state.pending[5] = most;
  return held_by(z, stiffness, is_at_bound, force, slip, r, slip);
}

}  // namespace volcontact
