// SPDX-License-Identifier: Apache-2.0
#include "adaptor/engine_plugin.h"

#include "adaptor/mujoco/mujoco_compat.h"

// MuJoCo 2.3 has engine plugins, too, but fails where data with one are copied.
#if mjVERSION_HEADER >= 300

#include <algorithm>
#include <cstdio>
#include <exception>

#include "adaptor/auto_attach.h"
#include "adaptor/evaluation/apply_contact.h"
#include "adaptor/mujoco/plugin_room.h"
#include "adaptor/out_of_memory.h"
#include "adaptor/passive_callback.h"
#include "adaptor/readings/drawing.h"
#include "adaptor/scene/largest_state.h"
#include "adaptor/scene_registry.h"
#include "adaptor/step/look_ahead.h"

namespace volcontact::adaptor {
namespace {

// The contact of a model with our instance; null where it is refused.
const SceneContact* contact_in_plugin(const mjModel* m) {
  return contact_by_itself(m, Wish::kByPlugin);
}

int state_size(const mjModel* m, int /*instance*/) { return largest_state(m); }

// Called when data are made, also by the compiler: a scene that cannot be used does not compile.
int init(const mjModel* m, mjData* /*d*/, int /*instance*/) {
  // MuJoCo's errors leave by longjmp: no object with a destructor is alive then.
  thread_local char message[1000];
  message[0] = '\0';
  try {
    if (!contact_of(m)) attach_scene(const_cast<mjModel*>(m), {}, Attacher::kItself);
  } catch (const std::exception& error) {
    std::snprintf(message, sizeof message, "volcontact: %s", error.what());
  }
  if (message[0] != '\0') mju_error("%s", message);
  // So that native contact is off before the first evaluation.
  if (!has_memory_for([&] { contact_in_plugin(m); })) stop_step();
  return 0;
}

void reset(const mjModel* m, mjtNum* state, void* /*data*/, int instance) {
  std::fill_n(state, m->plugin_statenum[instance], 0.0);
}

void compute(const mjModel* m, mjData* d, int /*instance*/, int /*capability*/) {
  if (is_looking_ahead()) return;
  const bool done = has_memory_for([&] {
    const SceneContact* contact = contact_in_plugin(m);
    if (contact) apply_contact(*contact, m, d, thread_scratch());
  });
  if (!done) stop_step();
}

void visualize(const mjModel* m, mjData* d, const mjvOption* option, mjvScene* scene,
               int /*instance*/) {
  const bool done = has_memory_for([&] {
    const SceneContact* contact = contact_of(m);
    if (contact) draw_sites(*contact, m, d, option, scene, thread_scratch());
  });
  if (!done) stop_step();
}

}  // namespace

void register_engine_plugin() {
  if (mj_version() != mjVERSION_HEADER || plugin_slot() >= 0) return;
  mjpPlugin plugin;
  mjp_defaultPlugin(&plugin);
  plugin.name = kPluginName;
  plugin.capabilityflags = mjPLUGIN_PASSIVE;
  plugin.nstate = state_size;
  plugin.init = init;
  plugin.reset = reset;
  plugin.compute = compute;
  plugin.visualize = visualize;
  mjp_registerPlugin(&plugin);
}

}  // namespace volcontact::adaptor

#else

namespace volcontact::adaptor {

void register_engine_plugin() {}

}  // namespace volcontact::adaptor

#endif
