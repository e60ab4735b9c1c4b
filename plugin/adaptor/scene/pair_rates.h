// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "adaptor/mujoco/mujoco_compat.h"
#include "adaptor/scene/pair_contact.h"
#include "volcontact/shape/shapes.h"

// How stiff a pair can become for a step, by what is known of it before anything touches.

namespace volcontact::adaptor {

/// What explicit steps hold: h^2 k/m of an undamped spring, h c/m of a damper. Of both Euler's,
/// which take the velocity first, hold h^2 k/m + 2 h c/m = 4.
inline constexpr double kEulerSpring = 4.0, kEulerDamper = 2.0;

/// The mass at the patch is that of a solid ball: 1/m and 5/2 of it for the arm.
inline constexpr double kBall = 3.5;

/// Sides of the solid's box, the smallest first [m].
std::array<double, 3> sides_of(const Shape& solid);

/// Inverse of the mass that two bodies have against displacements, and against turns, as MuJoCo
/// knows it at the first pose [1/kg, 1/(kg m^2)].
struct InverseMass {
  double along;
  double about;
};
InverseMass inverse_mass(const mjModel* m, const GeomPair& geoms);

/// What a geom brings to the rates of its pairs.
struct GeomFacts {
  double inverse_along = 0.0;  ///< of the mass of its body [1/kg]
  double largest_face = 0.0;   ///< of the solid's box [m^2]
  bool is_jointed = false;     ///< whether its body moves, and not as a free body alone
};
GeomFacts facts_of(const mjModel* m, int geom, const Shape& solid);

/// Mass that two bodies have against displacements at the first pose, 0 where none moves [kg].
double reduced_mass(const GeomFacts& a, const GeomFacts& b);

/// Sets the rates of a pair under gravity [m/s^2].
void set_rates(const GeomFacts& a, const GeomFacts& b, double gravity, PairContact& pair);

/// Whether friction with a memory is too stiff for an explicit step of h [s]: docs/theory.md, "Time
/// step".
inline bool shakes_at_rest(const PairContact& pair, double h) {
  return h * (h * pair.friction_rate + 2.0 * pair.friction_damping_rate) > kEulerSpring;
}

/// Whether and from which patch on steps are implicit in the contact of a pair.
struct ImplicitUse {
  bool is_possible = false;     ///< for `auto`
  bool by_friction = false;     ///< this needs it in every contact
  double largest_number = 0.0;  ///< h^2 k/m of a patch as large as the smaller solid's box [-]
  double least_area = 0.0;      ///< of a patch that `auto` makes implicit [m^2]
  double explicit_step = 0.0;   ///< the longest that an explicit step should be there [s]
};
ImplicitUse implicit_use(const mjModel* m, const PairContact& pair);

/// The longest explicit step under which friction lets the pair lie still, one upon the other [s];
/// infinite where nothing moves or rubs. `stiffness` k_v [N/m^3].
double longest_step_at_rest(const mjModel* m, const std::vector<Shape>& solids,
                            const GeomPair& geoms, const Friction* friction, double stiffness);

}  // namespace volcontact::adaptor
