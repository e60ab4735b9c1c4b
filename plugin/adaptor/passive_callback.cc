// SPDX-License-Identifier: Apache-2.0
#include "adaptor/passive_callback.h"

#include <atomic>

#include "adaptor/auto_attach.h"
#include "adaptor/evaluation/apply_contact.h"
#include "adaptor/out_of_memory.h"
#include "adaptor/scene_registry.h"
#include "adaptor/step/look_ahead.h"
#include "adaptor/volcontact_mujoco.h"

namespace volcontact::adaptor {
namespace {

std::atomic<mjfGeneric> previous{nullptr};

// Somebody put a callback over ours while ours was installed. Theirs may call ours; when ours is
// then installed over theirs, the two would call each other for ever.
std::atomic<bool> was_covered{false};
std::atomic<bool> may_be_called_back{false};
thread_local bool is_inside = false;

void call_previous(const mjModel* m, mjData* d) {
  const mjfGeneric before = previous.load(std::memory_order_relaxed);
  if (!before) return;
  // No object with a destructor here: MuJoCo's errors leave by longjmp.
  is_inside = true;
  before(m, d);
  is_inside = false;
}

}  // namespace

void install_callback() {
  if (mjcb_passive == volcontact_passive) return;
  previous = mjcb_passive;
  may_be_called_back = was_covered.load();
  is_inside = false;
  stop_looking_ahead();
  mjcb_passive = volcontact_passive;
}

void uninstall_callback() {
  if (mjcb_passive == volcontact_passive) {
    mjcb_passive = previous.exchange(nullptr);
  } else {
    was_covered = true;
  }
}

bool callback_is_installed() { return mjcb_passive == volcontact_passive; }

EvaluationScratch& thread_scratch() {
  thread_local EvaluationScratch scratch;
  return scratch;
}

}  // namespace volcontact::adaptor

extern "C" void volcontact_passive(const mjModel* m, mjData* d) {
  using namespace volcontact::adaptor;
  if (is_inside && may_be_called_back) return;
  call_previous(m, d);
  if (is_looking_ahead()) return;
  const bool done = has_memory_for([&] {
    const SceneContact* contact =
        attaches_by_itself() ? contact_by_itself(m, Wish::kByKeys) : contact_of(m);
    // The engine plugin steps its own scenes.
    if (contact && !contact->is_in_plugin()) apply_contact(*contact, m, d, thread_scratch());
  });
  if (!done) stop_step();
}
