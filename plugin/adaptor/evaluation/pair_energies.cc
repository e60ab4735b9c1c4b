// SPDX-License-Identifier: Apache-2.0
#include "adaptor/evaluation/pair_energies.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "adaptor/evaluation/report_sums.h"
#include "adaptor/scene/pair_rates.h"
#include "adaptor/step/mujoco_mechanism.h"

namespace volcontact::adaptor {
namespace {

// What lifting bodies of that inverse mass out of the contacts of a pair takes at least [J].
double lift(const mjModel* m, const ContactReport& report, double inverse_mass) {
  const Vec3 gravity = Vec3::from(m->opt.gravity);
  double most = 0.0;
  for (const SiteReport& site : report.sites) {
    const double area = site.metrics.area_vector.norm();
    if (!(area > 0.0)) continue;
    most = std::max(most, std::abs(site.normal.dot(gravity)) * site.metrics.volume / area);
  }
  return most / inverse_mass;
}

struct ExplicitShare {
  double share, released_at_most;
  bool slowly;  // whether it needs what may be released
};

// The share of the explicit forces of a pair that does no more work than the pair may.
ExplicitShare share_of(const SceneContact& contact, const mjModel* m, std::size_t k, double yields,
                       const EvaluationScratch& scratch) {
  const double h = m->opt.timestep;
  const PairEnergy::Now& now = scratch.now[k];
  const double along = std::max(yields, inverse_mass(m, scratch.pair(k).geoms).along);
  const double gained = h * yields * now.force;
  WorkLimit limit = limit_of(k, scratch);
  for (const SiteReport& site : scratch.reports[k].sites) {
    lend(contact, m, scratch.pair(k).geoms, site, gained - site.approach_speed, limit);
  }
  const double slow = std::exchange(limit.slow, 0.0);
  const auto share_now = [&] {
    return explicit_share(limit, now.force, -now.approach(), along, h);
  };
  const bool slowly = share_now() < 1.0;  // whether it needs what bodies that part slowly get
  limit.slow = slow;
  const double share = share_now();
  const double exit = h * share * now.force * along - now.approach();
  return {share, exit <= contact.options().exit_speed ? slow : 0.0, slowly};
}

// What the stages of a Runge-Kutta step do too much if the contact of a pair ends within it [J].
double end_excess_of(const mjModel* m, const PairEnergy::Now& now, const ContactReport& report) {
  double force = 0.0, stiffness = 0.0;  // of the elastic forces
  for (std::size_t i = 0; i < report.inputs.size(); ++i) {
    const VolumeMetrics& metrics = report.sites[i].metrics;
    if (!(metrics.volume > 0.0)) continue;
    force += report.inputs[i].normal_out.elastic;
    stiffness += report.inputs[i].normal_out.elastic * metrics.area_vector.norm() / metrics.volume;
  }
  const double share = force > 0.0 ? now.force / force : 0.0;
  return end_excess(now.elastic, force, stiffness, share, -now.approach(), m->opt.timestep);
}

// Kinetic energy of all bodies [J].
double kinetic_energy(const mjModel* m, mjData* d, std::vector<double>& row) {
  row.resize(static_cast<std::size_t>(m->nv));
  mj_mulM(m, d, row.data(), d->qvel);
  return 0.5 * std::inner_product(row.begin(), row.end(), d->qvel, 0.0);
}

// What turns may put into the contact of a pair in a step beside its power, of what it holds.
double put_in_by_turns(const PairContact& pair) {
  return pair.model.laws().formulation == Formulation::kPotential ? 0.05 : 0.0;
}

}  // namespace

void know_limits(const SceneContact& contact, const mjModel* m, double dissipated,
                 EvaluationScratch& scratch) {
  const double fall = fall_of(m), exit_speed = contact.options().exit_speed;
  scratch.limits.clear();
  for (std::size_t k = 0; k < scratch.energies.size(); ++k) {
    const double along = inverse_mass(m, scratch.pair(k).geoms).along;
    const PairEnergy& energy = scratch.energies[k];
    const PairEnergy::Now& now = scratch.now[k];
    const double moving = now.moving(along) - lift(m, scratch.reports[k], along);
    WorkLimit& limit = scratch.limits.emplace_back(
        WorkLimit::of(energy, dissipated, exit_speed, moving).for_bodies(along, fall));
    limit.slow = std::min(limit.slow, std::max(0.0, now.elastic - energy.stored));
  }
}

WorkLimit limit_of(std::size_t k, const EvaluationScratch& scratch) {
  WorkLimit limit = scratch.limits[k];
  // Pairs that follow the law through the stages of Runge-Kutta have been told that since.
  limit.rubbed = scratch.energies[k].rubbed;
  return limit;
}

void lend(const SceneContact& contact, const mjModel* m, const GeomPair& geoms,
          const SiteReport& site, double parting, WorkLimit& limit) {
  const MechanismTrees& trees = contact.trees();
  double mass = 0.0;  // of what hangs on the two
  for (const int geom : {geoms.a, geoms.b}) {
    const int tree = trees.tree_of_body[size(m->geom_bodyid[geom])];
    if (tree != MechanismTrees::kNone) mass += trees.mass[size(tree)];
  }
  const double h = m->opt.timestep;
  const double fall = h * std::abs(site.normal.dot(Vec3::from(m->opt.gravity)));
  limit.lend(h * site.normal_force, mass, fall, parting);
}

bool may_overdraw(const SceneContact& contact, const mjModel* m, std::size_t k,
                  const EvaluationScratch& scratch) {
  const PairEnergy::Now& now = scratch.now[k];
  const GeomPair& geoms = scratch.pair(k).geoms;
  const double impulse = m->opt.timestep * now.force;
  const double gained = impulse * kBall * inverse_mass(m, geoms).along;
  const double work = impulse * (0.5 * gained - now.approach());
  if (!(work > 0.0)) return false;
  WorkLimit limit = limit_of(k, scratch);
  if (work <= limit.at_any_speed()) return false;
  // At rest all is lent that gravity does meanwhile.
  for (const SiteReport& site : scratch.reports[k].sites) {
    lend(contact, m, geoms, site, gained - site.approach_speed, limit);
  }
  return work > limit.at_any_speed();
}

void read_energies(const SceneContact& contact, const double* committed, double elapsed,
                   bool is_rk4, EvaluationScratch& scratch, EnergyAccount& account) {
  const std::size_t count = scratch.cull.near.size();
  scratch.energies.assign(count, PairEnergy());
  scratch.now.assign(count, PairEnergy::Now());
  scratch.put_in = 0.0;
  std::size_t first = 0;  // of the pair's sites
  for (std::size_t k = 0; k < count; ++k) {
    const ContactReport& report = scratch.reports[k];
    const auto stiff = scratch.stiff.begin() + static_cast<std::ptrdiff_t>(first);
    first += report.sites.size();
    if (!report.touching()) continue;
    PairEnergy& energy = scratch.energies[k];
    const PairEnergy::Now& now = scratch.now[k] = PairEnergy::Now(report);
    bool is_new = true;
    if (committed) {
      const SitePool<const double> pool(committed + contact.sites().size(), contact.energies());
      JoinedPair* joined = scratch.joined.at(k);
      const SiteMemory rows =
          joined ? joined->memory(pool, elapsed) : pool.rows_of(scratch.cull.near[k], elapsed);
      is_new = rows.count == 0;
      if (!is_new) energy = PairEnergy::from(rows.rows);
      for (int i = 1; i < rows.count; ++i) {
        energy += PairEnergy::from(rows.rows + std::ptrdiff_t{i} * rows.stride);
      }
    }
    if (!committed) {
      energy.found = now.elastic;
    } else if (is_rk4 && (is_new || !energy.was_solved()) &&
               energy.explains(elapsed, now, put_in_by_turns(scratch.pair(k))) &&
               std::find(stiff, stiff + std::ssize(report.sites), 1) ==
                   stiff + std::ssize(report.sites)) {
      energy.follow(elapsed, now);
    } else {
      scratch.put_in += energy.put_in(elapsed, now);
      energy.take_in(elapsed, now, is_rk4);
    }
    account.unpaid += now.elastic - energy.held();
    account.owed += energy.owed();
  }
}

bool find_unpaid_pairs(const SceneContact& contact, const mjModel* m, bool begins,
                       EvaluationScratch& scratch) {
  constexpr double kRounding = 1e-9;
  bool some = false;
  std::size_t first = 0;  // of the pair's sites
  for (std::size_t k = 0; k < scratch.energies.size(); ++k) {
    const ContactReport& report = scratch.reports[k];
    const auto stiff = scratch.stiff.begin() + static_cast<std::ptrdiff_t>(first);
    first += report.sites.size();
    if (!report.touching()) continue;
    PairEnergy& energy = scratch.energies[k];
    const PairEnergy::Now& now = scratch.now[k];
    const double unpaid = now.elastic - energy.stored - energy.found;
    const double moving = now.moving(inverse_mass(m, scratch.pair(k).geoms).along);
    const bool errs = begins && end_excess_of(m, now, report) > PairEnergy::kOverdraft * moving;
    if (!errs && energy.found == 0.0 && unpaid <= kRounding * now.elastic) {
      energy.act(now);
      continue;
    }
    const auto [share, released_at_most, slowly] = share_of(contact, m, k, 0.0, scratch);
    if (share == 1.0 && !errs) {
      energy.act(now);
      if (slowly) energy.slow = released_at_most;
      continue;
    }
    std::fill(stiff, stiff + std::ssize(report.sites), 1);
    some = true;
  }
  return some;
}

bool limit_explicit(const SceneContact& contact, const mjModel* m, EvaluationScratch& scratch) {
  bool limited = false;
  for (std::size_t k = 0; k < scratch.energies.size(); ++k) {
    PairEnergy& energy = scratch.energies[k];
    ContactReport& report = scratch.reports[k];
    if (energy.is_solved || !report.touching()) continue;
    const PairEnergy::Now& now = scratch.now[k];
    const auto [share, released_at_most, slowly] =
        share_of(contact, m, k, scratch.yields[k], scratch);
    energy.rubbed = now.bristle;
    energy.force = share * now.force;
    energy.power = share * now.power;
    if (slowly) energy.slow = released_at_most;  // else what was foreseen
    if (share == 1.0) continue;
    limited = true;
    scratch.held[k] = 1;
    take_share(share, scratch.pair(k).model, report);
    energy.rubbed = std::min(energy.rubbed, report.bristle_energy.sum());
  }
  return limited;
}

void forgive(double work, const EnergyAccount& before, EvaluationScratch& scratch,
             EnergyAccount& now) {
  double owed = 0.0;
  for (const PairEnergy& energy : scratch.energies) owed += energy.owed();
  const double false_debt = std::min({-scratch.put_in - work, now.owed - before.owed, owed});
  if (!(false_debt > 0.0)) return;
  for (PairEnergy& energy : scratch.energies) energy.forgive(false_debt / owed);
  now.owed -= false_debt;
}

double pay_for(const mjModel* m, mjData* d, double made, EvaluationScratch& scratch) {
  double held = 0.0;
  for (const PairEnergy& energy : scratch.energies) held += energy.held();
  if (!(made > PairEnergy::kOverdraft * held)) return 0.0;
  const auto payable = [&scratch] {
    double sum = 0.0;
    for (const PairEnergy& energy : scratch.energies) sum += energy.payable();
    return sum;
  };
  double there = payable();
  // Beside so much there is no doubt, whatever motion may explain.
  if (made > there && made > PairEnergy::kOverdraft * (held + kinetic_energy(m, d, scratch.row))) {
    for (PairEnergy& energy : scratch.energies) energy.doubtful = HUGE_VAL;
    there = payable();
  }
  if (!(there > 0.0)) return 0.0;
  const double share = std::min(1.0, made / there);
  for (PairEnergy& energy : scratch.energies) energy.pay(share);
  return share * there;
}

double last_share(const mjModel* m, mjData* d, double made, double power,
                  EvaluationScratch& scratch) {
  constexpr double kLeast = -4.0, kMost = 6.0;  // over the step they push, and at most twice
  double held = 0.0;
  for (const PairEnergy& energy : scratch.energies) held += energy.held();
  if (!(made > held) || power == 0.0) return 1.0;
  const double excess = made - held;
  const double there = held + kinetic_energy(m, d, scratch.row);
  if (!(excess > PairEnergy::kOverdraft * there)) return 1.0;
  const double share = 1.0 - 6.0 * excess / (m->opt.timestep * power);
  return share < kLeast || share > kMost ? 0.0 : share;  // what hardly moves anything cannot brake
}

double release_for(double made, const EvaluationScratch& scratch) {
  double most = 0.0;
  for (const PairEnergy& energy : scratch.energies) most += energy.releases;
  return std::clamp(made, 0.0, most);
}

bool keep_energies(const SceneContact& contact, const double* committed, double* states,
                   EvaluationScratch& scratch) {
  const SitePool<double> pool(states + contact.sites().size(), contact.energies());
  pool.clear();
  scratch.kept.clear();
  for (std::size_t k = 0; k < scratch.energies.size(); ++k) {
    const std::vector<SiteReport>& sites = scratch.reports[k].sites;
    if (sites.empty()) continue;
    const auto largest = std::max_element(
        sites.begin(), sites.end(),
        [](const auto& x, const auto& y) { return x.metrics.volume < y.metrics.volume; });
    const auto site = static_cast<std::size_t>(largest - sites.begin());
    scratch.kept.emplace_back(scratch.pair_of_site(k, site), k, site);
  }
  const SitePool<const double> before(committed ? committed + contact.sites().size() : nullptr,
                                      contact.energies());
  if (committed) scratch.keep_asleep(before);
  scratch.sort_kept();
  return std::all_of(scratch.kept.begin(), scratch.kept.end(), [&](const auto& kept) {
    if (std::get<1>(kept) == EvaluationScratch::kAsleep) {
      return pool.copy(before, std::get<0>(kept), std::get<2>(kept));
    }
    double row[PairEnergy::kNumbers];
    scratch.energies[std::get<1>(kept)].write(row);
    return pool.push(std::get<0>(kept), row, PairEnergy::kNumbers);
  });
}

}  // namespace volcontact::adaptor
