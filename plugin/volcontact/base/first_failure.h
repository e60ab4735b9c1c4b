// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <exception>
#include <utility>

namespace volcontact {

/// The first exception of some threads that share work. None may leave an OpenMP region by itself:
/// that ends the program.
class FirstFailure {
 public:
  /// Runs a part of the work in any thread; none after a failure, which may have left the memory of
  /// its thread half grown.
  template <typename Work>
  void guard(Work&& work) noexcept {
    if (taken_.load(std::memory_order_acquire)) return;
    try {
      work();
    } catch (...) {
      if (!taken_.exchange(true, std::memory_order_acq_rel)) first_ = std::current_exception();
    }
  }

  /// Throws what was kept, once the threads have met.
  void rethrow() {
    if (!taken_.exchange(false, std::memory_order_acq_rel)) return;
    std::rethrow_exception(std::exchange(first_, nullptr));
  }

 private:
  std::atomic<bool> taken_ = false;
  std::exception_ptr first_;
};

}  // namespace volcontact
