// SPDX-License-Identifier: Apache-2.0
#include "adaptor/evaluation/foreseen_work.h"

#include <algorithm>

#include "adaptor/evaluation/pair_energies.h"
#include "adaptor/memory/applied_ledger.h"
#include "adaptor/mujoco/mjgeoms.h"
#include "adaptor/step/mujoco_mechanism.h"

namespace volcontact::adaptor {
namespace {

// Whether nothing but contacts and gravity acts on the bodies of a pair, as far as can be told.
bool flies_alone(const mjModel* m, const PairContact& pair) {
  return m->nu == 0 && !pair.is_jointed;
}

// The pairs that are looked at: left to the explicit force, of what hangs on joints or may be
// driven, and what may give back more than it holds.
bool choose_pairs(const SceneContact& contact, const mjModel* m, EvaluationScratch& scratch) {
  scratch.foreseen.assign(scratch.energies.size(), 0);
  scratch.yields.assign(scratch.energies.size(), 0.0);
  bool some = false;
  auto stiff = scratch.stiff.begin();
  for (std::size_t k = 0; k < scratch.energies.size(); ++k) {
    const ContactReport& report = scratch.reports[k];
    const auto end = stiff + std::ssize(report.sites);
    const bool is_explicit = report.touching() && std::find(stiff, end, 1) == end;
    stiff = end;
    if (!is_explicit) continue;
    if (flies_alone(m, scratch.pair(k)) && !may_overdraw(contact, m, k, scratch)) continue;
    scratch.foreseen[k] = 1;
    some = true;
  }
  return some;
}

// What the degrees of freedom will accelerate with under the known forces and the explicit ones.
const double* foreseen_acceleration(const SceneContact& contact, const mjModel* m, mjData* d,
                                    EvaluationScratch& scratch) {
  scratch.forces.reset(m);
  auto stiff = scratch.stiff.begin();
  for (std::size_t k = 0; k < scratch.energies.size(); ++k) {
    const std::vector<SiteReport>& sites = scratch.reports[k].sites;
    for (std::size_t i = 0; i < sites.size(); ++i) {
      if (*stiff++ != 0) continue;
      const GeomPair& geoms = scratch.geoms_of_site(contact, k, i);
      const Vec3& c = sites[i].metrics.centroid;
      scratch.forces.add_between(m, d, geoms, c, sites[i].force_on_A, sites[i].torque_on_A);
    }
  }
  std::vector<double>& load = scratch.forces.generalized(m, d);
  for (std::size_t i = 0; i < load.size(); ++i) load[i] += scratch.known[i];
  scratch.row.resize(load.size());
  mj_solveM(m, d, scratch.row.data(), load.data(), 1);
  return scratch.row.data();
}

// The acceleration of a body at a point under those of the degrees of freedom.
Twist acceleration_at(const mjModel* m, const mjData* d, const MechanismTrees& trees,
                      const double* of_dofs, int body, const Vec3& point) {
  Twist out;
  if (trees.tree_of_body[size(body)] == MechanismTrees::kNone) return out;
  const Vec3 offset = point - vec3_at(d->subtree_com, m->body_rootid[body]);
  for (int dof = trees.last_dof[size(body)]; dof >= 0; dof = trees.carrier[size(dof)]) {
    const Vec3 angular = of_dofs[dof] * vec3_at(d->cdof, 2 * dof);
    out.angular += angular;
    out.linear += of_dofs[dof] * vec3_at(d->cdof, 2 * dof + 1) + angular.cross(offset);
  }
  return out;
}

// Adds the work that the explicit forces of a site will do.
void add_work(const SiteReport& site, const Twist& acceleration, double step, WorkLimit& limit) {
  const Vec3& n = site.normal;
  const double impulse = step * site.normal_force;
  const double parting = -site.approach_speed, gained = step * acceleration.linear.dot(n);
  limit.normal_work += impulse * (parting + 0.5 * gained);
  if (impulse > 0.0) limit.exit = std::max(limit.exit, parting + gained);
  const Vec3 friction = site.force_on_A - site.normal_force * n;
  const Vec3 slip = site.slip + 0.5 * step * (acceleration.linear - acceleration.linear.dot(n) * n);
  const double spin = site.spin + 0.5 * step * acceleration.angular.dot(n);
  limit.friction_work += step * (friction.dot(slip) + site.torque_on_A.dot(n) * spin);
}

// The inverse mass that would make the normal forces of a pair do that work over the step.
double yield_of(const PairEnergy::Now& now, double normal_work, double step) {
  const double impulse = step * now.force;
  return impulse > 0.0 ? 2.0 * (normal_work / impulse + now.approach()) / impulse : 0.0;
}

}  // namespace

void know_forces(const SceneContact& contact, const mjModel* m, mjData* d,
                 EvaluationScratch& scratch) {
  if (scratch.knows) return;
  scratch.knows = true;
  const UserdataBlock our = contact.block(m, d);
  const auto share = [&](Target target, int count, const double* array, std::vector<double>& out) {
    out.resize(size(count));
    for (int i = 0; i < count; ++i) {
      out[size(i)] = contact.options().target == target ? user_share(our, i, array) : array[i];
    }
  };
  share(Target::kApplied, static_cast<int>(m->nv), d->qfrc_applied, scratch.user_qfrc);
  share(Target::kXfrc, 6 * static_cast<int>(m->nbody), d->xfrc_applied, scratch.user_xfrc);
  known_forces(m, d, scratch.user_qfrc.data(), scratch.user_xfrc.data(), scratch.known);
}

bool foresee_work(const SceneContact& contact, const mjModel* m, mjData* d,
                  EvaluationScratch& scratch) {
  if (!choose_pairs(contact, m, scratch)) return false;
  know_forces(contact, m, d, scratch);
  const double* accelerations = foreseen_acceleration(contact, m, d, scratch);
  const double step = m->opt.timestep;
  bool some = false;
  auto stiff = scratch.stiff.begin();
  for (std::size_t k = 0; k < scratch.energies.size(); ++k) {
    const std::vector<SiteReport>& sites = scratch.reports[k].sites;
    const auto begin = stiff;
    stiff += std::ssize(sites);
    if (!scratch.foreseen[k]) continue;
    WorkLimit limit = limit_of(k, scratch);
    for (std::size_t i = 0; i < sites.size(); ++i) {
      const GeomPair& geoms = scratch.geoms_of_site(contact, k, i);
      const auto of = [&](int geom) {
        return acceleration_at(m, d, contact.trees(), accelerations, m->geom_bodyid[geom],
                               sites[i].metrics.centroid);
      };
      const Twist of_a = of(geoms.a), of_b = of(geoms.b);
      add_work(sites[i], {of_a.angular - of_b.angular, of_a.linear - of_b.linear}, step, limit);
      const double gained = step * (of_a.linear - of_b.linear).dot(sites[i].normal);
      lend(contact, m, geoms, sites[i], gained - sites[i].approach_speed, limit);
    }
    // Friction has no part in what a slow exit may release.
    const double own = std::max(0.0, limit.at_any_speed() - limit.normal_work);
    if (limit.is_kept() && limit.drawn_by_friction() <= own) {
      if (limit.work() > limit.at_any_speed()) {
        scratch.energies[k].slow = limit.released_at_most();
      }
      continue;
    }
    if (flies_alone(m, scratch.pair(k)) && limit.drawn_by_friction() <= own) {
      scratch.yields[k] = yield_of(scratch.now[k], limit.normal_work, step);
      continue;
    }
    std::fill(begin, stiff, 1);
    some = true;
  }
  return some;
}

}  // namespace volcontact::adaptor
