// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "adaptor/scene/scene_contact.h"

namespace volcontact::adaptor {

/// What was understood of a scene, as JSON text: options, userdata, materials, solids, pairs with
/// the values they use and where these come from, warnings.
std::string describe(const mjModel* m, const SceneContact& contact);

}  // namespace volcontact::adaptor
