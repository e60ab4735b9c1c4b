// SPDX-License-Identifier: Apache-2.0
#pragma once

#ifdef _OPENMP
#include <omp.h>
#endif

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

#include "volcontact/base/first_failure.h"

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
/// of it: waking threads for every loop costs more than a loop of some ten microseconds. Each
/// thread has a share of a loop's tasks, one after the other in memory, and helps others from the
/// end of theirs when its own is done: so threads seldom write to the same cache lines. Which
/// thread does what is up to chance, so that the tasks must not depend on each other.
class ThreadTeam {
 public:
  /// Runs program() on the calling thread, with up to `threads` - 1 others at hand. What it or a
  /// task throws comes out of here.
  template <typename Program>
  void run(int threads, Program&& program) {
    if (threads <= 1) return program();
    shares_ = std::min(threads, kMostShares);
    for (int i = 0; i < shares_; ++i) share(i).done.store(0, std::memory_order_relaxed);
    handed_out_ = 0;
    closed_.store(false, std::memory_order_relaxed);
    open_ = true;
#pragma omp parallel num_threads(threads)
    {
      if (number() == 0) {
        failure_.guard(program);
        closed_.store(true, std::memory_order_release);
      } else {
        help();
      }
    }
    open_ = false;
    failure_.rethrow();
  }

  /// Whether others are at hand.
  bool open() const { return open_; }

  /// Number of the calling thread within the team.
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
    chunk_ = &chunk;
    call_ = [](const void* f, int k) { (*static_cast<const decltype(chunk)*>(f))(k); };
    hand_out((count + grain - 1) / grain);
    work();
    for (int waits = 0; done() != handed_out_; ++waits) wait(waits);
    failure_.rethrow();
  }

 private:
  static constexpr int kMostShares = 64;
  static constexpr int kSpins = 500;  // some ten microseconds; then others may have the core

  // What is left of a thread's chunks, [first, last), as two halves of one number: its owner takes
  // from the front, others from the back.
  struct alignas(64) Share {
    std::atomic<std::uint64_t> left = 0;
    std::atomic<unsigned> done = 0;  // chunks that this thread did since the run began
  };
  static std::uint64_t packed(std::uint64_t first, std::uint64_t last) {
    return last << 32 | first;
  }

  static void wait(int waits) {
    if (waits > kSpins) {
      std::this_thread::yield();
      return;
    }
#ifdef __x86_64__
    __builtin_ia32_pause();
#endif
  }

  void hand_out(int chunks) {
    handed_out_ += static_cast<unsigned>(chunks);
    const auto count = static_cast<std::uint64_t>(chunks);
    for (int i = 0; i < shares_; ++i) {
      share(i).left.store(packed(count * i / shares_, count * (i + 1) / shares_),
                          std::memory_order_release);
    }
    round_.fetch_add(1, std::memory_order_release);
  }

  unsigned done() const {
    unsigned sum = 0;
    for (int i = 0; i < shares_; ++i) {
      sum += share_[static_cast<std::size_t>(i)].done.load(std::memory_order_acquire);
    }
    return sum;
  }

  Share& share(int i) { return share_[static_cast<std::size_t>(i)]; }

  // Does a chunk of a share; false when none is left. Who has taken one keeps the loop from ending,
  // so that what the loop is stands still meanwhile.
  bool take(Share& from, Share& own) {
    std::uint64_t left = from.left.load(std::memory_order_acquire);
    std::uint64_t chunk, rest;
    do {
      const std::uint64_t first = left & 0xffffffff, last = left >> 32;
      if (first == last) return false;
      chunk = &from == &own ? first : last - 1;
      rest = &from == &own ? packed(first + 1, last) : packed(first, last - 1);
    } while (!from.left.compare_exchange_weak(left, rest, std::memory_order_acq_rel,
                                              std::memory_order_acquire));
    failure_.guard([&] { call_(chunk_, static_cast<int>(chunk)); });
    own.done.fetch_add(1, std::memory_order_release);
    return true;
  }

  // One's own share first, then those of the others, the next ones first.
  void work() {
    const int me = number() % shares_;
    for (int i = 0; i < shares_; ++i) {
      while (take(share((me + i) % shares_), share(me))) {
      }
    }
  }

  void help() {
    unsigned seen = 0;
    for (int waits = 0; !closed_.load(std::memory_order_acquire);) {
      const unsigned round = round_.load(std::memory_order_acquire);
      if (round == seen) {
        wait(waits++);
        continue;
      }
      seen = round;
      waits = 0;
      work();
    }
  }

  bool open_ = false;
  int shares_ = 1;
  unsigned handed_out_ = 0;  // chunks since the run began
  const void* chunk_ = nullptr;
  void (*call_)(const void*, int) = nullptr;
  std::atomic<bool> closed_ = true;
  alignas(64) std::atomic<unsigned> round_ = 0;  // loops so far
  std::array<Share, kMostShares> share_;
  FirstFailure failure_;
};

}  // namespace volcontact
