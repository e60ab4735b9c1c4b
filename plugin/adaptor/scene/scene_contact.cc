// SPDX-License-Identifier: Apache-2.0
#include "adaptor/scene/scene_contact.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "adaptor/geoms/native_pairs.h"
#include "adaptor/geoms/solids_of_geoms.h"
#include "adaptor/keys/law_tables.h"
#include "adaptor/keys/scene_key.h"
#include "adaptor/memory/applied_ledger.h"
#include "adaptor/memory/energy_account.h"
#include "adaptor/memory/mocap_row.h"
#include "adaptor/mujoco/mjgeoms.h"
#include "adaptor/scene/largest_state.h"
#include "adaptor/scene/pair_kinds.h"
#include "adaptor/scene/pair_rates.h"
#include "adaptor/step/mujoco_mechanism.h"
#include "volcontact/base/check.h"
#include "volcontact/step/work_limit.h"

namespace volcontact::adaptor {
namespace {

// An engine may use the threads that are free: the guard of the evaluation sets how many there are.
constexpr int kInnerThreads = 0;

// Takes over and adds to `meshes`, by number; copies share their data.
std::vector<Shape> solids_of(const mjModel* m, const SceneKeys& keys, const PairRules& rules,
                             std::map<int, Shape>& meshes) {
  std::vector<Shape> solids(static_cast<std::size_t>(m->ngeom), Shape(HalfSpace()));
  for (const int geom : rules.touching()) {
    Shape& solid = solids[static_cast<std::size_t>(geom)];
    const ComposedGeoms* parts = keys.composed(geom);
    if (parts) {
      solid = composed_solid(m, *parts, keys);
    } else if (m->geom_type[geom] == mjGEOM_MESH && !keys.given_shape(geom)) {
      const int mesh = m->geom_dataid[geom];
      const auto known = meshes.find(mesh);
      solid = known != meshes.end() ? known->second : solid_of_geom(m, geom, keys.options.mesh);
      meshes.emplace(mesh, solid);
    } else {
      solid = simple_solid(m, geom, keys);
    }
  }
  return solids;
}

PairRules rules_of(const mjModel* m, const SceneKeys& keys, bool listed_only) {
  require(m->ngeom > 0, "the model has no geoms: there is nothing that could touch");
  return PairRules(m, keys, listed_only);
}

// The flag with which the author of the model turned contact off; empty where it is on, or where
// the model asks for volumetric contact by keys or by our plugin. In an attached model the flag of
// contacts is ours.
std::string flag_without_contact(const mjModel* m, const SceneKeys& keys) {
  if (keys.options.disabled == Disabled::kIgnore || has_scene_keys(m)) return {};
  if (plugin_room(m).size > 0) return {};
  if (m->opt.disableflags & mjDSBL_CONSTRAINT) return "constraint=\"disable\"";
  const bool is_ours = (m->opt.disableflags & kAttachedMark) != 0;
  return (m->opt.disableflags & mjDSBL_CONTACT) && !is_ours ? "contact=\"disable\"" : "";
}

int rows_of(const PairRules& rules) { return rows_for(rules.count(), rules.touching().size()); }

// What to tell the author when the flags of the model make MuJoCo leave out the callback; empty
// when they do not.
std::string skipped_warning(const mjModel* m) {
  const std::string flags = flags_that_skip_passive(m);
  if (flags.empty()) return {};
  return "MuJoCo does not call the passive callback with <flag " + flags +
         "/>: there will be no contact at all";
}

}  // namespace

SceneContact::SceneContact(const mjModel* m, const std::vector<GivenKey>& given,
                           const SceneContact* before)
    : keys_(read_scene_keys(m, given)),
      no_contact_(before != nullptr ? before->no_contact_ : flag_without_contact(m, keys_)),
      rules_(rules_of(m, keys_, !no_contact_.empty())),
      meshes_(before != nullptr && before->options().mesh == options().mesh
                  ? before->meshes_
                  : std::map<int, Shape>()),
      solids_(solids_of(m, keys_, rules_, meshes_)),
      flush_(m, keys_, solids_, rules_),
      laws_(m, keys_),
      trees_(trees_of(m)),
      cull_(rules_, solids_) {
  warn_about_model(m);
  if (!no_contact_.empty()) {
    warn_once(
        "the model has <flag " + no_contact_ +
        "/>, so there is no contact; volcontact/option/disabled/ignore makes it volumetric all the "
        "same");
  } else if (rules_.count() == 0) {
    warn_once("no two geoms can touch: check contype, conaffinity and volcontact/option/pairs");
  }
  warn_about_meshes(m);
  check_engines(m);
  read_laws(m);
  warn_about_friction(m);
  if (sites_.row_size > 0) sites_.rows = rows_of(rules_);
  if (options().implicit != Implicit::kNever) solved_rows_ = rows_of(rules_);
  energies_ = {solved_rows_, PairEnergy::kNumbers};
}

void SceneContact::find_room(const mjModel* m, const SceneContact* before) {
  const auto present = static_cast<long long>(m->nuserdata);
  plugin_ = plugin_room(m);
  // mjSTATE_FULLPHYSICS has plugin_state, but not the forces that the user applies.
  if (is_in_plugin() && !keys_.has_target) keys_.options.target = Target::kPassive;
  // MuJoCo keeps awake what forces are applied to.
  if (sleep_enabled(m) && !keys_.has_target) keys_.options.target = Target::kPassive;
  require(
      !sleep_enabled(m) || options().target == Target::kPassive,
      "the model has <flag sleep=\"enable\"/>, and MuJoCo keeps awake what forces are applied to: "
      "nothing that lies would fall asleep; use volcontact/option/target/passive");
  const int needed = layout(m).size();
  if (is_in_plugin()) {
    require(plugin_.size >= needed, "the state of the plugin has " + std::to_string(plugin_.size) +
                                        " numbers and the scene needs " + std::to_string(needed) +
                                        ": compile it anew with this volcontact");
    return;
  }
  if (present >= needed) return;
  const bool is_passive = options().target == Target::kPassive;
  require(
      !has_scene_keys(m) && (is_passive || !keys_.has_target),
      "mjData.userdata is too small: volcontact needs " + std::to_string(needed) +
          " numbers at its end and nuserdata is " + std::to_string(present) +
          "; load the scene with volcontact.load and the same material and options, or write "
          "<size nuserdata=\"" +
          std::to_string(needed + present) + "\"/> into it" +
          (has_scene_keys(m) ? "" : "; without room there is volcontact/option/target/passive"));
  keys_.options.target = Target::kPassive;
  beside_ = before && before->beside_ ? before->beside_ : std::make_shared<SideStates>();
  if (sites_.row_size == 0) return;
  const std::string told =
      "the model has no room in userdata, so what laws with a memory keep, as sticking friction "
      "and restitution do, lies beside mjData: it is not copied, reset or restored with it; load "
      "the scene with volcontact.load";
  if (keeps_by_choice_) {
    alert(told);
  } else {
    warn_once(told);
  }
}

// Whether a law with a memory was asked for. The default friction has one too: a micrometre of way,
// and less than a line for everybody who attaches to a model.
bool SceneContact::keeps_by_choice(const ContactLaws& laws) {
  if (!laws.normal->states().empty()) return true;
  return laws.friction && !laws.friction->states().empty() &&
         friction_laws().front().name != laws.friction->name();
}

void SceneContact::warn_about_meshes(const mjModel* m) {
  std::set<std::string> hulls;
  for (int geom = 0; geom < m->ngeom; ++geom) {
    const Shape& solid = solids_[static_cast<std::size_t>(geom)];
    const Mesh* mesh = std::get_if<Mesh>(&solid);
    if (mesh != nullptr && mesh->topology().turned) {
      warn_once("mesh '" + label(m, mjOBJ_MESH, m->geom_dataid[geom]) +
                "': all its triangles pointed inwards; they were turned");
    }
    if (options().mesh == MeshForm::kExactOrHull && std::holds_alternative<ConvexPolytope>(solid)) {
      hulls.insert(label(m, mjOBJ_MESH, m->geom_dataid[geom]));
    }
  }
  if (hulls.empty()) return;
  alert("the convex hull stands for meshes that bound no solid: " +
        joined({hulls.begin(), hulls.end()}));
}

void SceneContact::warn_once(const std::string& warning) {
  if (std::find(warnings_.begin(), warnings_.end(), warning) == warnings_.end()) {
    warnings_.push_back(warning);
  }
}

void SceneContact::alert(const std::string& warning) {
  warn_once(warning);
  alerts_.push_back(warning);
}

void SceneContact::read_laws(const mjModel* m) {
  gravity_ = Vec3::from(m->opt.gravity).norm();
  facts_.resize(static_cast<std::size_t>(m->ngeom));
  for (const int geom : rules_.touching()) {
    const auto i = static_cast<std::size_t>(geom);
    facts_[i] = facts_of(m, geom, solids_[i]);
  }
  laws_.read_all(m, rules_, [&](const GeomPair& geoms, const PairLaws& laws) {
    for (const std::string& warning : laws.warnings) warn_once(warning);
    keeps_by_choice_ = keeps_by_choice_ || keeps_by_choice(laws.laws);
    const PairContact& first = pair(rules_.id(geoms.a, geoms.b));
    sites_.row_size = std::max(sites_.row_size, first.model.row_size());
  });
  for (const GeomPair& geoms : rules_.named()) {
    if (geoms.native >= 0) warn_about_native_pair(m, geoms.native);
  }
}

void SceneContact::warn_about_native_pair(const mjModel* m, int native) {
  const std::vector<std::string> unused = native_pair_fields_unused(m, native);
  if (unused.empty()) return;
  warn_once(native_pair_label(m, native) + ": " + joined(unused) +
            (unused.size() == 1 ? " has" : " have") +
            " no meaning under volumetric contact; of a <pair> its sliding friction counts");
}

// Where the program asks for what not every pair has, each is asked.
void SceneContact::check_engines(const mjModel* m) {
  const SceneOptions& options = keys_.options;
  if (options.engine == Engine::kAuto && options.formulation != Formulation::kPotential) return;
  rules_.for_each([&](const GeomPair& geoms) {
    check_engine(m, geoms);
    return true;
  });
}

void SceneContact::check_engine(const mjModel* m, const GeomPair& geoms) {
  const SceneOptions& options = keys_.options;
  const bool has_field = options.formulation == Formulation::kPotential;
  const Shape& a = solids_[static_cast<std::size_t>(geoms.a)];
  const Shape& b = solids_[static_cast<std::size_t>(geoms.b)];
  if (has_field) {
    const std::string reason = why_no_pressure_field(a, b, options.engine);
    require(reason.empty(), "volcontact/option/formulation/potential does not serve geoms '" +
                                label(m, mjOBJ_GEOM, geoms.a) + "' and '" +
                                label(m, mjOBJ_GEOM, geoms.b) + "', " + name_of(a) + " with " +
                                name_of(b) + ": " + reason +
                                "; or use formulation/gonthier, or exclude them");
  }
  if (options.engine == Engine::kAuto || serves(options.engine, a, b)) return;
  warn_once(std::string("engine ") + to_string(options.engine) + " does not serve " + name_of(a) +
            " with " + name_of(b) + "; auto serves them");
}

PairContact SceneContact::make_pair(PairId id) const {
  GeomPair geoms;
  require(rules_.find(id, geoms), "pair " + std::to_string(id) + " is none of the " +
                                      std::to_string(rules_.count()) + " of the scene");
  return make_pair(geoms);
}

PairContact SceneContact::make_pair(const GeomPair& in_order) const {
  GeomPair geoms = in_order;
  const FlushGroups::Family family = flush_.family_of(geoms);
  if (family.swapped) std::swap(geoms.a, geoms.b);
  const LawClasses::Laws& law_class = laws_.of(in_order);
  const auto a = static_cast<std::size_t>(geoms.a), b = static_cast<std::size_t>(geoms.b);
  const SceneOptions& options = keys_.options;
  const Engine asked =
      serves(options.engine, solids_[a], solids_[b]) ? options.engine : Engine::kAuto;
  const Engine engine = asked != Engine::kAuto ? asked : engine_for(solids_[a], solids_[b]);
  const int most_cells = options.engine == Engine::kOctree ? kMostCells : kMostCellsInStep;
  const bool joins = family.number >= 0;
  const int frame_a = joins ? flush_.frame_of(geoms.a) : geoms.a;
  const int frame_b = joins ? flush_.frame_of(geoms.b) : geoms.b;
  // Flush solids are taken as one: their bodies as that of the frame, a patch as large as on all.
  const auto facts_of = [&](int geom, int frame) {
    GeomFacts facts = facts_[static_cast<std::size_t>(frame)];
    if (joins && flush_.is_tile(geom)) facts.largest_face = flush_.largest_face(geom);
    return facts;
  };
  const GeomFacts facts_a = facts_of(geoms.a, frame_a), facts_b = facts_of(geoms.b, frame_b);
  ContactLaws laws = law_class.laws;
  laws.mass = reduced_mass(facts_a, facts_b);
  if (family.swapped) laws.share_of_a = 1.0 - laws.share_of_a;
  PairContact pair{geoms, engine,
                   ContactModel({{solids_[a], solids_[b], Pose{}, Pose{}}}, std::move(laws),
                                {options.tolerance, asked, kInnerThreads, most_cells}),
                   law_class.stiffness};
  pair.frame_a = frame_a;
  pair.frame_b = frame_b;
  pair.family = family.number;
  set_rates(facts_a, facts_b, gravity_, pair);
  return pair;
}

void SceneContact::warn_about_model(const mjModel* m) {
  const std::string skipped = skipped_warning(m);
  if (!skipped.empty()) alert(skipped);
  if (has_flexes(m)) warn_once("flexes have no volumetric contact: they keep MuJoCo's own");
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

void SceneContact::warn_about_friction(const mjModel* m) {
  if (is_implicit() && !(m->opt.integrator == mjINT_RK4 && options().implicit == Implicit::kAuto)) {
    return;
  }
  using Key = std::tuple<int, double, double, double, std::array<double, 3>>;
  const auto kinds = kinds_of<std::map<Key, int>>(rules_, [&](int geom) -> Key {
    const auto i = static_cast<std::size_t>(geom);
    const mjtNum* inverse = m->body_invweight0 + 2 * m->geom_bodyid[geom];
    return {keys_.material_of_geom[i], m->geom_friction[3 * geom], inverse[0], inverse[1],
            sides_of(solids_[i])};
  });
  for (const GeomPair& geoms : pairs_of_kinds(rules_, kinds)) {
    const LawClasses::Laws& laws = laws_.of(geoms);
    const double longest =
        longest_step_at_rest(m, solids_, geoms, laws.laws.friction.get(), laws.stiffness);
    if (m->opt.timestep <= longest) continue;
    warn_once("friction of geoms '" + label(m, mjOBJ_GEOM, geoms.a) + "' and '" +
              label(m, mjOBJ_GEOM, geoms.b) +
              "' shakes them at rest: explicit steps (integrator=\"RK4\" or "
              "volcontact/option/implicit/off) hold it up to " +
              number_text(longest) +
              " s; use shorter ones, a larger slip_speed or softer bristles, or implicit contact");
    return;
  }
}

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

}  // namespace volcontact::adaptor
