// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <vector>

namespace volcontact::adaptor {

/// All that a run goes on from, as MuJoCo's "integration state": with it, data of the same model
/// continue with the same bits. Contact keeps its memory in userdata, which is part of it.
inline int run_state_size(const mjModel* m) {
#if mjVERSION_HEADER >= 300
  return static_cast<int>(mj_stateSize(m, mjSTATE_INTEGRATION));
#else
  return 1 + m->nq + 3 * m->nv + m->na + m->nu + 6 * m->nbody + 7 * m->nmocap + m->nuserdata;
#endif
}

#if mjVERSION_HEADER < 300
/// Calls use(array, count) for each array of the state; MuJoCo has no function for it yet.
template <typename Data, typename Use>
void for_run_state(const mjModel* m, Data* d, Use use) {
  use(&d->time, 1);
  use(d->qpos, m->nq);
  use(d->qvel, m->nv);
  use(d->act, m->na);
  use(d->qacc_warmstart, m->nv);
  use(d->ctrl, m->nu);
  use(d->qfrc_applied, m->nv);
  use(d->xfrc_applied, 6 * m->nbody);
  use(d->mocap_pos, 3 * m->nmocap);
  use(d->mocap_quat, 4 * m->nmocap);
  use(d->userdata, m->nuserdata);
}
#endif

inline void get_run_state(const mjModel* m, const mjData* d, mjtNum* numbers) {
#if mjVERSION_HEADER >= 300
  mj_getState(m, d, numbers, mjSTATE_INTEGRATION);
#else
  for_run_state(m, d, [&](const mjtNum* array, int count) {
    mju_copy(numbers, array, count);
    numbers += count;
  });
#endif
}

inline void set_run_state(const mjModel* m, mjData* d, const mjtNum* numbers) {
#if mjVERSION_HEADER >= 300
  mj_setState(m, d, numbers, mjSTATE_INTEGRATION);
#else
  for_run_state(m, d, [&](mjtNum* array, int count) {
    mju_copy(array, numbers, count);
    numbers += count;
  });
#endif
}

}  // namespace volcontact::adaptor
