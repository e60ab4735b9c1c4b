// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

/// A function on vectors: inlined into the kernel that uses it, and compiled with it.
#define VOLCONTACT_SIMD_INLINE [[gnu::always_inline]] inline

namespace volcontact {

/// Eight doubles, one a lane, with + - * / and comparisons lane by lane; `mask ? a : b` selects.
/// The compiler makes one, two or four instructions of each, whatever the machine has. All of them
/// are correctly rounded and none is contracted or reordered, so the bits are the same on every
/// machine.
using Vec8 = double __attribute__((vector_size(64), aligned(64)));
/// Result of a comparison: all bits of a lane set where true.
using Mask8 = long long __attribute__((vector_size(64), aligned(64)));

inline constexpr int kLanes = 8;

VOLCONTACT_SIMD_INLINE Vec8 splat(double x) { return Vec8{x, x, x, x, x, x, x, x}; }
VOLCONTACT_SIMD_INLINE Vec8 load(const double* x) {
  return Vec8{x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7]};
}
VOLCONTACT_SIMD_INLINE void store(Vec8 a, double* x) {
  for (int i = 0; i < kLanes; ++i) x[i] = a[i];
}
/// Lane by lane; a square root of a negative number is NaN.
VOLCONTACT_SIMD_INLINE Vec8 sqrt(Vec8 a) {
  Vec8 root;
  for (int i = 0; i < kLanes; ++i) root[i] = __builtin_sqrt(a[i]);
  return root;
}
/// The second argument where they do not compare, so that a bound drops a NaN in the first.
VOLCONTACT_SIMD_INLINE Vec8 max(Vec8 a, Vec8 b) { return a > b ? a : b; }
VOLCONTACT_SIMD_INLINE Vec8 min(Vec8 a, Vec8 b) { return a < b ? a : b; }
VOLCONTACT_SIMD_INLINE Vec8 max(Vec8 a, double b) { return max(a, splat(b)); }
VOLCONTACT_SIMD_INLINE Vec8 min(Vec8 a, double b) { return min(a, splat(b)); }
VOLCONTACT_SIMD_INLINE Vec8 abs(Vec8 a) {
  return reinterpret_cast<Vec8>(reinterpret_cast<Mask8>(a) & 0x7fffffffffffffffLL);
}
/// `a` where the mask is set: on the bits, which every machine can do.
VOLCONTACT_SIMD_INLINE Vec8 select(Mask8 where, Vec8 a, Vec8 b) {
  return reinterpret_cast<Vec8>((where & reinterpret_cast<Mask8>(a)) |
                                (~where & reinterpret_cast<Mask8>(b)));
}
VOLCONTACT_SIMD_INLINE Vec8 select(Mask8 where, Vec8 a, double b) {
  return select(where, a, splat(b));
}
VOLCONTACT_SIMD_INLINE bool any(Mask8 where) {
  using Mask4 = long long __attribute__((vector_size(32)));
  using Mask2 = long long __attribute__((vector_size(16)));
  const Mask4 half = __builtin_shufflevector(where, where, 0, 1, 2, 3) |
                     __builtin_shufflevector(where, where, 4, 5, 6, 7);
  const Mask2 quarter =
      __builtin_shufflevector(half, half, 0, 1) | __builtin_shufflevector(half, half, 2, 3);
  return (quarter[0] | quarter[1]) != 0;
}
/// In the order ((0 + 4) + (2 + 6)) + ((1 + 5) + (3 + 7)).
VOLCONTACT_SIMD_INLINE double sum(Vec8 a) {
  using Vec4 = double __attribute__((vector_size(32)));
  using Vec2 = double __attribute__((vector_size(16)));
  const Vec4 half =
      __builtin_shufflevector(a, a, 0, 1, 2, 3) + __builtin_shufflevector(a, a, 4, 5, 6, 7);
  const Vec2 quarter =
      __builtin_shufflevector(half, half, 0, 1) + __builtin_shufflevector(half, half, 2, 3);
  return quarter[0] + quarter[1];
}

/// The instruction sets a kernel is compiled for, from the oldest to the newest.
enum class SimdPath : int { kPortable = 0, kAvx2 = 1, kAvx512 = 2 };

/// Whether this machine can run a path.
inline bool can_run(SimdPath path) noexcept {
#if defined(__x86_64__)
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
#if defined(__x86_64__)
#define VOLCONTACT_SIMD_CALL(path, function, ...)                            \
  ((path) == ::volcontact::SimdPath::kAvx512 ? avx512::function(__VA_ARGS__) \
   : (path) == ::volcontact::SimdPath::kAvx2 ? avx2::function(__VA_ARGS__)   \
                                             : portable::function(__VA_ARGS__))
#else
#define VOLCONTACT_SIMD_CALL(path, function, ...) ((void)(path), portable::function(__VA_ARGS__))
#endif
