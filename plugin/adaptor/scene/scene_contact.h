// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "adaptor/geoms/pair_list.h"
#include "adaptor/keys/scene_keys.h"
#include "adaptor/memory/energy_account.h"
#include "adaptor/memory/side_states.h"
#include "adaptor/memory/site_pool.h"
#include "adaptor/memory/userdata_layout.h"
#include "adaptor/mujoco/plugin_room.h"
#include "adaptor/scene/body_forces.h"
#include "adaptor/scene/mocap_motion.h"
#include "adaptor/step/implicit_step.h"
#include "volcontact/model/contact_model.h"

namespace volcontact::adaptor {

/// Set in mjModel.opt.disableflags, where MuJoCo has no flag, while the model is attached; so its
/// copies are known from a second load of the same file.
inline constexpr int kAttachedMark = 1 << 30;

/// The contact model of one pair of geoms. Body A is the frame of geom a, body B that of geom b.
struct PairContact {
  GeomPair geoms;
  Engine engine;  ///< the one that will serve
  PairLaws laws;
  ContactModel model;
  /// k/m of a patch as large as the smaller solid's box against a displacement [1/s^2].
  double largest_rate = 0.0;
  /// The same of friction with a memory against sliding, 0 without one [1/s^2].
  double bristle_rate = 0.0;
  double bristle_damping_rate = 0.0;  ///< and of its damping [1/s]
  bool is_jointed = false;            ///< whether one of the bodies hangs on joints
};

/// Volumetric contact of one scene. Const once made: what lasts from step to step is in
/// mjData.userdata, so one object serves any number of mjData, threads and copies of the model. For
/// models without keys and room it is beside mjData: see find_room().
class SceneContact {
 public:
  /// Memory of one evaluation; one per thread, reused from call to call.
  struct Scratch {
    Cull::Scratch cull;                  ///< `near`: the pairs evaluated
    std::vector<ContactReport> reports;  ///< of the pairs in `near`, finite numbers only
    std::vector<char> invalid;           ///< whether a report was left out, having no numbers
    std::vector<char> stiff;             ///< of all sites, whether an explicit step cannot hold it
    std::vector<char> held;  ///< of the pairs in `near`, whether other forces than its laws say act
    std::vector<int> order;  ///< of `near`, as worked off: the long pairs first
    std::vector<ContactModel::Workspace> workspaces;  ///< one per OpenMP thread
    BodyForces forces;
    ImplicitStep implicit;
    double dissipated = 0.0;           ///< by the contacts up to the evaluation before [J]
    std::vector<PairEnergy> energies;  ///< of the pairs in `near`
    std::vector<double> user_qfrc, user_xfrc, known, row;
    MocapMotion mocaps;
    std::vector<double> way;  ///< of the dofs since the evaluation before
  };

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
  const std::vector<PairContact>& pairs() const { return pairs_; }
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

  /// What the passive callback does: evaluates all pairs at the poses and velocities in `d` and
  /// writes the forces to the target. The same result however often it is called at one time.
  void step(const mjModel* m, mjData* d, Scratch& scratch) const noexcept;

  /// Evaluates all pairs again at the state of the last evaluation, for reading, into
  /// `scratch.reports`; nothing is written to `d`. Returns false when there was no evaluation.
  bool revisit(const mjModel* m, const mjData* d, Scratch& scratch) const noexcept;

  /// Energies of the last evaluation; zero when there was none.
  EnergyAccount energy(const mjModel* m, const mjData* d) const noexcept;

  /// Evaluations in which a force was no number and was left out.
  double dropped(const mjModel* m, const mjData* d) const noexcept;

  /// Evaluations in which there were more contact sites than userdata keeps: the friction and the
  /// impact speed of the rest began anew.
  double forgotten(const mjModel* m, const mjData* d) const noexcept;

  /// Whether and from which patch on steps are implicit in the contact of a pair.
  struct ImplicitUse {
    bool is_possible = false;     ///< for `auto`
    bool by_friction = false;     ///< this needs it in every contact
    double largest_number = 0.0;  ///< h^2 k/m of a patch as large as the smaller solid's box [-]
    double least_area = 0.0;      ///< of a patch that `auto` makes implicit [m^2]
    double explicit_step = 0.0;   ///< the longest that an explicit step should be there [s]
  };
  ImplicitUse implicit_use(const mjModel* m, const PairContact& pair) const;

  /// Takes our part out of the force array of the target.
  void release(const mjModel* m, mjData* d) const noexcept;

 private:
  // How the pairs of one evaluation are worked off, in the order of Scratch::order: some one after
  // the other, each sharing its own work; then, in one parallel region, some alone and the rest by
  // the handful.
  struct Work {
    int threads = 1;
    int pairs = 0;
    int own_sharing = 0;
    int single_tasks = 0;
  };
  Work plan_work(int threads, Scratch& scratch) const;

  void add_pair(const mjModel* m, const GeomPair& geoms);
  void warn_about_model(const mjModel* m);
  void warn_about_meshes(const mjModel* m);
  void warn_about_friction(const mjModel* m);
  void set_rates(const mjModel* m, PairContact& pair) const;
  void warn_once(const std::string& warning);
  void alert(const std::string& warning);
  // The sites that the evaluation before left, of which `committed` is null when there was none.
  struct Before {
    const double* committed = nullptr;
    double elapsed = 0.0;
    bool keeps_inputs = false;
  };
  void evaluate(const mjModel* m, const mjData* d, const Before& before,
                Scratch& scratch) const noexcept;
  double follow_mocaps(const mjModel* m, const mjData* d, const UserdataBlock& our,
                       const AccountKeeper& account, Scratch& scratch) const noexcept;
  void evaluate_one(const mjModel* m, const mjData* d, const Before& before, int k,
                    ContactModel::Workspace& workspace, Scratch& scratch) const noexcept;
  bool is_implicit() const noexcept { return options().implicit != Implicit::kNever; }
  bool is_stiff(const mjModel* m, mjData* d, const PairContact& pair, const ContactReport& report,
                std::size_t site, ExplicitBounds most, Scratch& scratch) const noexcept;
  bool find_stiff_sites(const mjModel* m, mjData* d, Scratch& scratch) const noexcept;
  void solve_implicit(const mjModel* m, mjData* d, Scratch& scratch) const noexcept;
  void keep_solved(const UserdataBlock& our, const Scratch& scratch) const noexcept;
  void recall_solved(const UserdataBlock& our, Scratch& scratch) const noexcept;
  double read_energies(const double* committed, double elapsed, bool is_rk4,
                       Scratch& scratch) const noexcept;
  struct ExplicitShare {
    double share, released_at_most;
    bool slowly;  // whether it needs what may be released
  };
  ExplicitShare share_of(const mjModel* m, std::size_t k, const PairEnergy::Now& now,
                         const Scratch& scratch) const noexcept;
  bool find_unpaid_pairs(const mjModel* m, Scratch& scratch) const noexcept;
  bool limit_explicit(const mjModel* m, Scratch& scratch) const noexcept;
  // What a later stage of Runge-Kutta cannot hold, and was not solved when the step began, waits
  // for the next.
  void postpone_stiff(Scratch& scratch) const noexcept;
  void hold_solved(const mjModel* m, mjData* d, const UserdataBlock& our,
                   Scratch& scratch) const noexcept;
  void release(const AccountKeeper& account, EnergyAccount& now, Scratch& scratch) const noexcept;
  void choose_forces(const mjModel* m, mjData* d, const UserdataBlock& our,
                     const AccountKeeper& account, EnergyAccount& now,
                     Scratch& scratch) const noexcept;
  bool keep_energies(double* states, const Scratch& scratch) const noexcept;
  bool keep_sites(double* states, const Scratch& scratch) const noexcept;
  void add_held(const mjModel* m, const mjData* d, const UserdataBlock& our,
                BodyForces& forces) const noexcept;
  void write_forces(const mjModel* m, mjData* d, bool goes_on, Scratch& scratch) const noexcept;

  SceneKeys keys_;
  std::string no_contact_;  // the flag of the model that says so; else empty
  std::vector<GeomPair> geom_pairs_;
  std::map<int, Shape> meshes_;  // by number
  std::vector<Shape> solids_;    // by geom; of geoms without a pair a placeholder
  std::vector<PairContact> pairs_;
  Cull cull_;
  SitePoolLayout sites_;
  int solved_rows_ = 0;
  SitePoolLayout energies_;  // of the pairs; behind the sites
  std::shared_ptr<SideStates> beside_;
  PluginRoom plugin_;
  std::vector<std::string> warnings_, alerts_;
};

}  // namespace volcontact::adaptor
