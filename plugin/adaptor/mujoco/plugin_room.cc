// SPDX-License-Identifier: Apache-2.0
#include "adaptor/mujoco/plugin_room.h"

// MuJoCo 2.3 has engine plugins, too, but fails where data with one are copied.
#if mjVERSION_HEADER >= 300

#include <algorithm>

namespace volcontact::adaptor {

int plugin_slot() noexcept {
  int slot = -1;
  return mjp_getPlugin(kPluginName, &slot) ? slot : -1;
}

PluginRoom plugin_room(const mjModel* m) noexcept {
  const int slot = plugin_slot();
  if (slot < 0) return {};
  const int* instance = std::find(m->plugin, m->plugin + m->nplugin, slot);
  if (instance == m->plugin + m->nplugin) return {};
  const auto i = instance - m->plugin;
  return {true, m->plugin_statenum[i], m->plugin_stateadr[i] + m->plugin_statenum[i]};
}

mjtNum* plugin_room_end(const mjData* d, const PluginRoom& room) noexcept {
  return d->plugin_state + room.end;
}

}  // namespace volcontact::adaptor

#else

namespace volcontact::adaptor {

int plugin_slot() noexcept { return -1; }
PluginRoom plugin_room(const mjModel* /*m*/) noexcept { return {}; }
mjtNum* plugin_room_end(const mjData* /*d*/, const PluginRoom& /*room*/) noexcept {
  return nullptr;
}

}  // namespace volcontact::adaptor

#endif
