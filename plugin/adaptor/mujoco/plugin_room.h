// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adaptor/mujoco/mujoco_compat.h"

// What the engine plugin `volcontact` (engine_plugin.h) has in mjData.

namespace volcontact::adaptor {

inline constexpr const char* kPluginName = "volcontact";

/// The plugin's number in MuJoCo's list; -1 where it is not known, or releases have no plugins.
int plugin_slot() noexcept;

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
