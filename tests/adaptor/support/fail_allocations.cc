// SPDX-License-Identifier: Apache-2.0
#include "adaptor/support/fail_allocations.h"

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <new>
#ifdef _WIN32
#include <malloc.h>
#endif

namespace {

// Windows keeps what is aligned apart from the rest, also where it is given back.
void* aligned(std::size_t size, std::size_t alignment) {
#ifdef _WIN32
  return _aligned_malloc(size, alignment);
#else
  return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
#endif
}
void free_aligned(void* p) {
#ifdef _WIN32
  _aligned_free(p);
#else
  std::free(p);
#endif
}

constexpr long kNone = std::numeric_limits<long>::max() / 2;
std::atomic<long> left{kNone};

void* take(std::size_t size) {
  if (left.fetch_sub(1, std::memory_order_relaxed) > 0) {
    if (void* p = std::malloc(size > 0 ? size : 1)) return p;
  }
  throw std::bad_alloc();
}
void* take(std::size_t size, std::size_t alignment) {
  if (left.fetch_sub(1, std::memory_order_relaxed) > 0) {
    if (void* p = aligned(size, alignment)) return p;
  }
  throw std::bad_alloc();
}

}  // namespace

// Not inlined: the compiler would take the free() here for a mismatch with the new there.
[[gnu::noinline]] void* operator new(std::size_t size) { return take(size); }
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  return take(size, static_cast<std::size_t>(alignment));
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::align_val_t) noexcept { free_aligned(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  free_aligned(p);
}

namespace volcontact::test {

AllocationLimit::AllocationLimit(long count) { left = count; }
AllocationLimit::~AllocationLimit() { left = kNone; }
bool AllocationLimit::was_reached() const { return left < 0; }

}  // namespace volcontact::test
