// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "adaptor/model_content.h"
#include "adaptor/scene/scene_contact.h"

namespace volcontact::adaptor {

/// Who attaches a model: the author of the program, or volcontact itself, whom the author may
/// override.
enum class Attacher : int { kAuthor = 0, kItself = 1 };

/// Makes the contact of `m` volumetric, in all its mjData; `given` are keys of the program. Throws
/// std::invalid_argument with a message for the author of the scene, and std::logic_error when `m`
/// is attached already. Returns what to warn the author of.
std::vector<std::string> attach_scene(mjModel* m, const std::vector<GivenKey>& given = {},
                                      Attacher attacher = Attacher::kAuthor);

/// Undoes attach_scene; returns whether `m` was attached. To be called before `m` is deleted. A
/// model with the engine plugin stays attached, by itself.
bool detach_scene(mjModel* m);

bool is_attached(const mjModel* m);

/// How many scenes are attached that need the passive callback.
int scenes_of_the_callback();

/// The contact of an attached model, or of a copy of one; null for any other. Follows changes of
/// the numbers in the model (materials, sizes): the next call returns a contact that has them.
/// Where the changed numbers are not valid the last valid ones stay in force, and live_error() says
/// why. Cheap, without locks, as long as nothing changes. Valid until this thread asks for another
/// model. Throws std::bad_alloc alone.
const SceneContact* contact_of(const mjModel* m);

/// Why the present numbers of an attached model are not in force; empty when they are.
std::string live_error(const mjModel* m);

}  // namespace volcontact::adaptor
