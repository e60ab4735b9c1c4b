// SPDX-License-Identifier: Apache-2.0
#include "adaptor/evaluation/apply_contact.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "adaptor/evaluation/evaluate_pairs.h"
#include "adaptor/evaluation/foreseen_work.h"
#include "adaptor/evaluation/held_forces.h"
#include "adaptor/evaluation/pair_energies.h"
#include "adaptor/evaluation/report_sums.h"
#include "adaptor/evaluation/sleeping.h"
#include "adaptor/evaluation/stiff_sites.h"
#include "adaptor/memory/applied_ledger.h"
#include "adaptor/memory/energy_account.h"
#include "adaptor/memory/moved_clock.h"
#include "adaptor/mujoco/mjgeoms.h"
#include "adaptor/step/look_ahead.h"
#include "adaptor/step/mujoco_mechanism.h"

namespace volcontact::adaptor {
namespace {

// Zero for velocities that are no numbers: the account stays one. In four sums, of which none waits
// for another.
double power_of(const double* forces, const double* velocities, std::ptrdiff_t count) {
  double sums[4] = {};
  std::ptrdiff_t i = 0;
  for (; i + 4 <= count; i += 4) {
    for (std::ptrdiff_t k = 0; k < 4; ++k) sums[k] += forces[i + k] * velocities[i + k];
  }
  for (; i < count; ++i) sums[0] += forces[i] * velocities[i];
  const double power = (sums[0] + sums[1]) + (sums[2] + sums[3]);
  return std::isfinite(power) ? power : 0.0;
}

bool any(const std::vector<char>& flags, std::size_t count) {
  return std::any_of(flags.begin(), flags.begin() + static_cast<std::ptrdiff_t>(count),
                     [](char flag) { return flag != 0; });
}

void solve_implicit(const SceneContact& contact, const mjModel* m, mjData* d,
                    EvaluationScratch& scratch) {
  ImplicitStep& implicit = scratch.implicit;
  implicit.clear();
  std::size_t site = 0;
  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    const PairContact& pair = scratch.pair(k);
    ContactReport& report = scratch.reports[k];
    implicit.begin_pair(limit_of(k, scratch));
    for (std::size_t i = 0; i < report.sites.size(); ++i) {
      const bool is_stiff = scratch.stiff[site++] != 0;
      if (report.sites[i].normal.isZero(0.0)) continue;
      const GeomPair& geoms = scratch.geoms_of_site(contact, k, i);
      const int a = m->geom_bodyid[geoms.a], b = m->geom_bodyid[geoms.b];
      const Vec3& point = report.sites[i].metrics.centroid;
      const Twist of_a = scratch.mocaps.at(m, d, a, point),
                  of_b = scratch.mocaps.at(m, d, b, point);
      const Twist driven{of_a.angular - of_b.angular, of_a.linear - of_b.linear};
      implicit.add(pair.model, report, i, a, b, driven, is_stiff);
    }
  }
  if (implicit.empty()) return;
  know_forces(contact, m, d, scratch);
  // What is held through the stages of Runge-Kutta must be implicit in all directions: forces that
  // stay as they were at the begin of a step make its oscillations grow.
  const auto parts = m->opt.integrator == mjINT_RK4                    ? ImplicitParts::kHeld
                     : contact.options().implicit == Implicit::kAlways ? ImplicitParts::kAll
                                                                       : ImplicitParts::kStiff;
  const mjData* ahead = look_ahead(m, d);
  scratch.metric.read(m, ahead);
  scratch.metric.shift(scratch.known);
  scratch.constraints.read(m, d, ahead, scratch.metric);
  const MujocoMechanism mechanism(m, d, contact.trees(), scratch.metric);
  implicit.solve(mechanism, scratch.constraints, parts, scratch.known.data());
  for (const int pair : scratch.order) total_up(scratch.reports[static_cast<std::size_t>(pair)]);
  for (std::size_t k = 0; k < scratch.energies.size(); ++k) {
    if (!implicit.is_pair_solved(k)) continue;
    scratch.energies[k].solve(implicit.work(k), implicit.friction_work(k),
                              implicit.released_at_most(k), implicit.lent(k));
    scratch.held[k] = 1;
  }
}

// What the step that ends here released: solved pairs know when they are, others at its end.
void release(const AccountKeeper& account, EnergyAccount& now, EvaluationScratch& scratch) {
  if (!account.continues()) return;
  const EnergyAccount before = account.begin().energy();
  now.released = before.released + before.releasing;
  for (PairEnergy& energy : scratch.energies) now.released += std::exchange(energy.released, 0.0);
}

// The forces that act, in place of what the laws say at this evaluation.
void choose_forces(const SceneContact& contact, const mjModel* m, mjData* d,
                   const UserdataBlock& our, const AccountKeeper& account, EnergyAccount& now,
                   EvaluationScratch& scratch) {
  const bool is_rk4 = m->opt.integrator == mjINT_RK4;
  const double* begin = account.continues() ? account.begin().states() : nullptr;
  if (account.is_within_step()) {
    hold_solved(m, d, our, scratch);
    read_energies(contact, begin, account.since_begin(), is_rk4, scratch, now);
    release(account, now, scratch);
    know_limits(contact, m, 0.0, scratch);
    find_unpaid_pairs(contact, m, false, scratch);
    postpone_stiff(scratch);
    return;
  }
  now.implicit = find_stiff_sites(contact, m, d, scratch);
  read_energies(contact, begin, account.since_begin(), is_rk4, scratch, now);
  release(account, now, scratch);
  double dissipated = 0.0;  // by the contacts up to the evaluation before [J]
  if (begin) {
    const SleepingEnergy asleep = energy_asleep(contact, begin, scratch);
    double elastic = asleep.elastic + asleep.bristle - now.unpaid;
    for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
      elastic += scratch.reports[k].elastic_energy;
    }
    dissipated = least_dissipated(account.begin().energy(), account.since_begin(), elastic);
  }
  know_limits(contact, m, dissipated, scratch);
  const bool overdraws =
      is_rk4 ? find_unpaid_pairs(contact, m, true, scratch) : foresee_work(contact, m, d, scratch);
  now.implicit = now.implicit || overdraws;
  if (now.implicit) solve_implicit(contact, m, d, scratch);
  const bool limited = !is_rk4 && limit_explicit(contact, m, scratch);
  if (now.implicit || limited) keep_solved(contact, our, scratch);
  for (const PairEnergy& energy : scratch.energies) {
    if (energy.is_solved) now.releasing += energy.released;
  }
}

// Writes what the sites of this evaluation keep; false when there was no room for all.
bool keep_sites(const SceneContact& contact, const double* committed, double* states,
                EvaluationScratch& scratch) {
  const SitePool<double> pool(states, contact.sites());
  pool.clear();
  if (contact.sites().rows == 0) return true;
  scratch.kept.clear();
  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    const auto size = static_cast<std::size_t>(scratch.pair(k).model.row_size());
    const std::size_t numbers = scratch.reports[k].memory.size();
    for (std::size_t site = 0; site * size < numbers; ++site) {
      scratch.kept.emplace_back(scratch.pair_of_site(k, site), k, site * size);
    }
  }
  const SitePool<const double> before(committed, contact.sites());
  if (committed) scratch.keep_asleep(before);
  scratch.sort_kept();
  return std::all_of(scratch.kept.begin(), scratch.kept.end(), [&](const auto& row) {
    const auto& [pair, k, start] = row;
    if (k == EvaluationScratch::kAsleep) return pool.copy(before, pair, start);
    return pool.push(pair, &scratch.reports[k].memory[start], scratch.pair(k).model.row_size());
  });
}

void write_forces(const SceneContact& contact, const mjModel* m, mjData* d,
                  const AccountKeeper& account, const EnergyAccount& now,
                  EvaluationScratch& scratch) {
  const UserdataBlock our = contact.block(m, d);
  const bool goes_on = account.is_within_step();
  BodyForces& forces = scratch.forces;
  const bool cartesian = contact.options().target == Target::kXfrc;
  forces.reset(m);
  // Later stages of Runge-Kutta hold generalized forces: a force that stays in space loads the
  // joints of a body that turns.
  if (m->opt.integrator == mjINT_RK4 && !goes_on && our.solved() > 0) {
    add_held(contact, m, d, our, forces);
    std::vector<double>& held = forces.generalized(m, d);
    drop_non_finite(held);
    std::copy(held.begin(), held.end(), our.held());
    forces.reset(m);
  }
  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    const std::vector<SiteReport>& sites = scratch.reports[k].sites;
    for (std::size_t i = 0; i < sites.size(); ++i) {
      const SiteReport& site = sites[i];
      const GeomPair& geoms = scratch.geoms_of_site(contact, k, i);
      const int a = m->geom_bodyid[geoms.a], b = m->geom_bodyid[geoms.b];
      const Vec3& c = site.metrics.centroid;
      scratch.mocaps.add_load(m, d, a, c, site.force_on_A, site.torque_on_A);
      scratch.mocaps.add_load(m, d, b, c, -site.force_on_A, -site.torque_on_A);
      if (goes_on && scratch.held[k]) continue;
      forces.add_between(m, d, geoms, c, site.force_on_A, site.torque_on_A);
    }
  }
  if (goes_on && cartesian) add_held(contact, m, d, our, forces);
  if (cartesian) scratch.on_bodies = forces.cartesian(m, d);  // before they are summed over joints
  std::vector<double>& acting = forces.generalized(m, d);
  if (goes_on && !cartesian && our.solved() > 0) {
    std::transform(acting.begin(), acting.end(), our.held(), acting.begin(), std::plus<>());
  }
  std::vector<double>& numbers = cartesian ? scratch.on_bodies : acting;
  const bool dropped = drop_non_finite(numbers);
  if (cartesian) drop_non_finite(acting);
  if (dropped || any(scratch.invalid, scratch.cull.near.size())) our.dropped() += 1.0;
  if (account.is_last_stage() && our.solved() > 0 && m->nmocap == 0) {
    const double power = power_of(acting.data(), d->qvel, m->nv);
    const double share = last_share(m, d, account.made_by_stages(now, power), power, scratch);
    const auto times_share = [share](double number) { return share * number; };
    std::transform(acting.begin(), acting.end(), acting.begin(), times_share);
    if (cartesian) std::transform(numbers.begin(), numbers.end(), numbers.begin(), times_share);
  }
  const int count = static_cast<int>(numbers.size());
  switch (contact.options().target) {
    case Target::kApplied:
      apply_beside_user(our, count, numbers.data(), d->qfrc_applied);
      break;
    case Target::kXfrc:
      apply_beside_user(our, count, numbers.data(), d->xfrc_applied);
      break;
    case Target::kPassive:
      for (int i = 0; i < count; ++i) {
        d->qfrc_passive[i] += numbers[static_cast<std::size_t>(i)];
      }
      break;
  }
  std::copy(acting.begin(), acting.end(), our.slot(0).forces());
}

// The generalized forces of friction alone, which tell an explicit step what these took.
void write_friction(const SceneContact& contact, const mjModel* m, mjData* d,
                    EvaluationScratch& scratch) {
  BodyForces& forces = scratch.forces;
  forces.reset(m);
  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    if (!scratch.pair(k).model.laws().friction) continue;
    const std::vector<SiteReport>& sites = scratch.reports[k].sites;
    for (std::size_t i = 0; i < sites.size(); ++i) {
      const SiteReport& site = sites[i];
      const GeomPair& geoms = scratch.geoms_of_site(contact, k, i);
      const Vec3& c = site.metrics.centroid;
      const Vec3 force = site.force_on_A - site.normal_force * site.normal;
      const Vec3 torque = site.torque_on_A.dot(site.normal) * site.normal;
      forces.add_between(m, d, geoms, c, force, torque);
    }
  }
  std::vector<double>& numbers = forces.generalized(m, d);
  drop_non_finite(numbers);
  std::copy(numbers.begin(), numbers.end(), contact.block(m, d).slot(0).friction());
}

// How the mocap bodies move, into the slot of this evaluation. Returns the work that they did on
// the contacts since the last [J].
double follow_mocaps(const mjModel* m, const mjData* d, const UserdataBlock& our,
                     const AccountKeeper& account, EvaluationScratch& scratch) {
  scratch.mocaps = MocapMotion(our.slot(0).mocaps());
  if (m->nmocap == 0) return 0.0;
  if (!account.continues()) {
    scratch.mocaps.read(m, d, nullptr, 0.0, false);
    return 0.0;
  }
  const MocapMotion before(our.slot(1).mocaps());
  // They are moved between steps. The evaluation before lies within Runge-Kutta's step.
  const double elapsed = m->opt.integrator == mjINT_RK4 ? m->opt.timestep : account.elapsed();
  scratch.mocaps.read(m, d, &before, elapsed, account.is_within_step());
  return account.is_within_step() ? 0.0 : scratch.mocaps.work_since(m, before, elapsed);
}

// Fills the slot that `account` has opened, and writes the forces.
void fill_slot(const SceneContact& contact, const mjModel* m, mjData* d, const UserdataBlock& our,
               const AccountKeeper& account, EvaluationScratch& scratch) {
  const double* committed = account.continues() ? our.slot(1).states() : nullptr;
  const bool goes_on = account.is_within_step();
  const double driven = follow_mocaps(m, d, our, account, scratch);
  if (wake_what_is_touched(contact, m, d, scratch)) {
    repeat_step_so_far(m, d);  // which calls this function
    return;
  }
  evaluate_pairs(contact, m, d, {committed, account.elapsed(), contact.is_implicit()}, scratch);
  hold_together(contact, m, d, scratch);
  EnergyAccount now;
  scratch.knows = false;
  scratch.held.assign(scratch.cull.near.size(), 0);
  if (!goes_on) our.set_solved(0);
  if (contact.is_implicit()) choose_forces(contact, m, d, our, account, now, scratch);
  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    const ContactReport& report = scratch.reports[k];
    if (!now.implicit) now.stored += stored_power(report);
    now.power += report.power;
    now.taken += report.taken;
    // Bristles hold no more than sliding put in, whatever the way that they were bent.
    const double bent = report.bristle_energy.sum();
    const double paid = k < scratch.energies.size() && scratch.energies[k].bristle < bent
                            ? scratch.energies[k].bristle / bent
                            : 1.0;
    now.elastic += report.elastic_energy - (1.0 - paid) * bent;
    now.slide_energy += paid * report.bristle_energy.slide;
    now.spin_energy += paid * report.bristle_energy.spin;
  }
  now.elastic -= now.unpaid;
  const SleepingEnergy asleep = energy_asleep(contact, committed, scratch);
  now.elastic += asleep.elastic + asleep.bristle;
  now.owed += asleep.owed;
  now.slide_energy += asleep.bristle;
  double later = 0.0, friction_later = 0.0;  // power of the last forces at the present velocities
  if (account.continues()) {
    later = power_of(our.slot(1).forces(), d->qvel, m->nv);
    friction_later = power_of(our.slot(1).friction(), d->qvel, m->nv);
  }
  bool kept = keep_sites(contact, committed, our.slot(0).states(), scratch);
  if (contact.is_implicit()) {
    if (account.continues() && m->opt.integrator != mjINT_RK4) {
      const EnergyAccount before = account.begin().energy();
      const double powers = before.force_power - before.friction_power + later - friction_later;
      const double work = 0.5 * account.elapsed() * powers - driven;
      if (!before.implicit) forgive(work, before, scratch, now);
    }
    const double made = account.made(now, later, driven);
    const double paid = pay_for(m, d, made, scratch);
    now.elastic -= paid;
    now.unpaid += paid;
    now.released += release_for(made - paid, scratch);
    kept = keep_energies(contact, committed, our.slot(0).states(), scratch) && kept;
  }
  if (now.implicit || m->opt.integrator == mjINT_RK4) {
    std::fill_n(our.slot(0).friction(), m->nv, 0.0);
  } else {
    write_friction(contact, m, d, scratch);
  }
  write_forces(contact, m, d, account, now, scratch);
  if (!kept) our.forgotten() += 1.0;
  now.force_power = power_of(our.slot(0).forces(), d->qvel, m->nv);
  now.friction_power = power_of(our.slot(0).friction(), d->qvel, m->nv);
  keep_motion(m, d, our);
  account.write(now, later, friction_later, driven);
}

}  // namespace

void apply_contact(const SceneContact& contact, const mjModel* m, mjData* d,
                   EvaluationScratch& scratch) {
  if (!contact.has_room(m)) return;
  const UserdataBlock our = contact.block(m, d);
  our.claim();
  // Nobody tells a block beside mjData of a reset; to it a time that goes back is one.
  if (!contact.is_beside()) follow_clock(m, d, our, scratch.way);
  const AccountKeeper account(our, d->time, m->opt.timestep, m->opt.integrator == mjINT_RK4);
  try {
    fill_slot(contact, m, d, our, account, scratch);
  } catch (...) {
    our.drop_newest();  // half filled: the next evaluation goes on from the one before
    scratch = EvaluationScratch();
    throw;
  }
}

void release_contact(const SceneContact& contact, const mjModel* m, mjData* d) noexcept {
  if (!contact.has_room(m)) return;
  const UserdataBlock our = contact.block(m, d);
  if (contact.options().target == Target::kApplied) {
    release_to_user(our, contact.layout(m).channels, d->qfrc_applied);
  } else if (contact.options().target == Target::kXfrc) {
    release_to_user(our, contact.layout(m).channels, d->xfrc_applied);
  }
}

}  // namespace volcontact::adaptor
