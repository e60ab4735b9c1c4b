// SPDX-License-Identifier: Apache-2.0
#include "adaptor/scene/scene_contact.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "adaptor/memory/applied_ledger.h"
#include "adaptor/memory/energy_account.h"
#include "adaptor/memory/moved_clock.h"
#include "adaptor/scene/work_sharing.h"

namespace volcontact::adaptor {
namespace {

// The octree can share the cells of one pair among threads; the other engines are too quick for
// that, and their pairs are shared instead.
bool shares_its_own_work(Engine engine) { return engine == Engine::kOctree; }

// The time from which OpenMP saves more than it costs, also on a busy machine [s].
constexpr double kWorthSharing = 200e-6;
constexpr int kPairsPerTask = 16;

bool is_finite(const ContactReport& report) {
  double sum = report.elastic_energy + report.power.sum();
  for (const SiteReport& site : report.sites) {
    sum += site.force_on_A.sum() + site.torque_on_A.sum() + site.metrics.centroid.sum();
  }
  return sum - sum == 0.0;
}

// Zero for velocities that are no numbers: the account stays one.
double power_of(const double* forces, const double* velocities, std::ptrdiff_t count) {
  const double power = std::inner_product(forces, forces + count, velocities, 0.0);
  return std::isfinite(power) ? power : 0.0;
}

bool any(const std::vector<char>& flags, std::size_t count) {
  return std::any_of(flags.begin(), flags.begin() + static_cast<std::ptrdiff_t>(count),
                     [](char flag) { return flag != 0; });
}

// Whether the block has an evaluation of the present simulation. A block beside mjData is not reset
// with it, so there the time must tell.
bool has_evaluation(const UserdataBlock& block, const mjData* d, bool is_beside) {
  if (!block.is_ours() || block.count() == 0) return false;
  const double elapsed = d->time - block.slot(0).time();
  return !is_beside || (elapsed >= 0.0 && elapsed <= kLongestGap * block.slot(0).step());
}

}  // namespace

UserdataLayout SceneContact::layout(const mjModel* m) const {
  const int channels = keys_.options.target == Target::kApplied ? static_cast<int>(m->nv)
                       : keys_.options.target == Target::kXfrc  ? 6 * static_cast<int>(m->nbody)
                                                                : 0;
  const auto dofs = static_cast<int>(m->nv);
  return {sites_.size() + energies_.size(),
          channels,
          solved_rows_,
          dofs,
          static_cast<int>(m->nq) + dofs,
          static_cast<int>(m->nmocap) * MocapRow::kNumbers};
}

UserdataBlock SceneContact::block(const mjModel* m, const mjData* d) const {
  const UserdataLayout layout = this->layout(m);
  return {is_in_plugin() ? plugin_room_end(d, plugin_)
          : is_beside()  ? beside_->end_of(d, layout.size())
                         : d->userdata + m->nuserdata,
          layout};
}

SceneContact::Work SceneContact::plan_work(int threads, Scratch& scratch) const {
  const std::vector<int>& near = scratch.cull.near;
  const auto is_long = [&](int k) {
    return shares_its_own_work(
        pairs_[static_cast<std::size_t>(near[static_cast<std::size_t>(k)])].engine);
  };
  Work work;
  work.pairs = static_cast<int>(near.size());
  double time = 0.0;
  scratch.order.clear();
  for (const bool wanted : {true, false}) {
    for (int k = 0; k < work.pairs; ++k) {
      if (is_long(k) == wanted) scratch.order.push_back(k);
    }
    if (wanted) work.single_tasks = static_cast<int>(scratch.order.size());
  }
  for (const int pair : near) time += typical_time(pairs_[static_cast<std::size_t>(pair)].engine);
  if (work.single_tasks < threads) {
    time -= work.single_tasks * typical_time(Engine::kOctree);
    work.own_sharing = std::exchange(work.single_tasks, 0);
  }
  work.threads = time < kWorthSharing ? 1 : threads;
  return work;
}

void SceneContact::evaluate_one(const mjModel* m, const mjData* d, const Before& before, int k,
                                ContactModel::Workspace& workspace,
                                Scratch& scratch) const noexcept {
  const std::size_t index = static_cast<std::size_t>(k);
  const int pair_index = scratch.cull.near[index];
  const PairContact& pair = pairs_[static_cast<std::size_t>(pair_index)];
  const auto twist_of = [&](int geom) {
    const Twist own = twist_of_geom(m, d, geom);
    const Twist driven = scratch.mocaps.at(m, d, m->geom_bodyid[geom], vec3_at(d->geom_xpos, geom));
    return Twist{own.angular + driven.angular, own.linear + driven.linear};
  };
  const BodyMotion motion{pose_of_geom(d, pair.geoms.a), pose_of_geom(d, pair.geoms.b),
                          twist_of(pair.geoms.a), twist_of(pair.geoms.b)};
  SiteMemory memory;
  memory.elapsed = before.elapsed;
  if (before.committed && pair.model.row_size() > 0) {
    memory = SitePool<const double>(before.committed, sites_).rows_of(pair_index, before.elapsed);
  }
  ContactReport& report = scratch.reports[index];
  report.keeps_inputs = before.keeps_inputs;
  pair.model.evaluate(motion, memory, workspace, report);
  scratch.invalid[index] =
      workspace.interference.total.status == Status::kInvalid || !is_finite(report);
  if (!scratch.invalid[index]) return;
  report.sites.clear();
  report.memory.clear();
  report.inputs.clear();
  report.elastic_energy = 0.0;
  report.bristle_energy = {};
  report.power = {};
  report.taken = {};
}

// Writes what the sites of this evaluation keep; false when there was no room for all.
bool SceneContact::keep_sites(double* states, const Scratch& scratch) const noexcept {
  const SitePool<double> pool(states, sites_);
  pool.clear();
  if (sites_.rows == 0) return true;
  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    const int pair = scratch.cull.near[k];
    const int size = pairs_[static_cast<std::size_t>(pair)].model.row_size();
    const std::vector<double>& memory = scratch.reports[k].memory;
    for (std::size_t start = 0; start < memory.size(); start += static_cast<std::size_t>(size)) {
      if (!pool.push(pair, &memory[start], size)) return false;
    }
  }
  return true;
}

void SceneContact::evaluate(const mjModel* m, const mjData* d, const Before& before,
                            Scratch& scratch) const noexcept {
  cull_.run(d, scratch.cull);
  const std::vector<int>& near = scratch.cull.near;
  if (scratch.reports.size() < near.size()) {
    scratch.reports.resize(near.size());
    scratch.invalid.resize(near.size());
  }

  const EvaluationGuard guard(keys_.options.threads);
  const Work work = plan_work(guard.threads(), scratch);
  if (scratch.workspaces.size() < static_cast<std::size_t>(work.threads)) {
    scratch.workspaces.resize(static_cast<std::size_t>(work.threads));
  }
  const auto evaluate_some = [&](int first, int last, int thread) {
    ContactModel::Workspace& workspace = scratch.workspaces[static_cast<std::size_t>(thread)];
    for (int i = first; i < last; ++i) {
      evaluate_one(m, d, before, scratch.order[static_cast<std::size_t>(i)], workspace, scratch);
    }
  };
  evaluate_some(0, work.own_sharing, 0);
  const int single = work.own_sharing + work.single_tasks;
  const int tasks = work.single_tasks + (work.pairs - single + kPairsPerTask - 1) / kPairsPerTask;
#pragma omp parallel for schedule(dynamic, 1) num_threads(work.threads) if (work.threads > 1)
  for (int task = 0; task < tasks; ++task) {
    const int thread = work.threads > 1 ? omp_get_thread_num() : 0;
    if (task < work.single_tasks) {
      evaluate_some(work.own_sharing + task, work.own_sharing + task + 1, thread);
    } else {
      const int first = single + (task - work.single_tasks) * kPairsPerTask;
      evaluate_some(first, std::min(first + kPairsPerTask, work.pairs), thread);
    }
  }
}

void SceneContact::add_held(const mjModel* m, const mjData* d, const UserdataBlock& our,
                            BodyForces& forces) const noexcept {
  for (int i = 0; i < our.solved(); ++i) {
    const HeldSite site = our.solved_site(i);
    const GeomPair& geoms = pairs_[static_cast<std::size_t>(site.pair())].geoms;
    forces.add(m, d, m->geom_bodyid[geoms.a], site.centroid(), site.force(), site.torque());
    forces.add(m, d, m->geom_bodyid[geoms.b], site.centroid(), -site.force(), -site.torque());
  }
}

void SceneContact::write_forces(const mjModel* m, mjData* d, bool goes_on,
                                Scratch& scratch) const noexcept {
  const UserdataBlock our = block(m, d);
  BodyForces& forces = scratch.forces;
  const bool cartesian = keys_.options.target == Target::kXfrc;
  forces.reset(m);
  // Later stages of Runge-Kutta hold generalized forces: a force that stays in space loads the
  // joints of a body that turns.
  if (m->opt.integrator == mjINT_RK4 && !goes_on && our.solved() > 0) {
    add_held(m, d, our, forces);
    std::vector<double>& held = forces.generalized(m, d);
    drop_non_finite(held);
    std::copy(held.begin(), held.end(), our.held());
    forces.reset(m);
  }
  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    const GeomPair& geoms = pairs_[static_cast<std::size_t>(scratch.cull.near[k])].geoms;
    const int a = m->geom_bodyid[geoms.a], b = m->geom_bodyid[geoms.b];
    for (const SiteReport& site : scratch.reports[k].sites) {
      const Vec3& c = site.metrics.centroid;
      scratch.mocaps.add_load(m, d, a, c, site.force_on_A, site.torque_on_A);
      scratch.mocaps.add_load(m, d, b, c, -site.force_on_A, -site.torque_on_A);
      if (goes_on && scratch.held[k]) continue;
      forces.add(m, d, a, c, site.force_on_A, site.torque_on_A);
      forces.add(m, d, b, c, -site.force_on_A, -site.torque_on_A);
    }
  }
  if (goes_on && cartesian) add_held(m, d, our, forces);
  std::vector<double>& numbers = cartesian ? forces.cartesian(m, d) : forces.generalized(m, d);
  if (goes_on && !cartesian && our.solved() > 0) {
    std::transform(numbers.begin(), numbers.end(), our.held(), numbers.begin(), std::plus<>());
  }
  const bool dropped = drop_non_finite(numbers);
  if (dropped || any(scratch.invalid, scratch.cull.near.size())) our.dropped() += 1.0;
  const int count = static_cast<int>(numbers.size());
  switch (keys_.options.target) {
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
  std::vector<double>& acting = cartesian ? forces.generalized(m, d) : numbers;
  if (cartesian) drop_non_finite(acting);
  std::copy(acting.begin(), acting.end(), our.slot(0).forces());
}

// How the mocap bodies move, into the slot of this evaluation. Returns the work that they did on
// the contacts since the last [J].
double SceneContact::follow_mocaps(const mjModel* m, const mjData* d, const UserdataBlock& our,
                                   const AccountKeeper& account, Scratch& scratch) const noexcept {
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

void SceneContact::step(const mjModel* m, mjData* d, Scratch& scratch) const noexcept {
  if (!has_room(m)) return;
  const UserdataBlock our = block(m, d);
  our.claim();
  // Nobody tells a block beside mjData of a reset; to it a time that goes back is one.
  if (!is_beside()) follow_clock(m, d, our, scratch.way);
  const AccountKeeper account(our, d->time, m->opt.timestep, m->opt.integrator == mjINT_RK4);
  const double* committed = account.continues() ? our.slot(1).states() : nullptr;
  const bool goes_on = account.is_within_step();
  const double driven = follow_mocaps(m, d, our, account, scratch);
  evaluate(m, d, {committed, account.elapsed(), is_implicit()}, scratch);
  EnergyAccount now;
  scratch.held.assign(scratch.cull.near.size(), 0);
  if (!goes_on) our.set_solved(0);
  if (is_implicit()) choose_forces(m, d, our, account, now, scratch);
  bool kept = keep_sites(our.slot(0).states(), scratch);
  if (is_implicit()) kept = keep_energies(our.slot(0).states(), scratch) && kept;
  if (!kept) our.forgotten() += 1.0;

  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    const ContactReport& report = scratch.reports[k];
    now.elastic += report.elastic_energy;
    if (!now.implicit) now.stored += stored_power(report);
    now.power += report.power;
    now.taken += report.taken;
    now.slide_energy += report.bristle_energy.slide;
    now.spin_energy += report.bristle_energy.spin;
  }
  now.elastic -= now.unpaid;
  write_forces(m, d, goes_on, scratch);
  now.force_power = power_of(our.slot(0).forces(), d->qvel, m->nv);
  keep_motion(m, d, our);
  account.write(now, account.continues() ? power_of(our.slot(1).forces(), d->qvel, m->nv) : 0.0,
                driven);
}

bool SceneContact::revisit(const mjModel* m, const mjData* d, Scratch& scratch) const noexcept {
  if (!has_room(m)) return false;
  const UserdataBlock our = block(m, d);
  if (!has_evaluation(our, d, is_beside())) return false;
  Before before;
  if (our.count() > 1) {
    before = {our.slot(1).states(), our.slot(0).time() - our.slot(1).time()};
  }
  scratch.mocaps = MocapMotion(our.slot(0).mocaps());
  evaluate(m, d, before, scratch);
  recall_solved(our, scratch);
  return true;
}

EnergyAccount SceneContact::energy(const mjModel* m, const mjData* d) const noexcept {
  if (!has_room(m)) return {};
  const UserdataBlock our = block(m, d);
  return has_evaluation(our, d, is_beside()) ? our.slot(0).energy() : EnergyAccount{};
}

double SceneContact::dropped(const mjModel* m, const mjData* d) const noexcept {
  if (!has_room(m)) return 0.0;
  const UserdataBlock our = block(m, d);
  return our.is_ours() ? our.dropped() : 0.0;
}

double SceneContact::forgotten(const mjModel* m, const mjData* d) const noexcept {
  if (!has_room(m)) return 0.0;
  const UserdataBlock our = block(m, d);
  return our.is_ours() ? our.forgotten() : 0.0;
}

void SceneContact::release(const mjModel* m, mjData* d) const noexcept {
  if (!has_room(m)) return;
  const UserdataBlock our = block(m, d);
  if (keys_.options.target == Target::kApplied) {
    release_to_user(our, layout(m).channels, d->qfrc_applied);
  } else if (keys_.options.target == Target::kXfrc) {
    release_to_user(our, layout(m).channels, d->xfrc_applied);
  }
}

}  // namespace volcontact::adaptor
