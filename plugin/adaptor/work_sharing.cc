// SPDX-License-Identifier: Apache-2.0
#include "adaptor/work_sharing.h"

#include <omp.h>
#include <pthread.h>

#include <algorithm>
#include <atomic>

namespace volcontact::adaptor {
namespace {

std::atomic<int> evaluations_in_flight{0};
std::atomic<bool> is_forked_child{false};

// A child inherits the library with the counter as it stood, and OpenMP without its threads.
[[maybe_unused]] const int fork_handler = pthread_atfork(nullptr, nullptr, [] {
  is_forked_child = true;
  evaluations_in_flight = 0;
});

}  // namespace

EvaluationGuard::EvaluationGuard() noexcept
    : alone_(evaluations_in_flight.fetch_add(1) == 0 && !is_forked_child), restored_threads_(0) {
  if (alone_) return;
  restored_threads_ = omp_get_max_threads();
  omp_set_num_threads(1);
}

EvaluationGuard::~EvaluationGuard() {
  if (!alone_) omp_set_num_threads(restored_threads_);
  evaluations_in_flight.fetch_sub(1);
}

int EvaluationGuard::threads(int wanted) const noexcept {
  if (!alone_) return 1;
  return wanted > 0 ? wanted : std::max(1, omp_get_max_threads());
}

}  // namespace volcontact::adaptor
