// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

/// With VOLCONTACT_SIMD_PORTABLE kernels are compiled once, which takes a third of the time.
#if defined(__x86_64__) && !defined(VOLCONTACT_SIMD_PORTABLE)
#define VOLCONTACT_SIMD_X86
#include <immintrin.h>
#endif

/// A function on vectors: inlined into the kernel that uses it, and compiled with it.
#define VOLCONTACT_SIMD_INLINE [[gnu::always_inline]] inline

namespace volcontact {

/// How many doubles a kernel works on at once, on every machine: see "simd_lanes.inc".
inline constexpr int kLanes = 8;

/// The instruction sets a kernel is compiled for, from the oldest to the newest.
enum class SimdPath : int { kPortable = 0, kAvx2 = 1, kAvx512 = 2 };

/// Whether this machine can run a path.
inline bool can_run(SimdPath path) noexcept {
#if defined(VOLCONTACT_SIMD_X86)
  if (path == SimdPath::kAvx2) return __builtin_cpu_supports("avx2");
  if (path == SimdPath::kAvx512) {
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
  }
#endif
  return path == SimdPath::kPortable;
}

/// The newest path of this machine.
inline SimdPath best_simd_path() noexcept {
  static const SimdPath best = can_run(SimdPath::kAvx512) ? SimdPath::kAvx512
                               : can_run(SimdPath::kAvx2) ? SimdPath::kAvx2
                                                          : SimdPath::kPortable;
  return best;
}

}  // namespace volcontact

/// Calls the function that "simd_paths.inc" compiled for a path.
#if defined(VOLCONTACT_SIMD_X86)
#define VOLCONTACT_SIMD_CALL(path, function, ...)                            \
  ((path) == ::volcontact::SimdPath::kAvx512 ? avx512::function(__VA_ARGS__) \
   : (path) == ::volcontact::SimdPath::kAvx2 ? avx2::function(__VA_ARGS__)   \
                                             : portable::function(__VA_ARGS__))
#else
#define VOLCONTACT_SIMD_CALL(path, function, ...) ((void)(path), portable::function(__VA_ARGS__))
#endif
