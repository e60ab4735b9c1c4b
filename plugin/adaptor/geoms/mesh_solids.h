// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adaptor/keys/scene_keys.h"
#include "adaptor/mujoco/mujoco_compat.h"
#include "volcontact/shape/shapes.h"

namespace volcontact::adaptor {

/// The solid inside of a mesh geom's triangles, in the geom's frame, or their convex hull, of type
/// ConvexPolytope. Throws
/// std::invalid_argument naming geom and mesh, what is wrong with the surface and where.
Shape mesh_solid(const mjModel* m, int geom, MeshForm form);

/// The solid between a height field and its base, cut into the triangles that MuJoCo's own
/// collision uses.
Shape height_field_solid(const mjModel* m, int geom);

}  // namespace volcontact::adaptor
