// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adaptor/keys/scene_keys.h"
#include "adaptor/mujoco/mjgeoms.h"
#include "adaptor/mujoco/mujoco_compat.h"
#include "volcontact/shape/shapes.h"

namespace volcontact::adaptor {

/// The solid of a geom, in the geom's frame. Planes are half-spaces of infinite size, as in
/// MuJoCo's own collision. Throws std::invalid_argument for meshes that bound no solid (see
/// mesh_solids.h) and for signed distance fields.
Shape solid_of_geom(const mjModel* m, int geom, MeshForm form = MeshForm::kExact);

/// The solid that a geom is by itself: what its type says, or a volcontact/shape/....
Shape simple_solid(const mjModel* m, int geom, const SceneKeys& keys);

/// The solid that a volcontact/solid/... makes of its geoms, in the frame of the first one, ready
/// to be used.
Shape composed_solid(const mjModel* m, const ComposedGeoms& solid, const SceneKeys& keys);

}  // namespace volcontact::adaptor
