// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <utility>

namespace volcontact {

/// While it lives, long evaluations on this thread ask `check` now and then, some times a second,
/// whether to go on. It throws where they are not to; that comes out of the evaluation.
class InterruptScope {
 public:
  using Check = void (*)();

  explicit InterruptScope(Check check) : before_(std::exchange(current(), this)), check_(check) {}
  ~InterruptScope() { current() = before_; }
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;

  /// To be called by loops in which a round takes microseconds to milliseconds.
  static void poll() {
    if (InterruptScope* scope = current()) scope->ask();
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kPause{100};

  static InterruptScope*& current() {
    thread_local InterruptScope* scope = nullptr;
    return scope;
  }
  void ask() {
    const Clock::time_point now = Clock::now();
    if (now - last_ < kPause) return;
    last_ = now;
    check_();
  }

  InterruptScope* before_;
  Check check_;
  Clock::time_point last_ = Clock::now();
};

}  // namespace volcontact
