// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "adaptor/geoms/cull.h"
#include "adaptor/geoms/flush_groups.h"
#include "adaptor/keys/materials.h"
#include "adaptor/keys/scene_keys.h"
#include "adaptor/memory/side_states.h"
#include "adaptor/memory/site_pool.h"
#include "adaptor/memory/userdata_layout.h"
#include "adaptor/mujoco/plugin_room.h"
#include "adaptor/scene/law_classes.h"
#include "adaptor/scene/pair_contact.h"
#include "adaptor/scene/pair_rates.h"
#include "adaptor/scene/pair_store.h"
#include "volcontact/step/mechanism.h"

namespace volcontact::adaptor {

/// Set in mjModel.opt.disableflags, where MuJoCo has no flag, while the model is attached; so its
/// copies are known from a second load of the same file.
inline constexpr int kAttachedMark = 1 << 30;

/// Volumetric contact of one scene: all that is read once. Const once made: what lasts from step to
/// step is in mjData.userdata, so one object serves any number of mjData, threads and copies of the
/// model. For models without keys and room it is beside mjData: see find_room(). What happens at
/// each evaluation: evaluation/apply_contact.h; what is told of it: readings/.
class SceneContact {
 public:
  /// Reads the scene. Throws std::invalid_argument with a message for the author of the scene.
  /// `given`: keys of the program. `before`: of the same model with other numbers; its meshes need
  /// not be made again.
  explicit SceneContact(const mjModel* m, const std::vector<GivenKey>& given = {},
                        const SceneContact* before = nullptr);

  /// Settles where the state lies: at the end of mjData.userdata, or in plugin_state where the
  /// model has our engine plugin. A model without keys, which nobody has made room in, has it
  /// beside mjData, and its forces go to qfrc_passive; any other that lacks room is refused with
  /// std::invalid_argument and the line to add.
  void find_room(const mjModel* m, const SceneContact* before = nullptr);

  const SceneKeys& keys() const { return keys_; }
  const SceneOptions& options() const { return keys_.options; }
  const std::vector<Shape>& solids() const { return solids_; }
  /// Which geoms can touch, and the contact models of pairs: each is made when it is first asked
  /// for.
  const PairRules& rules() const { return rules_; }
  const PairContact& pair(PairId id) const {
    return made_.get(id, [&] { return make_pair(id); });
  }
  /// The same of a pair that can touch, made anew.
  PairContact make_pair(const GeomPair& geoms) const;
  std::size_t made_pairs() const { return made_.made(); }
  /// The solids that continue each other.
  const FlushGroups& flush() const { return flush_; }
  const LawClasses& laws() const { return laws_; }
  const MechanismTrees& trees() const { return trees_; }
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// Those of the warnings that say the simulation will not be what its author expects.
  const std::vector<std::string>& alerts() const { return alerts_; }
  UserdataLayout layout(const mjModel* m) const;

  /// Whether our block is beside mjData, or in its plugin_state; else it is in userdata.
  bool is_beside() const { return beside_ != nullptr; }
  bool is_in_plugin() const { return plugin_.is_there; }

  /// False for the model and data that MuJoCo makes for itself when it compiles.
  bool has_room(const mjModel* m) const {
    return is_beside() || is_in_plugin() || m->nuserdata >= layout(m).size();
  }

  /// Our block of `d`; only valid where has_room().
  UserdataBlock block(const mjModel* m, const mjData* d) const;

  /// What is read at each evaluation.
  const Cull& cull() const { return cull_; }
  const SitePoolLayout& sites() const { return sites_; }
  /// Of the pairs; behind the sites.
  const SitePoolLayout& energies() const { return energies_; }
  int solved_rows() const { return solved_rows_; }
  bool is_implicit() const { return options().implicit != Implicit::kNever; }

 private:
  void read_laws(const mjModel* m);
  void warn_about_native_pair(const mjModel* m, int native);
  void check_engines(const mjModel* m);
  void check_engine(const mjModel* m, const GeomPair& geoms);
  PairContact make_pair(PairId id) const;
  void warn_about_model(const mjModel* m);
  static bool keeps_by_choice(const ContactLaws& laws);
  void warn_about_meshes(const mjModel* m);
  void warn_about_friction(const mjModel* m);
  void warn_once(const std::string& warning);
  void alert(const std::string& warning);

  SceneKeys keys_;
  std::string no_contact_;  // the flag of the model that says so; else empty
  PairRules rules_;
  std::map<int, Shape> meshes_;  // by number
  std::vector<Shape> solids_;    // by geom; of geoms without a pair a placeholder
  FlushGroups flush_;
  LawClasses laws_;
  MechanismTrees trees_;
  std::vector<GeomFacts> facts_;  // by geom
  double gravity_ = 0.0;
  bool keeps_by_choice_ = false;
  PairStore made_;
  Cull cull_;
  SitePoolLayout sites_;
  int solved_rows_ = 0;
  SitePoolLayout energies_;  // of the pairs; behind the sites
  std::shared_ptr<SideStates> beside_;
  PluginRoom plugin_;
  std::vector<std::string> warnings_, alerts_;
};

}  // namespace volcontact::adaptor
