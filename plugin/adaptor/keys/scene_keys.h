// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "adaptor/keys/given_shape.h"
#include "adaptor/keys/materials.h"
#include "adaptor/keys/scene_options.h"
#include "adaptor/mujoco/mujoco_compat.h"

namespace volcontact::adaptor {

/// A volcontact/pair/...: its values and the geom pairs it stands for, lower geom first.
struct ListedPair {
  KeyedValues keyed;
  std::vector<std::pair<int, int>> geoms;
};

/// A volcontact/solid/...: geoms that count as one solid, which is named by the first of them.
struct ComposedGeoms {
  struct Part {
    int geom;
    Csg::Operation operation;  ///< with what came before
  };
  std::string key;
  std::vector<Part> parts;
};

/// A key that the program gives beside those of the file, and before them: "volcontact/option/...",
/// or a field of a material. A material that no tuple of the file names is the default material:
/// that of all geoms without one.
struct GivenKey {
  std::string name;
  std::vector<double> numbers;
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
  std::vector<GivenShape> shapes;
  std::vector<int> shape_of_geom;  ///< index into `shapes`, -1 for what the geom's type says
  std::vector<ComposedGeoms> solids;
  std::vector<int> solid_of_geom;  ///< index into `solids`, -1 for a geom that is one by itself
  std::vector<NumericSpan> numerics;
  std::vector<GivenKey> given;  ///< by the program
  bool has_target = false;      ///< the target was chosen, by the file or the program

  /// The shape that the geom stands for, or null.
  const GivenShape* given_shape(int geom) const {
    const int index = shape_of_geom[static_cast<std::size_t>(geom)];
    return index < 0 ? nullptr : &shapes[static_cast<std::size_t>(index)];
  }
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
SceneKeys read_scene_keys(const mjModel* m, const std::vector<GivenKey>& given = {});

/// Whether any name of the model is a `volcontact/...` key.
bool has_scene_keys(const mjModel* m) noexcept;

}  // namespace volcontact::adaptor
