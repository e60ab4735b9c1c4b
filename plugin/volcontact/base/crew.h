// SPDX-License-Identifier: Apache-2.0
#pragma once

#ifdef _OPENMP
#include <omp.h>
#endif

#include <algorithm>
#include <atomic>
#include <thread>

namespace volcontact {

/// Threads that a call may use when `asked` for so many, 0 for as many as there are: one where
/// others already share the work.
inline int thread_limit(int asked) {
#ifdef _OPENMP
  if (omp_in_parallel()) return 1;
  return asked > 0 ? asked : omp_get_max_threads();
#else
  return (void)asked, 1;
#endif
}

/// Threads that stay awake through one program and share its loops. One parallel region holds all
/// of it: waking threads for every loop costs more than a loop of some ten microseconds. Which
/// thread does what is up to chance, so that the tasks must not depend on each other.
class Crew {
 public:
  /// Runs program() on the calling thread, with up to `threads` - 1 others at hand.
  template <typename Program>
  void run(int threads, Program&& program) {
    if (threads <= 1) return program();
    closed_.store(false, std::memory_order_relaxed);
    open_ = true;
#pragma omp parallel num_threads(threads)
    {
      if (number() == 0) {
        program();
        closed_.store(true, std::memory_order_release);
      } else {
        help();
      }
    }
    open_ = false;
  }

  /// Whether others are at hand.
  bool open() const { return open_; }

  /// Number of the calling thread within the crew.
  static int number() {
#ifdef _OPENMP
    return omp_get_thread_num();
#else
    return 0;
#endif
  }

  /// Calls task(i) once for every i in [0, count), in any order; a thread takes `grain` tasks at a
  /// time. To be called by the program that run() runs, or alone.
  template <typename Task>
  void for_each(int count, int grain, Task&& task) {
    if (!open_ || count <= grain) {
      for (int i = 0; i < count; ++i) task(i);
      return;
    }
    const auto chunk = [&](int k) {
      const int last = std::min(count, (k + 1) * grain);
      for (int i = k * grain; i < last; ++i) task(i);
    };
    chunks_ = (count + grain - 1) / grain;
    chunk_ = &chunk;
    call_ = [](const void* f, int k) { (*static_cast<const decltype(chunk)*>(f))(k); };
    done_.store(0, std::memory_order_relaxed);
    left_.store(chunks_, std::memory_order_release);
    while (work()) {
    }
    for (int waits = 0; done_.load(std::memory_order_acquire) < chunks_; ++waits) wait(waits);
  }

 private:
  static constexpr int kSpins = 500;  // some ten microseconds; then others may have the core

  static void wait(int waits) {
    if (waits > kSpins) {
      std::this_thread::yield();
      return;
    }
#ifdef __x86_64__
    __builtin_ia32_pause();
#endif
  }

  // Does one chunk; false when none is left. Who has taken one keeps the loop from ending, so that
  // what the loop is stands still meanwhile.
  bool work() {
    int left = left_.load(std::memory_order_acquire);
    do {
      if (left == 0) return false;
    } while (!left_.compare_exchange_weak(left, left - 1, std::memory_order_acq_rel,
                                          std::memory_order_acquire));
    call_(chunk_, chunks_ - left);
    done_.fetch_add(1, std::memory_order_release);
    return true;
  }

  void help() {
    int waits = 0;
    while (!closed_.load(std::memory_order_acquire)) {
      if (work()) {
        waits = 0;
      } else {
        wait(waits++);
      }
    }
  }

  bool open_ = false;
  int chunks_ = 0;
  const void* chunk_ = nullptr;
  void (*call_)(const void*, int) = nullptr;
  std::atomic<bool> closed_ = true;
  alignas(64) std::atomic<int> left_ = 0;  // chunks that nobody has taken yet
  alignas(64) std::atomic<int> done_ = 0;
};

}  // namespace volcontact
