// SPDX-License-Identifier: Apache-2.0
#include "adaptor/step/look_ahead.h"

#include <algorithm>
#include <vector>

#include "adaptor/mujoco/mujoco_compat.h"

namespace volcontact::adaptor {
namespace {

thread_local bool looks_ahead = false;

#if mjVERSION_HEADER >= 3013000

// The copy of one thread; made anew for another model.
class Copy {
 public:
  Copy() = default;
  Copy(const Copy&) = delete;
  Copy& operator=(const Copy&) = delete;
  ~Copy() {
    if (data_) mj_deleteData(data_);
  }

  mjData* of(const mjModel* m, const mjData* d) {
    const bool fits = data_ && model_ == m && data_->nbuffer == d->nbuffer &&
                      data_->narena == d->narena && data_->signature == d->signature;
    if (!fits) {
      state_.resize(static_cast<std::size_t>(mj_stateSize(m, mjSTATE_INTEGRATION)));
      if (data_) mj_deleteData(data_);
      data_ = mj_makeData(m);
      model_ = m;
    }
    mj_getState(m, d, state_.data(), mjSTATE_INTEGRATION);
    mj_setState(m, data_, state_.data(), mjSTATE_INTEGRATION);
    return data_;
  }

 private:
  const mjModel* model_ = nullptr;
  mjData* data_ = nullptr;
  std::vector<mjtNum> state_;
};

#endif

}  // namespace

bool is_looking_ahead() { return looks_ahead; }
void stop_looking_ahead() { looks_ahead = false; }

const mjData* look_ahead([[maybe_unused]] const mjModel* m, [[maybe_unused]] const mjData* d) {
#if mjVERSION_HEADER >= 3013000
  if (!solves_with_step_matrix(m) || (d->nefc == 0 && !adds_to_step_matrix(m))) return nullptr;
  static thread_local Copy copy;
  mjData* ahead = copy.of(m, d);
  looks_ahead = true;
  mj_forwardSkip(m, ahead, mjSTAGE_NONE, 1);
  looks_ahead = false;
  return ahead;
#else
  return nullptr;
#endif
}

bool complete_constraints(mjData* d, const mjData* ahead) {
  if (!ahead) return true;
  if (ahead->nefc != d->nefc) return false;
  const auto count = static_cast<std::size_t>(d->nefc);
  std::copy_n(ahead->efc_D, count, d->efc_D);
  std::copy_n(ahead->efc_R, count, d->efc_R);
  std::copy_n(ahead->efc_KBIP, 4 * count, d->efc_KBIP);
  return true;
}

}  // namespace volcontact::adaptor
