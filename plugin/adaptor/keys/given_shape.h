// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "adaptor/keys/scene_key.h"
#include "adaptor/mujoco/mujoco_compat.h"
#include "volcontact/shape/shapes.h"

namespace volcontact::adaptor {

/// A volcontact/shape/...: what geoms are that MuJoCo has no type for. They stand where the solid
/// is, and are what MuJoCo draws.
struct GivenShape {
  std::string key;
  std::string word;            ///< one of shape_words(); empty until it was read
  std::optional<Shape> shape;  ///< in the geom's frame; none: made of the geom
  double radius = 0.0;         ///< of the edges of a rounded box, whose size is that of the geom
};

/// frustum, torus, rounded_box, convex_polytope.
std::vector<std::string> shape_words();

/// Reads volcontact/shape/NAME/WORD: the numbers of a frustum or torus, the radius of the edges of
/// boxes, or 1 for the convex hull of meshes. Throws std::invalid_argument.
void read_shape(const SceneKey& key, const std::vector<double>& numbers, GivenShape& given);

/// The box of this size with the edges of `given`. Throws std::invalid_argument that names the
/// geom.
Shape rounded_box_of(const mjModel* m, int geom, const GivenShape& given);

/// Throws std::invalid_argument where the geom cannot stand for such a solid, or none was given.
void check_stand_in(const mjModel* m, int geom, const GivenShape& given);

}  // namespace volcontact::adaptor
