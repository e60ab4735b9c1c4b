// SPDX-License-Identifier: Apache-2.0
#include "adaptor/evaluation/sleeping.h"

#include <algorithm>
#include <utility>

#include "volcontact/base/disjoint_sets.h"
#include "volcontact/base/sizes.h"
#include "volcontact/pair/interference.h"

namespace volcontact::adaptor {

#if mjVERSION_HEADER >= 4000000

namespace {

constexpr int kAwake = -(1 + mjMINAWAKE);  // a tree that has not begun to rest

bool sleeps(const mjModel* m) { return sleep_enabled(m) && can_wake(); }

struct Sides {
  int a, b;  // trees; -1 for a body that no joint moves
};
Sides trees_of(const mjModel* m, const GeomPair& geoms) {
  return {m->body_treeid[m->geom_bodyid[geoms.a]], m->body_treeid[m->geom_bodyid[geoms.b]]};
}

// Trees that sleep together name each other in a ring.
void wake(mjData* d, int tree, int value) {
  for (int next = tree; d->tree_asleep[next] >= 0;) {
    next = std::exchange(d->tree_asleep[next], value);
  }
}

bool overlap(const SceneContact& contact, const mjData* d, const PairContact& pair,
             ContactModel::Workspace& workspace) {
  const Pose X_WA = pose_of_geom(d, pair.geoms.a), X_WB = pose_of_geom(d, pair.geoms.b);
  InterferenceOptions options;
  options.engine = pair.model.options().engine;
  interference(contact.solids()[size(pair.geoms.a)], contact.solids()[size(pair.geoms.b)],
               X_WA.inverse() * X_WB, options, workspace.engines, workspace.interference);
  return workspace.interference.total.touching();
}

// Whether a body that hangs on no joint is moved by hand at the geom.
bool is_driven(const mjModel* m, const mjData* d, int geom, const EvaluationScratch& scratch) {
  const Twist motion = scratch.mocaps.at(m, d, m->geom_bodyid[geom], vec3_at(d->geom_xpos, geom));
  return !motion.angular.isZero(0.0) || !motion.linear.isZero(0.0);
}

bool is_moving(const mjModel* m, const mjData* d, int tree) {
  const int begin = m->tree_dofadr[tree], end = begin + m->tree_dofnum[tree];
  for (int dof = begin; dof < end; ++dof) {
    if (m->dof_length[dof] * std::abs(d->qvel[dof]) >= m->opt.sleep_tolerance) return true;
  }
  return false;
}

}  // namespace

bool wake_what_is_touched(const SceneContact& contact, const mjModel* m, mjData* d,
                          EvaluationScratch& scratch) {
  if (!sleeps(m) || d->ntree_awake == m->ntree) return false;
  contact.cull().run(d, scratch.cull);
  if (scratch.workspaces.empty()) scratch.workspaces.resize(1);
  const auto is_asleep = [d](int tree) { return tree >= 0 && d->tree_asleep[tree] >= 0; };
  bool woke = false;
  for (bool again = true; again;) {
    again = false;
    for (const PairId id : scratch.cull.near) {
      const PairContact& pair = contact.pair(id);
      const auto [a, b] = trees_of(m, pair.geoms);
      if (is_asleep(a) == is_asleep(b)) continue;
      const int sleeper = is_asleep(a) ? a : b, other = is_asleep(a) ? b : a;
      if (other < 0 && !is_driven(m, d, is_asleep(a) ? pair.geoms.b : pair.geoms.a, scratch))
        continue;
      if (!overlap(contact, d, pair, scratch.workspaces.front())) continue;
      wake(d, sleeper, other < 0 ? kAwake : d->tree_asleep[other]);
      woke = again = true;
    }
  }
  return woke;
}

void repeat_step_so_far(const mjModel* m, mjData* d) {
  mj_updateSleep(m, d);
  mj_fwdPosition(m, d);
  mj_fwdVelocity(m, d);
}

void set_aside_sleeping(const SceneContact& contact, const mjModel* m, const mjData* d,
                        EvaluationScratch& scratch) {
  scratch.asleep.clear();
  if (!sleeps(m) || d->ntree_awake == m->ntree) return;
  const auto rests = [&](int geom) { return d->body_awake[m->geom_bodyid[geom]] != mjS_AWAKE; };
  std::vector<PairId>& near = scratch.cull.near;
  const auto first_asleep = std::stable_partition(near.begin(), near.end(), [&](PairId id) {
    GeomPair pair;
    return contact.rules().find(id, pair) && !(rests(pair.a) && rests(pair.b));
  });
  scratch.asleep.assign(first_asleep, near.end());
  near.erase(first_asleep, near.end());
}

void hold_together(const SceneContact& contact, const mjModel* m, mjData* d,
                   EvaluationScratch& scratch) {
  if (!sleeps(m)) return;
  std::vector<int>& sets = scratch.trees;
  make_sets(sets, size(static_cast<int>(m->ntree)));
  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    for (std::size_t i = 0; i < scratch.reports[k].sites.size(); ++i) {
      const auto [a, b] = trees_of(m, scratch.geoms_of_site(contact, k, i));
      if (a >= 0 && b >= 0) join_sets(sets, a, b);
    }
  }
  // The roots are the first of their sets.
  for (int tree = 0; tree < m->ntree; ++tree) {
    const int root = root_of(sets, tree);
    int& value = d->tree_asleep[root];
    if (d->tree_asleep[tree] >= 0 || value >= 0) continue;
    value = std::min(value, d->tree_asleep[tree]);
    if (root != tree && (is_moving(m, d, tree) || is_moving(m, d, root))) value = kAwake;
  }
  for (int tree = 0; tree < m->ntree; ++tree) {
    const int value = d->tree_asleep[root_of(sets, tree)];
    if (d->tree_asleep[tree] < 0 && value < 0) d->tree_asleep[tree] = value;
  }
}

#else

bool wake_what_is_touched(const SceneContact&, const mjModel*, mjData*, EvaluationScratch&) {
  return false;
}
void repeat_step_so_far(const mjModel*, mjData*) {}
void set_aside_sleeping(const SceneContact&, const mjModel*, const mjData*,
                        EvaluationScratch& scratch) {
  scratch.asleep.clear();
}
void hold_together(const SceneContact&, const mjModel*, mjData*, EvaluationScratch&) {}

#endif

SleepingEnergy energy_asleep(const SceneContact& contact, const double* committed,
                             const EvaluationScratch& scratch) {
  SleepingEnergy sum;
  if (!committed || !contact.is_implicit()) return sum;
  const SitePool<const double> pool(committed + contact.sites().size(), contact.energies());
  for (const PairId id : scratch.asleep) {
    const SiteMemory rows = pool.rows_of(id, 0.0);
    for (int i = 0; i < rows.count; ++i) {
      const PairEnergy energy = PairEnergy::from(rows.rows + std::ptrdiff_t{i} * rows.stride);
      sum.elastic += energy.held();
      sum.owed += energy.owed();
      sum.bristle += energy.rubbed;
    }
  }
  return sum;
}

}  // namespace volcontact::adaptor
