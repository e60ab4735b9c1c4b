// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

// The engine plugin `volcontact`, for MuJoCo 3 and later:
//
//   <extension><plugin plugin="volcontact"><instance name="volcontact"/></plugin></extension>
//
// A scene with it has volumetric contact in every program that has loaded the library, with its
// state in mjData.plugin_state. docs/plugin.md, "Engine plugin".

namespace volcontact::adaptor {

/// Makes the plugin known to MuJoCo, once; nothing for releases that have none, and where another
/// MuJoCo runs than the one this was compiled for.
void register_engine_plugin();

}  // namespace volcontact::adaptor
