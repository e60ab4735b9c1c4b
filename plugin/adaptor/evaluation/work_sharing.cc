// SPDX-License-Identifier: Apache-2.0
#include "adaptor/evaluation/work_sharing.h"

#include <omp.h>
#include <pthread.h>

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

EvaluationGuard::EvaluationGuard(int wanted) noexcept : restored_threads_(omp_get_max_threads()) {
  const bool alone = evaluations_in_flight.fetch_add(1) == 0 && !is_forked_child;
  threads_ = !alone ? 1 : wanted > 0 ? wanted : restored_threads_;
  if (threads_ != restored_threads_) omp_set_num_threads(threads_);
}

void EvaluationGuard::take_one() noexcept {
  if (threads_ == 1) return;
  threads_ = 1;
  omp_set_num_threads(1);
}

EvaluationGuard::~EvaluationGuard() {
  if (threads_ != restored_threads_) omp_set_num_threads(restored_threads_);
  evaluations_in_flight.fetch_sub(1);
}

}  // namespace volcontact::adaptor
