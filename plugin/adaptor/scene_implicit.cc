// SPDX-License-Identifier: Apache-2.0
// What SceneContact does where a step is implicit in the contact forces.
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "adaptor/applied_ledger.h"
#include "adaptor/scene_contact.h"
#include "adaptor/scene_key.h"
#include "volcontact/base/check.h"

namespace volcontact::adaptor {
namespace {

// The sums of a report whose sites have changed.
void total_up(ContactReport& report) {
  report.elastic_energy = 0.0;
  report.bristle_energy = {};
  report.power = {};
  report.taken = {};
  for (const SiteReport& site : report.sites) {
    report.elastic_energy += site.elastic_energy;
    report.bristle_energy += site.bristle_energy;
    report.power += site.power;
    report.taken += site.taken;
  }
}

// Inverse of the mass that two bodies have against displacements, and against turns, as MuJoCo
// knows it at the first pose.
struct InverseMass {
  double along;
  double about;
};
InverseMass inverse_mass(const mjModel* m, const GeomPair& geoms) {
  const int a = m->geom_bodyid[geoms.a], b = m->geom_bodyid[geoms.b];
  return {m->body_invweight0[2 * a] + m->body_invweight0[2 * b],
          m->body_invweight0[2 * a + 1] + m->body_invweight0[2 * b + 1]};
}

// Of a field of the laws; another where they have none of this name, as one of the user's own may.
double number_of(const PairLaws& laws, std::string_view name, double otherwise) {
  for (const PairField& field : laws.fields) {
    if (field.name == name) return field.value[0];
  }
  return otherwise;
}

// What explicit steps hold: h^2 k/m of an undamped spring, h c/m of a damper. Of both Euler's,
// which take the velocity first, hold h^2 k/m + 2 h c/m = 4.
constexpr double kEulerSpring = 4.0, kEulerDamper = 2.0;
constexpr double kRungeKuttaSpring = 8.0, kRungeKuttaDamper = 2.785;

// The mass at the patch is that of a solid ball: 1/m and 5/2 of it for the arm.
constexpr double kBall = 3.5;

// Whether friction without memory would throw the bodies back in an explicit step, faster than they
// slide or spin now: h c > 2 m, with c the friction per slip. Once the slip is so small they would
// chatter for ever.
bool reverses_slip(const SiteReport& site, const InverseMass& inverse, double h) {
  const double across = (site.force_on_A - site.normal_force * site.normal).norm();
  if (h * across * kBall * inverse.along > kEulerDamper * site.slip.norm()) return true;
  const double torque = std::abs(site.torque_on_A.dot(site.normal));
  return h * torque * inverse.about > kEulerDamper * std::abs(site.spin);
}

// Whether bristles are too stiff for an explicit step: docs/theory.md, "Time step".
bool shakes_bristles(const PairContact& pair, double h) {
  return h * (h * pair.bristle_rate + 2.0 * pair.bristle_damping_rate) > kEulerSpring;
}

// Sides of the solid's box, the smallest first [m].
std::array<double, 3> sides_of(const Shape& solid) {
  const auto bounds = bounds_of(solid);
  std::array<double, 3> sides{};
  for (int i = 0; i < 3; ++i) sides[static_cast<std::size_t>(i)] = bounds.max[i] - bounds.min[i];
  std::sort(sides.begin(), sides.end());
  return sides;
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
double longest_friction_step(const mjModel* m, const PairContact& pair, double inverse_mass,
                             double weight) {
  const bool is_rk4 = m->opt.integrator == mjINT_RK4;
  const Friction& friction = *pair.laws.laws.friction;
  if (friction.states().empty()) {
    FrictionInput at_rest;
    at_rest.normal_force = weight;
    const double rate = friction.slope(at_rest, LawState{}).damping * inverse_mass;
    return (is_rk4 ? kRungeKuttaDamper : kEulerDamper) / rate;
  }
  const double spring = number_of(pair.laws, "bristle_stiffness", 0.0) * inverse_mass;
  const double damper = number_of(pair.laws, "bristle_damping", 0.0) * inverse_mass;
  if (is_rk4) return std::min(std::sqrt(kRungeKuttaSpring / spring), kRungeKuttaDamper / damper);
  return kEulerSpring / (damper + std::sqrt(damper * damper + kEulerSpring * spring));
}

}  // namespace

void SceneContact::set_rates(const mjModel* m, PairContact& pair) const {
  const double face = std::min(largest_face(solids_[static_cast<std::size_t>(pair.geoms.a)]),
                               largest_face(solids_[static_cast<std::size_t>(pair.geoms.b)]));
  const double along = inverse_mass(m, pair.geoms).along, sliding = kBall * along;
  const PairLaws& laws = pair.laws;
  pair.largest_rate = number_of(laws, "stiffness", HUGE_VAL) * face * along;
  pair.bristle_rate = number_of(laws, "bristle_stiffness", 0.0) * sliding;
  pair.bristle_damping_rate =
      (number_of(laws, "bristle_damping", 0.0) + number_of(laws, "viscous_friction", 0.0)) *
      sliding;
}

SceneContact::ImplicitUse SceneContact::implicit_use(const mjModel* m,
                                                     const PairContact& pair) const {
  const double square = m->opt.timestep * m->opt.timestep;
  const double number = square * pair.largest_rate;
  const double per_area =
      square * number_of(pair.laws, "stiffness", HUGE_VAL) * inverse_mass(m, pair.geoms).along;
  return {number >= kPossibleNumber, shakes_bristles(pair, m->opt.timestep), number,
          kStiffNumber / per_area, std::sqrt(kPossibleNumber / pair.largest_rate)};
}

void SceneContact::warn_about_friction(const mjModel* m) {
  if (may_be_implicit(m)) return;
  const double gravity = Eigen::Map<const Vec3>(m->opt.gravity).norm();
  for (const PairContact& pair : pairs_) {
    const int a = pair.geoms.a, b = pair.geoms.b;
    const double along = inverse_mass(m, pair.geoms).along;
    if (!pair.laws.laws.friction || along == 0.0) continue;
    const double inverse = inverse_sliding_mass(m, a, solids_[static_cast<std::size_t>(a)]) +
                           inverse_sliding_mass(m, b, solids_[static_cast<std::size_t>(b)]);
    const double longest = longest_friction_step(m, pair, inverse, gravity / along);
    if (m->opt.timestep <= longest) continue;
    warn_once("friction of geoms '" + label(m, mjOBJ_GEOM, a) + "' and '" +
              label(m, mjOBJ_GEOM, b) +
              "' shakes them at rest: explicit steps (integrator=\"RK4\" or "
              "volcontact/option/implicit/off) hold it up to " +
              number_text(longest) +
              " s; use shorter ones, a larger slip_speed or softer bristles, or implicit contact");
    return;
  }
}

void SceneContact::check_integrator(const mjModel* m) {
  if (m->opt.integrator != mjINT_RK4 || options().implicit == Implicit::kNever) return;
  require(options().implicit != Implicit::kAlways,
          "volcontact/option/implicit/on does not go with integrator=\"RK4\", whose stages are "
          "explicit; use Euler, implicit or implicitfast, or implicit/off");
  for (const PairContact& pair : pairs_) {
    if (implicit_use(m, pair).largest_number < kRungeKuttaSpring) continue;
    warn_once("geoms '" + label(m, mjOBJ_GEOM, pair.geoms.a) + "' and '" +
              label(m, mjOBJ_GEOM, pair.geoms.b) +
              "' may touch too stiffly for integrator=\"RK4\" at this time step, which no "
              "implicit contact helps: use Euler, implicit or implicitfast");
    return;
  }
}

bool SceneContact::may_be_implicit(const mjModel* m) const noexcept {
  return options().implicit != Implicit::kNever && m->opt.integrator != mjINT_RK4;
}

// Whether an explicit step could not hold the site: by its friction, or by h^2 k/m of its patch
// against displacements and turns, with the mass that MuJoCo knows of each body at its first pose.
bool SceneContact::is_stiff(const mjModel* m, const PairContact& pair, const ContactReport& report,
                            std::size_t site) const noexcept {
  if (options().implicit == Implicit::kAlways) return true;
  const double h = m->opt.timestep;
  const InverseMass inverse = inverse_mass(m, pair.geoms);
  if (const Friction* friction = pair.laws.laws.friction.get()) {
    if (shakes_bristles(pair, h)) return true;
    if (friction->states().empty() && reverses_slip(report.sites[site], inverse, h)) return true;
  }
  if (h * h * pair.largest_rate < kPossibleNumber) return false;
  const VolumeMetrics& metrics = report.sites[site].metrics;
  const double k_v = report.inputs[site].normal_out.elastic / metrics.volume;
  const double spread = 0.5 * metrics.inertia.trace() / metrics.volume;
  const double stiffness = k_v * metrics.area_vector.norm();
  return h * h * stiffness * (inverse.along + spread * inverse.about) > kStiffNumber;
}

bool SceneContact::find_stiff_sites(const mjModel* m, Scratch& scratch) const noexcept {
  scratch.stiff.clear();
  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    const PairContact& pair = pairs_[static_cast<std::size_t>(scratch.cull.near[k])];
    const ContactReport& report = scratch.reports[k];
    for (std::size_t i = 0; i < report.sites.size(); ++i) {
      scratch.stiff.push_back(is_stiff(m, pair, report, i) ? 1 : 0);
    }
  }
  return std::find(scratch.stiff.begin(), scratch.stiff.end(), 1) != scratch.stiff.end();
}

void SceneContact::solve_implicit(const mjModel* m, mjData* d, Scratch& scratch) const noexcept {
  ImplicitStep& implicit = scratch.implicit;
  implicit.clear();
  std::size_t site = 0;
  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    const PairContact& pair = pairs_[static_cast<std::size_t>(scratch.cull.near[k])];
    ContactReport& report = scratch.reports[k];
    for (std::size_t i = 0; i < report.sites.size(); ++i) {
      const bool is_stiff = scratch.stiff[site++] != 0;
      if (report.sites[i].normal.isZero(0.0)) continue;
      implicit.add(pair.model, report, i, m->geom_bodyid[pair.geoms.a],
                   m->geom_bodyid[pair.geoms.b], is_stiff);
    }
  }
  if (implicit.empty()) return;
  const UserdataBlock our = block(m, d);
  const auto share = [&](Target target, int count, const double* array, std::vector<double>& out) {
    out.resize(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      out[static_cast<std::size_t>(i)] =
          options().target == target ? user_share(our, i, array) : array[i];
    }
  };
  share(Target::kApplied, static_cast<int>(m->nv), d->qfrc_applied, scratch.user_qfrc);
  share(Target::kXfrc, 6 * static_cast<int>(m->nbody), d->xfrc_applied, scratch.user_xfrc);
  known_forces(m, d, scratch.user_qfrc.data(), scratch.user_xfrc.data(), scratch.known);
  implicit.solve(
      m, d, options().implicit == Implicit::kAlways ? ImplicitParts::kAll : ImplicitParts::kStiff,
      scratch.known.data());
  for (const int pair : scratch.order) total_up(scratch.reports[static_cast<std::size_t>(pair)]);
}

// The forces of a solved step cannot be had from positions and velocities alone.
void SceneContact::keep_solved(const UserdataBlock& our, const Scratch& scratch) const noexcept {
  int count = 0;
  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    for (const SiteReport& site : scratch.reports[k].sites) {
      if (count == solved_rows_) break;
      double* row = our.solved_row(count++);
      row[0] = site.normal_force;
      Eigen::Map<Vec3>(row + 1) = site.force_on_A;
      Eigen::Map<Vec3>(row + 4) = site.torque_on_A;
    }
  }
  our.set_solved(count);
}

void SceneContact::recall_solved(const UserdataBlock& our, Scratch& scratch) const noexcept {
  const int count = our.solved();
  int i = 0;
  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    for (SiteReport& site : scratch.reports[k].sites) {
      if (i == count) return;
      const double* row = our.solved_row(i++);
      site.normal_force = row[0];
      site.force_on_A = Eigen::Map<const Vec3>(row + 1);
      site.torque_on_A = Eigen::Map<const Vec3>(row + 4);
    }
  }
}

}  // namespace volcontact::adaptor
