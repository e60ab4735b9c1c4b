// SPDX-License-Identifier: Apache-2.0
#include "adaptor/scene_contact.h"

#include <omp.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "adaptor/applied_ledger.h"
#include "adaptor/energy_account.h"
#include "adaptor/work_sharing.h"
#include "volcontact/base/check.h"

namespace volcontact::adaptor {
namespace {

// The octree can share the cells of one pair among threads; the other engines are too quick for
// that, and their pairs are shared instead.
bool shares_its_own_work(Engine engine) { return engine == Engine::kOctree; }

// An engine may use the threads that are free: the guard of the evaluation sets how many there are.
constexpr int kInnerThreads = 0;

// Typical time of a pair [s].
double typical_time(Engine engine) {
  switch (engine) {
    case Engine::kOctree:
      return 2e-3;
    case Engine::kClosedForm:
    case Engine::kClip:
      return 1e-6;
    default:
      return 5e-6;
  }
}

// The time from which OpenMP saves more than it costs, also on a busy machine [s].
constexpr double kWorthSharing = 200e-6;
constexpr int kPairsPerTask = 16;

// Takes over and adds to `meshes`, by number; copies share their data.
std::vector<Shape> solids_of(const mjModel* m, const SceneKeys& keys,
                             const std::vector<GeomPair>& pairs, std::map<int, Shape>& meshes) {
  std::vector<Shape> solids(static_cast<std::size_t>(m->ngeom), Shape(HalfSpace()));
  std::set<int> geoms;
  for (const GeomPair& pair : pairs) geoms.insert({pair.a, pair.b});
  for (const int geom : geoms) {
    Shape& solid = solids[static_cast<std::size_t>(geom)];
    const ComposedGeoms* parts = keys.composed(geom);
    if (parts) {
      solid = composed_solid(m, *parts);
    } else if (m->geom_type[geom] == mjGEOM_MESH) {
      const int mesh = m->geom_dataid[geom];
      const auto known = meshes.find(mesh);
      solid = known != meshes.end() ? known->second : solid_of_geom(m, geom, keys.options.mesh);
      meshes.emplace(mesh, solid);
    } else {
      solid = solid_of_geom(m, geom);
    }
  }
  return solids;
}

std::vector<GeomPair> pairs_of(const mjModel* m, const SceneKeys& keys) {
  require(m->ngeom > 0, "the model has no geoms: there is nothing that could touch");
  return pairs_that_can_touch(m, keys);
}

// Rows for the contact sites: as many as a crowded scene has, not as many as there could be, since
// every copy of mjData takes them along.
int rows_for(const std::vector<GeomPair>& pairs) {
  constexpr std::size_t kPerPair = 16, kPerGeom = 6, kBase = 32;
  std::set<int> geoms;
  for (const GeomPair& pair : pairs) geoms.insert({pair.a, pair.b});
  return static_cast<int>(std::min(kPerPair * pairs.size(), kBase + kPerGeom * geoms.size()));
}

bool is_finite(const ContactReport& report) {
  double sum = report.elastic_energy + report.power.sum();
  for (const SiteReport& site : report.sites) {
    sum += site.force_on_A.sum() + site.torque_on_A.sum() + site.metrics.centroid.sum();
  }
  return sum - sum == 0.0;
}

bool any(const std::vector<char>& flags, std::size_t count) {
  return std::any_of(flags.begin(), flags.begin() + static_cast<std::ptrdiff_t>(count),
                     [](char flag) { return flag != 0; });
}

}  // namespace

SceneContact::SceneContact(const mjModel* m, const SceneContact* before)
    : keys_(read_scene_keys(m)),
      geom_pairs_(pairs_of(m, keys_)),
      meshes_(before != nullptr && before->options().mesh == options().mesh
                  ? before->meshes_
                  : std::map<int, Shape>()),
      solids_(solids_of(m, keys_, geom_pairs_, meshes_)),
      cull_(geom_pairs_, solids_) {
  warn_about_model(m);
  if (geom_pairs_.empty()) {
    warn_once("no two geoms can touch: check contype, conaffinity and volcontact/option/pairs");
  }
  for (int geom = 0; geom < m->ngeom; ++geom) {
    const Mesh* mesh = std::get_if<Mesh>(&solids_[static_cast<std::size_t>(geom)]);
    if (mesh != nullptr && mesh->topology().turned) {
      warn_once("mesh '" + label(m, mjOBJ_MESH, m->geom_dataid[geom]) +
                "': all its triangles pointed inwards; they were turned");
    }
  }
  pairs_.reserve(geom_pairs_.size());
  for (const GeomPair& pair : geom_pairs_) add_pair(m, pair);
  check_integrator(m);
  warn_about_mixed_steps(m);
  if (sites_.row_size > 0) sites_.rows = rows_for(geom_pairs_);
  if (options().implicit != Implicit::kNever) solved_rows_ = rows_for(geom_pairs_);
}

void SceneContact::warn_once(const std::string& warning) {
  if (std::find(warnings_.begin(), warnings_.end(), warning) == warnings_.end()) {
    warnings_.push_back(warning);
  }
}

void SceneContact::add_pair(const mjModel* m, const GeomPair& geoms) {
  const auto side = [&](int geom) {
    const int material = keys_.material_of_geom[static_cast<std::size_t>(geom)];
    return Side{label(m, mjOBJ_GEOM, geom), m->geom_friction[3 * geom],
                material < 0 ? nullptr : &keys_.materials[static_cast<std::size_t>(material)]};
  };
  const KeyedValues* listed =
      geoms.listed < 0 ? nullptr : &keys_.pairs[static_cast<std::size_t>(geoms.listed)].keyed;
  PairLaws laws = combine(side(geoms.a), side(geoms.b), listed);
  for (const std::string& warning : laws.warnings) warn_once(warning);
  laws.laws.formulation = keys_.options.formulation;

  const Shape& a = solids_[static_cast<std::size_t>(geoms.a)];
  const Shape& b = solids_[static_cast<std::size_t>(geoms.b)];
  const SceneOptions& options = keys_.options;
  Engine engine = options.engine == Engine::kAuto ? engine_for(a, b) : options.engine;
  const int most_cells = options.engine == Engine::kOctree ? kMostCells : kMostCellsInStep;
  if (options.formulation == Formulation::kPotential) {
    const std::string reason = why_no_pressure_field(a, b, options.engine);
    require(reason.empty(), "volcontact/option/formulation/potential does not serve geoms '" +
                                label(m, mjOBJ_GEOM, geoms.a) + "' and '" +
                                label(m, mjOBJ_GEOM, geoms.b) + "', " + name_of(a) + " with " +
                                name_of(b) + ": " + reason +
                                "; or use formulation/gonthier, or exclude them");
  }
  if (!serves(engine, a, b)) {
    warn_once(std::string("engine ") + to_string(engine) + " does not serve " + name_of(a) +
              " with " + name_of(b) + "; auto serves them");
    engine = engine_for(a, b);
  }
  ContactModel model({{a, b, Pose{}, Pose{}}}, laws.laws,
                     {options.tolerance, engine, kInnerThreads, most_cells});
  sites_.row_size = std::max(sites_.row_size, model.row_size());
  const double rate = largest_rate(m, geoms, laws);
  pairs_.push_back({geoms, engine, std::move(laws), std::move(model), rate});
}

void SceneContact::warn_about_model(const mjModel* m) {
  const std::string skipped = skipped_warning(m);
  if (!skipped.empty()) warn_once(skipped);
  if (has_flexes(m)) warn_once("flexes have no volumetric contact: they touch nothing");
  if (keys_.options.target != Target::kXfrc) {
    for (int i = 0; i < m->nsensor; ++i) {
      const int type = m->sensor_type[i];
      if (type == mjSENS_FORCE || type == mjSENS_TORQUE) {
        warn_once(
            "force and torque sensors see the contact only with "
            "volcontact/option/target/xfrc");
      }
    }
  }
  for (int i = 0; i < m->nsensor; ++i) {
    if (m->sensor_type[i] == mjSENS_TOUCH) {
      warn_once(
          "touch sensors see native contacts only, until contact.update_touch(data) or "
          "volcontact_update_touch writes them");
    }
  }
}

std::string skipped_warning(const mjModel* m) {
  const std::string flags = flags_that_skip_passive(m);
  if (flags.empty()) return {};
  return "MuJoCo does not call the passive callback with <flag " + flags +
         "/>: there will be no contact at all";
}

UserdataLayout SceneContact::layout(const mjModel* m) const {
  const int channels = keys_.options.target == Target::kApplied ? static_cast<int>(m->nv)
                       : keys_.options.target == Target::kXfrc  ? 6 * static_cast<int>(m->nbody)
                                                                : 0;
  return {sites_.size(), channels, solved_rows_};
}

UserdataBlock SceneContact::block(const mjModel* m, const mjData* d) const {
  return {d->userdata + m->nuserdata, layout(m)};
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
  const BodyMotion motion{pose_of_geom(d, pair.geoms.a), pose_of_geom(d, pair.geoms.b),
                          twist_of_geom(m, d, pair.geoms.a), twist_of_geom(m, d, pair.geoms.b)};
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

void SceneContact::write_forces(const mjModel* m, mjData* d, Scratch& scratch) const noexcept {
  BodyForces& forces = scratch.forces;
  forces.reset(m);
  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    const GeomPair& geoms = pairs_[static_cast<std::size_t>(scratch.cull.near[k])].geoms;
    for (const SiteReport& site : scratch.reports[k].sites) {
      const Vec3& c = site.metrics.centroid;
      forces.add(m, d, m->geom_bodyid[geoms.a], c, site.force_on_A, site.torque_on_A);
      forces.add(m, d, m->geom_bodyid[geoms.b], c, -site.force_on_A, -site.torque_on_A);
    }
  }
  const UserdataBlock our = block(m, d);
  const bool cartesian = keys_.options.target == Target::kXfrc;
  std::vector<double>& numbers = cartesian ? forces.cartesian(m, d) : forces.generalized(m, d);
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
}

void SceneContact::step(const mjModel* m, mjData* d, Scratch& scratch) const noexcept {
  if (m->nuserdata < layout(m).size()) return;
  const UserdataBlock our = block(m, d);
  our.claim();
  const AccountKeeper account(our, d->time, m->opt.timestep, m->opt.integrator == mjINT_RK4);
  const double* committed = account.continues() ? our.slot(1).states() : nullptr;
  const bool may_be_implicit = this->may_be_implicit(m);
  evaluate(m, d, {committed, account.elapsed(), may_be_implicit}, scratch);
  EnergyAccount now;
  now.implicit = may_be_implicit && is_stiff(m, scratch);
  our.set_solved(0);
  if (now.implicit) {
    solve_implicit(m, d, scratch);
    keep_solved(our, scratch);
  }
  if (!keep_sites(our.slot(0).states(), scratch)) our.forgotten() += 1.0;

  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    const ContactReport& report = scratch.reports[k];
    now.elastic += report.elastic_energy;
    if (!now.implicit) now.stored += stored_power(report);
    now.power += report.power;
    now.taken += report.taken;
    now.slide_energy += report.bristle_energy.slide;
    now.spin_energy += report.bristle_energy.spin;
  }
  account.write(now);
  write_forces(m, d, scratch);
}

bool SceneContact::revisit(const mjModel* m, const mjData* d, Scratch& scratch) const noexcept {
  if (m->nuserdata < layout(m).size()) return false;
  const UserdataBlock our = block(m, d);
  if (!our.is_ours() || our.count() == 0) return false;
  Before before;
  if (our.count() > 1) {
    before = {our.slot(1).states(), our.slot(0).time() - our.slot(1).time()};
  }
  evaluate(m, d, before, scratch);
  recall_solved(our, scratch);
  return true;
}

EnergyAccount SceneContact::energy(const mjModel* m, const mjData* d) const noexcept {
  if (m->nuserdata < layout(m).size()) return {};
  const UserdataBlock our = block(m, d);
  return our.is_ours() && our.count() > 0 ? our.slot(0).energy() : EnergyAccount{};
}

double SceneContact::dropped(const mjModel* m, const mjData* d) const noexcept {
  if (m->nuserdata < layout(m).size()) return 0.0;
  const UserdataBlock our = block(m, d);
  return our.is_ours() ? our.dropped() : 0.0;
}

double SceneContact::forgotten(const mjModel* m, const mjData* d) const noexcept {
  if (m->nuserdata < layout(m).size()) return 0.0;
  const UserdataBlock our = block(m, d);
  return our.is_ours() ? our.forgotten() : 0.0;
}

void SceneContact::release(const mjModel* m, mjData* d) const noexcept {
  if (m->nuserdata < layout(m).size()) return;
  const UserdataBlock our = block(m, d);
  if (keys_.options.target == Target::kApplied) {
    release_to_user(our, layout(m).channels, d->qfrc_applied);
  } else if (keys_.options.target == Target::kXfrc) {
    release_to_user(our, layout(m).channels, d->xfrc_applied);
  }
}

}  // namespace volcontact::adaptor
