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

/// Numbers of mjData.plugin_state that belong to our instance in the model.
struct PluginRoom {
  bool is_there = false;
  int size = 0;
  int end = 0;  ///< one past the last
};
PluginRoom plugin_room(const mjModel* m) noexcept;

/// The first of `room` in `d`, plus `room.end`; null for releases without plugins.
mjtNum* plugin_room_end(const mjData* d, const PluginRoom& room) noexcept;

}  // namespace volcontact::adaptor
