// SPDX-License-Identifier: Apache-2.0
#include "adaptor/evaluation/evaluate_pairs.h"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "adaptor/evaluation/sleeping.h"
#include "adaptor/evaluation/work_sharing.h"
#include "adaptor/mujoco/mjgeoms.h"
#include "volcontact/base/first_failure.h"

namespace volcontact::adaptor {
namespace {

// The octree can share the cells of one pair among threads; the other engines are too quick for
// that, and their pairs are shared instead.
bool shares_its_own_work(Engine engine) { return engine == Engine::kOctree; }

constexpr int kPairsPerTask = 16;

bool is_finite(const ContactReport& report) {
  double sum = report.elastic_energy + report.power.sum();
  for (const SiteReport& site : report.sites) {
    sum += site.force_on_A.sum() + site.torque_on_A.sum() + site.metrics.centroid.sum();
  }
  return sum - sum == 0.0;
}

// How the pairs of one evaluation are worked off, in the order of `scratch.order`: some one after
// the other, each sharing its own work; then, in one parallel region, some alone and the rest by
// the handful.
struct Work {
  int threads = 1;
  int pairs = 0;
  int own_sharing = 0;
  int single_tasks = 0;
};
Work plan_work(int threads, EvaluationScratch& scratch) {
  const auto is_long = [&](int k) {
    return shares_its_own_work(scratch.pair(static_cast<std::size_t>(k)).engine);
  };
  Work work;
  work.threads = threads;
  work.pairs = static_cast<int>(scratch.contacts.size());
  scratch.order.clear();
  for (const bool wanted : {true, false}) {
    for (int k = 0; k < work.pairs; ++k) {
      if (is_long(k) == wanted) scratch.order.push_back(k);
    }
    if (wanted) work.single_tasks = static_cast<int>(scratch.order.size());
  }
  if (work.single_tasks < threads) work.own_sharing = std::exchange(work.single_tasks, 0);
  return work;
}

void evaluate_one(const SceneContact& contact, const mjModel* m, const mjData* d,
                  const SitesBefore& before, int k, ContactModel::Workspace& workspace,
                  EvaluationScratch& scratch) {
  const std::size_t index = static_cast<std::size_t>(k);
  const PairContact& pair = scratch.pair(index);
  const auto twist_of = [&](int geom) {
    const Twist own = twist_of_geom(m, d, geom);
    const Twist driven = scratch.mocaps.at(m, d, m->geom_bodyid[geom], vec3_at(d->geom_xpos, geom));
    return Twist{own.angular + driven.angular, own.linear + driven.linear};
  };
  const BodyMotion motion{pose_of_geom(d, pair.frame_a), pose_of_geom(d, pair.frame_b),
                          twist_of(pair.frame_a), twist_of(pair.frame_b)};
  JoinedPair* joined = scratch.joined.at(index);
  SiteMemory memory;
  memory.elapsed = before.elapsed;
  if (before.committed && pair.model.row_size() > 0) {
    const SitePool<const double> pool(before.committed, contact.sites());
    memory = joined ? joined->memory(pool, before.elapsed)
                    : pool.rows_of(scratch.cull.near[index], before.elapsed);
  }
  ContactReport& report = scratch.reports[index];
  report.keeps_inputs = before.keeps_inputs;
  if (joined) {
    pair.model.evaluate({&joined->solids, 1}, motion, memory, workspace, report);
    joined->place_sites(contact, motion, report);
  } else {
    pair.model.evaluate(motion, memory, workspace, report);
  }
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

}  // namespace

void evaluate_pairs(const SceneContact& contact, const mjModel* m, const mjData* d,
                    const SitesBefore& before, EvaluationScratch& scratch) {
  contact.cull().run(d, scratch.cull);
  set_aside_sleeping(contact, m, d, scratch);
  scratch.joined.build(contact, d, scratch.cull.near);
  const std::vector<PairId>& near = scratch.cull.near;
  scratch.contacts.clear();
  for (const PairId pair : near) scratch.contacts.push_back(&contact.pair(pair));
  if (scratch.reports.size() < near.size()) {
    scratch.reports.resize(near.size());
    scratch.invalid.resize(near.size());
  }

  EvaluationGuard guard(contact.options().threads);
  const bool is_free = contact.options().threads == 0;
  ThreadChoice& choice = scratch.choices.of(&contact);
  if (is_free && !choice.shares(guard.threads(), near.size())) guard.take_one();
  using Clock = std::chrono::steady_clock;
  const bool is_timed = is_free && choice.wants_time();
  const Clock::time_point begin = is_timed ? Clock::now() : Clock::time_point();
  const Work work = plan_work(guard.threads(), scratch);
  if (scratch.workspaces.size() < static_cast<std::size_t>(work.threads)) {
    scratch.workspaces.resize(static_cast<std::size_t>(work.threads));
  }
  const auto evaluate_some = [&](int first, int last, int thread) {
    ContactModel::Workspace& workspace = scratch.workspaces[static_cast<std::size_t>(thread)];
    for (int i = first; i < last; ++i) {
      evaluate_one(contact, m, d, before, scratch.order[static_cast<std::size_t>(i)], workspace,
                   scratch);
    }
  };
  evaluate_some(0, work.own_sharing, 0);
  const int single = work.own_sharing + work.single_tasks;
  const int tasks = work.single_tasks + (work.pairs - single + kPairsPerTask - 1) / kPairsPerTask;
  const bool is_shared = work.threads > 1 && tasks > 1;
  if (!is_shared) {  // a parallel region of one thread would cost as much as a pair
    evaluate_some(work.own_sharing, work.pairs, 0);
  } else {
    FirstFailure failure;
#pragma omp parallel for schedule(dynamic, 1) num_threads(work.threads)
    for (int task = 0; task < tasks; ++task) {
      const bool is_single = task < work.single_tasks;
      const int first =
          is_single ? work.own_sharing + task : single + (task - work.single_tasks) * kPairsPerTask;
      const int last = is_single ? first + 1 : std::min(first + kPairsPerTask, work.pairs);
      failure.guard([&] { evaluate_some(first, last, omp_get_thread_num()); });
    }
    failure.rethrow();
  }
  if (is_timed) choice.took(std::chrono::duration<double>(Clock::now() - begin).count());
}

}  // namespace volcontact::adaptor
