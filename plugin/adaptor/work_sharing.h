// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace volcontact::adaptor {

/// While it lives, this thread evaluates a scene. Says how many threads the evaluation may use: one
/// while another thread evaluates too (each has a core of its own then), and one in a forked child,
/// where the threads of OpenMP no longer exist.
class EvaluationGuard {
 public:
  EvaluationGuard() noexcept;
  ~EvaluationGuard();
  EvaluationGuard(const EvaluationGuard&) = delete;
  EvaluationGuard& operator=(const EvaluationGuard&) = delete;

  /// `wanted` threads, 0 for as many as there are.
  int threads(int wanted) const noexcept;

 private:
  bool alone_;
  int restored_threads_;
};

}  // namespace volcontact::adaptor
