// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "adaptor/model_content.h"
#include "adaptor/scene_contact.h"

namespace volcontact::adaptor {

/// Makes the contact of `m` volumetric, in all its mjData. Throws std::invalid_argument with a
/// message for the author of the scene, and std::logic_error when `m` is attached already. Returns
/// a warning or nothing.
std::string attach_scene(mjModel* m);

/// Undoes attach_scene; returns whether `m` was attached. To be called before `m` is deleted.
bool detach_scene(mjModel* m);

bool is_attached(const mjModel* m);

/// How many scenes are attached.
int attached_scenes();

/// The contact of an attached model, or of a copy of one; null for any other. Follows changes of
/// the numbers in the model (materials, sizes): the next call returns a contact that has them.
/// Where the changed numbers are not valid the last valid ones stay in force, and live_error() says
/// why. Cheap, without locks, as long as nothing changes; never throws. Valid until this thread
/// asks for another model.
const SceneContact* contact_of(const mjModel* m) noexcept;

/// Why the present numbers of an attached model are not in force; empty when they are.
std::string live_error(const mjModel* m);

}  // namespace volcontact::adaptor
