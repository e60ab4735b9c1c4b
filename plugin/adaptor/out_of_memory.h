// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

namespace volcontact::adaptor {

/// Runs what MuJoCo calls back. False where it ran out of memory: no exception may pass through
/// MuJoCo's own functions.
template <typename Work>
bool has_memory_for(Work&& work) noexcept {
  try {
    work();
    return true;
  } catch (...) {
    return false;
  }
}

/// Ends the step for lack of memory: MuJoCo's error, or in step_or_throw() the way out of there.
/// Both may leave by longjmp, so nothing with a destructor may be alive in the callback.
void stop_step();

/// mj_step(). Throws std::bad_alloc where a callback of ours called stop_step().
void step_or_throw(const mjModel* m, mjData* d);

}  // namespace volcontact::adaptor
