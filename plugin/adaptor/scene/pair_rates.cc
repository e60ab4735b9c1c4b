// SPDX-License-Identifier: Apache-2.0
#include "adaptor/scene/pair_rates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "adaptor/mujoco/mjgeoms.h"
#include "volcontact/step/explicit_bounds.h"

namespace volcontact::adaptor {
std::array<double, 3> sides_of(const Shape& solid) {
  const auto bounds = bounds_of(solid);
  std::array<double, 3> sides{};
  for (int i = 0; i < 3; ++i) sides[static_cast<std::size_t>(i)] = bounds.max[i] - bounds.min[i];
  std::sort(sides.begin(), sides.end());
  return sides;
}

namespace {

// As kEulerSpring and kEulerDamper.
constexpr double kRungeKuttaSpring = 8.0, kRungeKuttaDamper = 2.785;

// Whether the body of a geom moves, and not as a free body alone.
bool is_jointed(const mjModel* m, int geom) {
  const int body = m->body_weldid[m->geom_bodyid[geom]];
  if (body == 0) return false;
  const int root = m->body_rootid[body], first = m->body_dofadr[body];
  if (body != root || m->jnt_type[m->body_jntadr[body]] != mjJNT_FREE) return true;
  const int next = first + m->body_dofnum[body];  // the degrees of freedom of a tree stand together
  return next < m->nv && m->body_rootid[m->dof_bodyid[next]] == root;
}

// Force with which the pair lies still, one upon the other [N].
double resting_force(double gravity, double inverse_mass) {
  return inverse_mass > 0.0 ? gravity / inverse_mass : 0.0;
}

// Of friction at rest under a normal force, when nothing has slipped yet.
FrictionSlope slope_at_rest(const Friction& friction, double normal_force, double inverse_mass,
                            double normal_stiffness = 1.0) {
  FrictionInput at_rest;
  at_rest.normal_force = normal_force;
  at_rest.normal_stiffness = normal_stiffness;
  at_rest.mass = inverse_mass > 0.0 ? 1.0 / inverse_mass : 0.0;
  const auto size = static_cast<std::size_t>(friction.state_size());
  const std::vector<double> committed(size, 0.0);
  std::vector<double> pending(size, 0.0);
  return friction.slope(at_rest, LawState{committed.data(), pending.data(), 0.0});
}

bool follows_patch(const Friction& friction) {
  return slope_at_rest(friction, 1.0, 1.0, 1.0).stiffness !=
         slope_at_rest(friction, 1.0, 1.0, 2.0).stiffness;
}

double largest_face(const Shape& solid) {
  const auto sides = sides_of(solid);
  return sides[1] * sides[2];
}

// What slides at a patch that lies under the middle of a solid's largest face: of its mass, and of
// its inertia with the arm from there to the middle [1/kg].
double inverse_sliding_mass(const mjModel* m, int geom, const Shape& solid) {
  const mjtNum* inverse = m->body_invweight0 + 2 * m->geom_bodyid[geom];
  if (inverse[0] == 0.0) return 0.0;
  const double arm = 0.5 * sides_of(solid)[0];
  return inverse[0] + inverse[1] * arm * arm;
}

// The longest explicit step under which friction lets the pair lie still, one upon the other [s].
double longest_friction_step(bool is_rk4, const Friction& friction, double along,
                             double inverse_mass, double weight, double normal_stiffness) {
  const FrictionSlope slope = slope_at_rest(friction, weight, along, normal_stiffness);
  const double spring = slope.stiffness * inverse_mass, damper = slope.damping * inverse_mass;
  if (friction.states().empty()) return (is_rk4 ? kRungeKuttaDamper : kEulerDamper) / damper;
  if (is_rk4) return std::min(std::sqrt(kRungeKuttaSpring / spring), kRungeKuttaDamper / damper);
  return kEulerSpring / (damper + std::sqrt(damper * damper + kEulerSpring * spring));
}

}  // namespace

InverseMass inverse_mass(const mjModel* m, const GeomPair& geoms) {
  const int a = m->geom_bodyid[geoms.a], b = m->geom_bodyid[geoms.b];
  return {m->body_invweight0[2 * a] + m->body_invweight0[2 * b],
          m->body_invweight0[2 * a + 1] + m->body_invweight0[2 * b + 1]};
}

GeomFacts facts_of(const mjModel* m, int geom, const Shape& solid) {
  return {m->body_invweight0[2 * m->geom_bodyid[geom]], largest_face(solid), is_jointed(m, geom)};
}

double reduced_mass(const GeomFacts& a, const GeomFacts& b) {
  const double along = a.inverse_along + b.inverse_along;
  return along > 0.0 ? 1.0 / along : 0.0;
}

void set_rates(const GeomFacts& a, const GeomFacts& b, double gravity, PairContact& pair) {
  const double face = std::min(a.largest_face, b.largest_face);
  const double along = a.inverse_along + b.inverse_along, sliding = kBall * along;
  pair.is_jointed = a.is_jointed || b.is_jointed;
  pair.largest_rate = pair.stiffness * face * along;
  const Friction* friction = pair.model.laws().friction.get();
  if (!friction || friction->states().empty()) return;
  pair.friction_follows_patch = follows_patch(*friction);
  if (pair.friction_follows_patch) return;
  const double weight = resting_force(gravity, along);
  const FrictionSlope slope = slope_at_rest(*friction, weight > 0.0 ? weight : 1.0, along);
  pair.friction_rate = slope.stiffness * sliding;
  pair.friction_damping_rate = slope.damping * sliding;
}

ImplicitUse implicit_use(const mjModel* m, const PairContact& pair) {
  const double square = m->opt.timestep * m->opt.timestep;
  const double number = square * pair.largest_rate;
  const double per_area = square * pair.stiffness * inverse_mass(m, pair.geoms).along;
  const bool is_rk4 = m->opt.integrator == mjINT_RK4;
  const ExplicitBounds bounds = ExplicitBounds::of(is_rk4);
  return {number >= std::max(kPossibleNumber, bounds.spring),
          !bounds.friction_is_explicit && shakes_at_rest(pair, m->opt.timestep), number,
          bounds.spring / per_area, std::sqrt(kPossibleNumber / pair.largest_rate)};
}

double longest_step_at_rest(const mjModel* m, const std::vector<Shape>& solids,
                            const GeomPair& geoms, const Friction* friction, double stiffness) {
  const double along = inverse_mass(m, geoms).along;
  if (!friction || along == 0.0) return HUGE_VAL;
  const double inverse =
      inverse_sliding_mass(m, geoms.a, solids[static_cast<std::size_t>(geoms.a)]) +
      inverse_sliding_mass(m, geoms.b, solids[static_cast<std::size_t>(geoms.b)]);
  const double weight = resting_force(Vec3::from(m->opt.gravity).norm(), along);
  // Of all solids that size, a ball has the smallest patch: where that shakes, all do.
  const double radius = 0.5 * std::min(sides_of(solids[static_cast<std::size_t>(geoms.a)])[0],
                                       sides_of(solids[static_cast<std::size_t>(geoms.b)])[0]);
  const double patch = 2.0 * std::sqrt(std::numbers::pi * radius * weight / stiffness);
  return longest_friction_step(m->opt.integrator == mjINT_RK4, *friction, along, inverse, weight,
                               stiffness * patch);
}

}  // namespace volcontact::adaptor
