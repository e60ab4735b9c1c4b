// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "adaptor/keys/scene_key.h"
#include "volcontact/base/fields.h"
#include "volcontact/model/contact_model.h"
#include "volcontact/pair/engine.h"

namespace volcontact::adaptor {

/// Where the contact forces are written.
enum class Target : int {
  kApplied = 0,  ///< mjData.qfrc_applied, beside what the user wrote there
  kPassive = 1,  ///< mjData.qfrc_passive: no user write can disturb it
  kXfrc = 2,     ///< mjData.xfrc_applied: force and torque sensors see it
};
inline constexpr const char* kTargetWords[] = {"applied", "passive", "xfrc"};

/// Which pairs are volumetric.
enum class PairRule : int {
  kNative = 0,  ///< all that MuJoCo itself would let collide, and those listed
  kListed = 1,  ///< only those of a volcontact/pair/...; the rest stays native
};
inline constexpr const char* kPairRuleWords[] = {"native", "listed"};

/// What stands for a mesh geom.
enum class MeshForm : int {
  kExact = 0,        ///< its triangles as given
  kHull = 1,         ///< their convex hull, as MuJoCo does
  kExactOrHull = 2,  ///< the triangles where they bound a solid, else the hull
};
inline constexpr const char* kMeshFormWords[] = {"exact", "hull", "exact_or_hull"};

/// Whether steps are implicit in the contact forces.
enum class Implicit : int {
  kAuto = 0,    ///< where a patch is too stiff for an explicit step, in its stiff directions
  kAlways = 1,  ///< always, in all directions
  kNever = 2,
};
inline constexpr const char* kImplicitWords[] = {"auto", "on", "off"};

/// What a model means that turns off its contacts or constraints by a flag.
enum class Disabled : int {
  kRespect = 0,  ///< that it has no contact, unless it asks for volumetric contact by itself
  kIgnore = 1,   ///< that it has no native contact
};
inline constexpr const char* kDisabledWords[] = {"respect", "ignore"};

/// The options that are numbers.
struct OptionNumbers {
  static constexpr const char* kName = "volcontact/option";
  struct Params {
    double tolerance = 1e-3;
    double threads = 0.0;
    double exit_speed = 0.1;
  };
  static constexpr std::array kFields{
      Field<Params>{"tolerance", "-", &Params::tolerance,
                    Range{0.0, 1.0, true, true, "> 0 and < 1"},
                    "relative error asked of the volume"},
      Field<Params>{"threads", "-", &Params::threads,
                    Range{0.0, 1024.0, false, false, "a whole number from 0 to 1024"},
                    "0 decides by work"},
      Field<Params>{"exit_speed", "m/s", &Params::exit_speed, kNonNegative,
                    "fastest parting of bodies from an overlap that no motion has paid for"}};
};

struct SceneOptions {
  double tolerance = 1e-3;
  int threads = 0;
  double exit_speed = 0.1;  ///< [m/s]
  Engine engine = Engine::kAuto;
  Target target = Target::kApplied;
  PairRule pairs = PairRule::kNative;
  MeshForm mesh = MeshForm::kExact;
  Implicit implicit = Implicit::kAuto;
  Formulation formulation = Formulation::kGonthier;
  Disabled disabled = Disabled::kRespect;
};

/// Reads `volcontact/option/...`, key by key. Options of the program come before those of the
/// scene, and these before those of attached models, which must agree.
class OptionReader {
 public:
  /// Throws std::invalid_argument naming the key, the allowed range and the nearest valid spelling.
  void read(const SceneKey& key, const std::vector<double>& numbers, bool by_program);

  /// All options, once every key has been read. Throws where attached models disagree.
  SceneOptions finish() const;

  bool has(const std::string& name) const { return given_.contains(name); }

 private:
  struct Given {
    std::string prefix;
    std::string key;
    std::vector<double> numbers;
    std::string word;
    bool by_program;
  };
  void keep(const std::string& name, Given option);
  template <typename Enum, std::size_t kCount>
  void set_choice(const std::string& name, const char* const (&words)[kCount], Enum& out) const;

  std::map<std::string, Given> given_;
  std::map<std::string, std::string> disagreements_;  // by option; moot when the scene has it too
};

}  // namespace volcontact::adaptor
