// SPDX-License-Identifier: Apache-2.0
#include "adaptor/support/count_allocations.h"

#include <cerrno>
#include <cstddef>

// The C library's own functions, under the names that stay when malloc is replaced.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}

namespace {

thread_local bool counting = false;
thread_local long allocations = 0;

void count() {
  if (counting) ++allocations;
}

}  // namespace

extern "C" {

void* malloc(std::size_t size) {
  count();
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) {
  count();
  return __libc_calloc(number, size);
}
void* realloc(void* old, std::size_t size) {
  count();
  return __libc_realloc(old, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  count();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** result, std::size_t alignment, std::size_t size) {
  count();
  *result = __libc_memalign(alignment, size);
  return *result ? 0 : ENOMEM;
}

}  // extern "C"

namespace volcontact::adaptor::testing {

AllocationCounter::AllocationCounter() { counting = true; }
AllocationCounter::~AllocationCounter() { counting = false; }
long AllocationCounter::total() { return allocations; }

}  // namespace volcontact::adaptor::testing
