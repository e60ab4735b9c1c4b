// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace volcontact::adaptor {

/// While it lives, this thread evaluates a scene and limits the threads that OpenMP may use for it:
/// to those asked for; to one while another thread evaluates too, since each has a core of its own
/// then; to one in a forked child, where the threads of OpenMP no longer exist.
class EvaluationGuard {
 public:
  /// `wanted` threads, 0 for as many as OpenMP thinks right.
  explicit EvaluationGuard(int wanted) noexcept;
  ~EvaluationGuard();
  EvaluationGuard(const EvaluationGuard&) = delete;
  EvaluationGuard& operator=(const EvaluationGuard&) = delete;

  int threads() const noexcept { return threads_; }
  /// One thread for what follows.
  void take_one() noexcept;

 private:
  int restored_threads_;
  int threads_;
};

}  // namespace volcontact::adaptor
