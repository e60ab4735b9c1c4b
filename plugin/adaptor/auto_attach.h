// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include "adaptor/scene/scene_contact.h"

namespace volcontact::adaptor {

/// Whether models are attached by themselves; see volcontact_set_auto.
bool attaches_by_itself() noexcept;
void set_attaches_by_itself(bool on) noexcept;

/// What makes a model one to attach by itself.
enum class Wish : int {
  kByKeys = 0,    ///< its `volcontact/...` keys, if it has any
  kByPlugin = 1,  ///< that the engine plugin asks
};

/// The contact of a model, which is attached when no one has done so and there is a wish; null
/// where there is none, and for the one evaluation at which native contact is turned off, since
/// that has its native contacts already. What goes wrong becomes a MuJoCo warning. Throws
/// std::bad_alloc alone.
const SceneContact* contact_by_itself(const mjModel* m, Wish wish);

}  // namespace volcontact::adaptor
