// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "adaptor/materials.h"
#include "adaptor/mujoco_compat.h"
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
  kExact = 0,  ///< its triangles as given
  kHull = 1,   ///< their convex hull, as MuJoCo does
};
inline constexpr const char* kMeshFormWords[] = {"exact", "hull"};

/// Whether steps are implicit in the contact forces.
enum class Implicit : int {
  kAuto = 0,    ///< where a patch is too stiff for an explicit step, in its stiff directions
  kAlways = 1,  ///< always, in all directions
  kNever = 2,
};
inline constexpr const char* kImplicitWords[] = {"auto", "on", "off"};

/// The options that are numbers.
struct OptionNumbers {
  static constexpr const char* kName = "volcontact/option";
  struct Params {
    double tolerance = 1e-3;
    double threads = 0.0;
  };
  static constexpr std::array kFields{
      Field<Params>{"tolerance", "-", &Params::tolerance,
                    Range{0.0, 1.0, true, true, "> 0 and < 1"},
                    "relative error asked of the volume"},
      Field<Params>{"threads", "-", &Params::threads,
                    Range{0.0, 1024.0, false, false, "a whole number from 0 to 1024"},
                    "0 decides by work"}};
};

struct SceneOptions {
  double tolerance = 1e-3;
  int threads = 0;
  Engine engine = Engine::kAuto;
  Target target = Target::kApplied;
  PairRule pairs = PairRule::kNative;
  MeshForm mesh = MeshForm::kExact;
  Implicit implicit = Implicit::kAuto;
  Formulation formulation = Formulation::kGonthier;
};

/// A volcontact/pair/...: its values and the geom pairs it stands for, lower geom first.
struct ListedPair {
  KeyedValues keyed;
  std::vector<std::pair<int, int>> geoms;
};

/// A volcontact/solid/...: geoms that count as one solid, which is named by the first of them.
struct ComposedGeoms {
  struct Part {
    int geom;
    bool adds;  ///< else it is cut out of what came before
  };
  std::string key;
  std::vector<Part> parts;
};

/// Numbers [address, address + size) of mjModel.numeric_data that belong to volcontact.
struct NumericSpan {
  int address;
  int size;
};

/// Everything that the `volcontact/...` numerics and tuples of a model say.
struct SceneKeys {
  SceneOptions options;
  std::vector<KeyedValues> materials;
  std::vector<int> material_of_geom;  ///< index into `materials`, -1 for the default material
  std::vector<ListedPair> pairs;
  std::map<std::pair<int, int>, int> pair_of_geoms;  ///< index into `pairs`, lower geom first
  std::vector<ComposedGeoms> solids;
  std::vector<int> solid_of_geom;  ///< index into `solids`, -1 for a geom that is one by itself
  std::vector<NumericSpan> numerics;

  /// The composed solid that the geom belongs to, or null.
  const ComposedGeoms* composed(int geom) const {
    const int index = solid_of_geom[static_cast<std::size_t>(geom)];
    return index < 0 ? nullptr : &solids[static_cast<std::size_t>(index)];
  }
  /// Whether the geom is a solid, or names one: the other geoms of a composed solid do not touch
  /// anything by themselves.
  bool is_solid(int geom) const {
    const ComposedGeoms* solid = composed(geom);
    return !solid || solid->parts[0].geom == geom;
  }
};

/// Reads the keys; docs/plugin.md, "Keys". Names may carry the prefix that MjSpec.attach puts
/// before `volcontact/`; materials and pairs of different prefixes are different ones. Throws
/// std::invalid_argument naming the key, the allowed range and the nearest valid spelling.
SceneKeys read_scene_keys(const mjModel* m);

}  // namespace volcontact::adaptor
