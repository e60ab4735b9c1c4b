// SPDX-License-Identifier: Apache-2.0
// What SceneContact does where a step is implicit in the contact forces. What it keeps of solved
// forces: scene_held_forces.cc.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "adaptor/keys/scene_key.h"
#include "adaptor/memory/applied_ledger.h"
#include "adaptor/mujoco/mjgeoms.h"
#include "adaptor/scene/report_sums.h"
#include "adaptor/scene/scene_contact.h"
#include "volcontact/base/check.h"

namespace volcontact::adaptor {
namespace {

// Change of speed by gravity in a step [m/s].
double fall_of(const mjModel* m) {
  return m->opt.timestep * Eigen::Map<const Vec3>(m->opt.gravity).norm();
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

// Whether the body of a geom moves, and not as a free body alone.
bool is_jointed(const mjModel* m, int geom) {
  const int body = m->body_weldid[m->geom_bodyid[geom]];
  if (body == 0) return false;
  const int root = m->body_rootid[body], first = m->body_dofadr[body];
  if (body != root || m->jnt_type[m->body_jntadr[body]] != mjJNT_FREE) return true;
  const int next = first + m->body_dofnum[body];  // the degrees of freedom of a tree stand together
  return next < m->nv && m->body_rootid[m->dof_bodyid[next]] == root;
}

// How much an impulse along the normal at a point changes the speed there of one body against the
// other, at the present pose [1/kg].
double mobility_along(const mjModel* m, mjData* d, const GeomPair& geoms, const Vec3& point,
                      const Vec3& normal, std::vector<double>& row) noexcept {
  const auto nv = static_cast<std::size_t>(m->nv);
  row.assign(2 * nv, 0.0);
  for (const int geom : {geoms.a, geoms.b}) {
    const double sign = geom == geoms.a ? 1.0 : -1.0;
    int body = m->geom_bodyid[geom];
    while (body > 0 && m->body_dofnum[body] == 0) body = m->body_parentid[body];
    if (body == 0) continue;
    const Vec3 offset = point - vec3_at(d->subtree_com, m->body_rootid[body]);
    int dof = m->body_dofadr[body] + m->body_dofnum[body] - 1;
    for (; dof >= 0; dof = m->dof_parentid[dof]) {
      const Vec3 angular = vec3_at(d->cdof, 2 * dof);
      const Vec3 way = vec3_at(d->cdof, 2 * dof + 1) + angular.cross(offset);
      row[static_cast<std::size_t>(dof)] += sign * normal.dot(way);
    }
  }
  mj_solveM(m, d, row.data() + nv, row.data(), 1);
  return std::inner_product(row.begin(), row.begin() + m->nv, row.begin() + m->nv, 0.0);
}

// Force with which the pair lies still, one upon the other [N].
double resting_force(const mjModel* m, double inverse_mass) {
  const double gravity = Eigen::Map<const Vec3>(m->opt.gravity).norm();
  return inverse_mass > 0.0 ? gravity / inverse_mass : 0.0;
}

// Of friction at rest under a normal force, when nothing has slipped yet.
FrictionSlope slope_at_rest(const Friction& friction, double normal_force) {
  FrictionInput at_rest;
  at_rest.normal_force = normal_force;
  const auto size = static_cast<std::size_t>(friction.state_size());
  const std::vector<double> committed(size, 0.0);
  std::vector<double> pending(size, 0.0);
  return friction.slope(at_rest, LawState{committed.data(), pending.data(), 0.0});
}

// What explicit steps hold: h^2 k/m of an undamped spring, h c/m of a damper. Of both Euler's,
// which take the velocity first, hold h^2 k/m + 2 h c/m = 4.
constexpr double kEulerSpring = 4.0, kEulerDamper = 2.0;
constexpr double kRungeKuttaSpring = 8.0, kRungeKuttaDamper = 2.785;

// The mass at the patch is that of a solid ball: 1/m and 5/2 of it for the arm.
constexpr double kBall = 3.5;

// Whether friction without memory would throw the bodies back in an explicit step, faster than they
// slide or spin now: h c > 2 m, with c the friction per slip. Once the slip is so small they would
// chatter for ever. `most`: h c/m that a step holds.
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
  const FrictionSlope slope = slope_at_rest(friction, weight);
  const double spring = slope.stiffness * inverse_mass, damper = slope.damping * inverse_mass;
  if (friction.states().empty()) return (is_rk4 ? kRungeKuttaDamper : kEulerDamper) / damper;
  if (is_rk4) return std::min(std::sqrt(kRungeKuttaSpring / spring), kRungeKuttaDamper / damper);
  return kEulerSpring / (damper + std::sqrt(damper * damper + kEulerSpring * spring));
}

}  // namespace

void SceneContact::set_rates(const mjModel* m, PairContact& pair) const {
  const double face = std::min(largest_face(solids_[static_cast<std::size_t>(pair.geoms.a)]),
                               largest_face(solids_[static_cast<std::size_t>(pair.geoms.b)]));
  const double along = inverse_mass(m, pair.geoms).along, sliding = kBall * along;
  pair.is_jointed = is_jointed(m, pair.geoms.a) || is_jointed(m, pair.geoms.b);
  pair.largest_rate = pair.laws.stiffness * face * along;
  const Friction* friction = pair.laws.laws.friction.get();
  if (!friction || friction->states().empty()) return;
  const double weight = resting_force(m, along);
  const FrictionSlope slope = slope_at_rest(*friction, weight > 0.0 ? weight : 1.0);
  pair.bristle_rate = slope.stiffness * sliding;
  pair.bristle_damping_rate = slope.damping * sliding;
}

SceneContact::ImplicitUse SceneContact::implicit_use(const mjModel* m,
                                                     const PairContact& pair) const {
  const double square = m->opt.timestep * m->opt.timestep;
  const double number = square * pair.largest_rate;
  const double per_area = square * pair.laws.stiffness * inverse_mass(m, pair.geoms).along;
  const bool is_rk4 = m->opt.integrator == mjINT_RK4;
  const ExplicitBounds bounds = ExplicitBounds::of(is_rk4);
  return {number >= std::max(kPossibleNumber, bounds.spring),
          !bounds.friction_is_explicit && shakes_bristles(pair, m->opt.timestep), number,
          bounds.spring / per_area, std::sqrt(kPossibleNumber / pair.largest_rate)};
}

void SceneContact::warn_about_friction(const mjModel* m) {
  if (is_implicit() && !(m->opt.integrator == mjINT_RK4 && options().implicit == Implicit::kAuto)) {
    return;
  }
  for (const PairContact& pair : pairs_) {
    const int a = pair.geoms.a, b = pair.geoms.b;
    const double along = inverse_mass(m, pair.geoms).along;
    if (!pair.laws.laws.friction || along == 0.0) continue;
    const double inverse = inverse_sliding_mass(m, a, solids_[static_cast<std::size_t>(a)]) +
                           inverse_sliding_mass(m, b, solids_[static_cast<std::size_t>(b)]);
    const double longest = longest_friction_step(m, pair, inverse, resting_force(m, along));
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

// Whether an explicit step could not hold the site: by its friction, or by h^2 k/m of its patch
// against displacements and turns, with the mass that MuJoCo knows of each body at its first pose.
bool SceneContact::is_stiff(const mjModel* m, mjData* d, const PairContact& pair,
                            const ContactReport& report, std::size_t site, ExplicitBounds most,
                            Scratch& scratch) const noexcept {
  const double h = m->opt.timestep;
  const InverseMass inverse = inverse_mass(m, pair.geoms);
  const Friction* friction = pair.laws.laws.friction.get();
  if (friction && !most.friction_is_explicit) {
    if (shakes_bristles(pair, h)) return true;
    if (friction->states().empty() && reverses_slip(report.sites[site], inverse, h)) return true;
  }
  const VolumeMetrics& metrics = report.sites[site].metrics;
  const SiteInputs& inputs = report.inputs[site];
  const double spread = 0.5 * metrics.inertia.trace() / metrics.volume;
  const double mobility = inverse.along + spread * inverse.about;
  // Volume times k_v a: the damper, also where it is cut off because the bodies part.
  const double damper = h * inputs.normal_out.rolling_damping * metrics.volume;
  const double spring =
      h * h * inputs.normal_out.elastic / metrics.volume * metrics.area_vector.norm();
  if (damper * mobility > most.damper) return true;
  const bool possible = h * h * pair.largest_rate >= kPossibleNumber;
  if (possible && spring * mobility > most.spring) return true;
  // What hangs on joints may give way more easily than its masses say.
  constexpr double kMuchMore = 1e3;
  const double number = std::max(damper * mobility / most.damper, spring * mobility / most.spring);
  if (!pair.is_jointed || number * kMuchMore < 1.0) return false;
  const SiteReport& at = report.sites[site];
  const double along = mobility_along(m, d, pair.geoms, metrics.centroid, at.normal, scratch.row);
  return damper * along > most.damper || spring * along > most.spring;
}

bool SceneContact::find_stiff_sites(const mjModel* m, mjData* d, Scratch& scratch) const noexcept {
  const bool all = options().implicit == Implicit::kAlways;
  const auto most = ExplicitBounds::of(m->opt.integrator == mjINT_RK4);
  scratch.stiff.clear();
  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    const PairContact& pair = pairs_[static_cast<std::size_t>(scratch.cull.near[k])];
    const ContactReport& report = scratch.reports[k];
    for (std::size_t i = 0; i < report.sites.size(); ++i) {
      scratch.stiff.push_back(all || is_stiff(m, d, pair, report, i, most, scratch) ? 1 : 0);
    }
  }
  return std::find(scratch.stiff.begin(), scratch.stiff.end(), 1) != scratch.stiff.end();
}

void SceneContact::solve_implicit(const mjModel* m, mjData* d, Scratch& scratch) const noexcept {
  ImplicitStep& implicit = scratch.implicit;
  implicit.clear();
  const double fall = fall_of(m);
  std::size_t site = 0;
  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    const PairContact& pair = pairs_[static_cast<std::size_t>(scratch.cull.near[k])];
    ContactReport& report = scratch.reports[k];
    const double along = inverse_mass(m, pair.geoms).along;
    const PairEnergy::Now now(report);
    implicit.begin_pair(WorkLimit::of(scratch.energies[k], scratch.dissipated, options().exit_speed,
                                      now.moving(along))
                            .for_bodies(along, fall));
    for (std::size_t i = 0; i < report.sites.size(); ++i) {
      const bool is_stiff = scratch.stiff[site++] != 0;
      if (report.sites[i].normal.isZero(0.0)) continue;
      const int a = m->geom_bodyid[pair.geoms.a], b = m->geom_bodyid[pair.geoms.b];
      const Vec3& point = report.sites[i].metrics.centroid;
      const Twist of_a = scratch.mocaps.at(m, d, a, point),
                  of_b = scratch.mocaps.at(m, d, b, point);
      const Twist driven{of_a.angular - of_b.angular, of_a.linear - of_b.linear};
      implicit.add(pair.model, report, i, a, b, driven, is_stiff);
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
  // What is held through the stages of Runge-Kutta must be implicit in all directions: forces that
  // stay as they were at the begin of a step make its oscillations grow.
  const auto parts = m->opt.integrator == mjINT_RK4            ? ImplicitParts::kHeld
                     : options().implicit == Implicit::kAlways ? ImplicitParts::kAll
                                                               : ImplicitParts::kStiff;
  implicit.solve(m, d, parts, scratch.known.data());
  for (const int pair : scratch.order) total_up(scratch.reports[static_cast<std::size_t>(pair)]);
  for (std::size_t k = 0; k < scratch.energies.size(); ++k) {
    if (!implicit.is_pair_solved(k)) continue;
    scratch.energies[k].solve(implicit.work(k), implicit.friction_work(k),
                              implicit.released_at_most(k));
    scratch.held[k] = 1;
  }
}

// What the pairs hold of the energy of the bodies, after the step that ends here. Returns the
// elastic energy that nobody paid [J].
double SceneContact::read_energies(const double* committed, double elapsed, bool is_rk4,
                                   Scratch& scratch) const noexcept {
  const std::size_t count = scratch.cull.near.size();
  scratch.energies.assign(count, PairEnergy());
  double unpaid = 0.0;
  std::size_t first = 0;  // of the pair's sites
  for (std::size_t k = 0; k < count; ++k) {
    const ContactReport& report = scratch.reports[k];
    const auto stiff = scratch.stiff.begin() + static_cast<std::ptrdiff_t>(first);
    first += report.sites.size();
    if (!report.touching()) continue;
    PairEnergy& energy = scratch.energies[k];
    const PairEnergy::Now now(report);
    SiteMemory row;
    if (committed) {
      const SitePool<const double> pool(committed + sites_.size(), energies_);
      row = pool.rows_of(scratch.cull.near[k], elapsed);
    }
    if (row.count > 0) energy = PairEnergy::from(row.rows);
    if (!committed) {
      energy.found = now.elastic;
    } else if (is_rk4 && energy.explains(elapsed, now) &&
               std::find(stiff, stiff + std::ssize(report.sites), 1) ==
                   stiff + std::ssize(report.sites)) {
      energy.follow(now);
    } else {
      energy.take_in(elapsed, now, is_rk4);
    }
    unpaid += now.elastic - energy.stored - energy.found;
  }
  return unpaid;
}

// The share of the explicit forces of a pair that does no more work than the pair may.
SceneContact::ExplicitShare SceneContact::share_of(const mjModel* m, std::size_t k,
                                                   const PairEnergy::Now& now,
                                                   const Scratch& scratch) const noexcept {
  const double h = m->opt.timestep;
  const double fall = fall_of(m);
  const PairContact& pair = pairs_[static_cast<std::size_t>(scratch.cull.near[k])];
  const double along = inverse_mass(m, pair.geoms).along;
  WorkLimit limit = WorkLimit::of(scratch.energies[k], scratch.dissipated, options().exit_speed,
                                  now.moving(along));
  const double slow = std::exchange(limit.for_bodies(along, fall).slow, 0.0);
  const auto share_now = [&] {
    return explicit_share(limit, now.force, -now.approach(), along, fall, h);
  };
  const bool slowly = share_now() < 1.0;  // whether it needs what bodies that part slowly get
  limit.slow = slow;
  const double share = share_now();
  const double exit = h * share * now.force * along - now.approach();
  return {share, exit <= options().exit_speed ? slow : 0.0, slowly};
}

// Runge-Kutta's stages are exact enough, but for what no motion put in: pairs that would give it
// back count as stiff. Returns whether there are some.
bool SceneContact::find_unpaid_pairs(const mjModel* m, Scratch& scratch) const noexcept {
  constexpr double kRounding = 1e-9;
  bool some = false;
  std::size_t first = 0;  // of the pair's sites
  for (std::size_t k = 0; k < scratch.energies.size(); ++k) {
    const ContactReport& report = scratch.reports[k];
    const auto stiff = scratch.stiff.begin() + static_cast<std::ptrdiff_t>(first);
    first += report.sites.size();
    if (!report.touching()) continue;
    PairEnergy& energy = scratch.energies[k];
    const PairEnergy::Now now(report);
    const double unpaid = now.elastic - energy.stored - energy.found;
    if (energy.found == 0.0 && unpaid <= kRounding * now.elastic) continue;
    const auto [share, released_at_most, slowly] = share_of(m, k, now, scratch);
    if (share == 1.0) {
      if (!slowly) continue;
      energy.rubbed = now.bristle;
      energy.force = now.force;
      energy.power = now.power;
      energy.slow = released_at_most;
      continue;
    }
    std::fill(stiff, stiff + std::ssize(report.sites), 1);
    some = true;
  }
  return some;
}

// The same bound for pairs whose forces are explicit. Returns whether some are less than their laws
// say.
bool SceneContact::limit_explicit(const mjModel* m, Scratch& scratch) const noexcept {
  bool limited = false;
  for (std::size_t k = 0; k < scratch.energies.size(); ++k) {
    PairEnergy& energy = scratch.energies[k];
    ContactReport& report = scratch.reports[k];
    if (energy.is_solved || !report.touching()) continue;
    const PairEnergy::Now now(report);
    const auto [share, released_at_most, slowly] = share_of(m, k, now, scratch);
    energy.rubbed = now.bristle;
    energy.force = share * now.force;
    energy.power = share * now.power;
    energy.slow = released_at_most;
    if (share == 1.0) continue;
    limited = true;
    scratch.held[k] = 1;
    take_share(share, report);
  }
  return limited;
}

// What the step that ends here released: solved pairs know when they are, others at its end.
void SceneContact::release(const AccountKeeper& account, EnergyAccount& now,
                           Scratch& scratch) const noexcept {
  if (!account.continues()) return;
  const EnergyAccount before = account.begin().energy();
  now.released = before.released + before.releasing;
  for (PairEnergy& energy : scratch.energies) now.released += std::exchange(energy.released, 0.0);
}

// The forces that act, in place of what the laws say at this evaluation.
void SceneContact::choose_forces(const mjModel* m, mjData* d, const UserdataBlock& our,
                                 const AccountKeeper& account, EnergyAccount& now,
                                 Scratch& scratch) const noexcept {
  const bool is_rk4 = m->opt.integrator == mjINT_RK4;
  const double* begin = account.continues() ? account.begin().states() : nullptr;
  if (account.is_within_step()) {
    hold_solved(m, d, our, scratch);
    now.unpaid = read_energies(begin, account.since_begin(), is_rk4, scratch);
    release(account, now, scratch);
    scratch.dissipated = 0.0;
    find_unpaid_pairs(m, scratch);
    postpone_stiff(scratch);
    return;
  }
  now.implicit = find_stiff_sites(m, d, scratch);
  now.unpaid = read_energies(begin, account.since_begin(), is_rk4, scratch);
  release(account, now, scratch);
  scratch.dissipated = 0.0;
  if (begin) {
    double elastic = -now.unpaid;
    for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
      elastic += scratch.reports[k].elastic_energy;
    }
    scratch.dissipated = least_dissipated(account.begin().energy(), account.since_begin(), elastic);
  }
  if (is_rk4 && find_unpaid_pairs(m, scratch)) now.implicit = true;
  if (now.implicit) solve_implicit(m, d, scratch);
  const bool limited = !is_rk4 && limit_explicit(m, scratch);
  if (now.implicit || limited) keep_solved(our, scratch);
  for (const PairEnergy& energy : scratch.energies) {
    if (energy.is_solved) now.releasing += energy.released;
  }
}

bool SceneContact::keep_energies(double* states, const Scratch& scratch) const noexcept {
  const SitePool<double> pool(states + sites_.size(), energies_);
  pool.clear();
  for (std::size_t k = 0; k < scratch.energies.size(); ++k) {
    if (!scratch.reports[k].touching()) continue;
    double row[PairEnergy::kNumbers];
    scratch.energies[k].write(row);
    if (!pool.push(scratch.cull.near[k], row, PairEnergy::kNumbers)) return false;
  }
  return true;
}

}  // namespace volcontact::adaptor
