// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>

namespace volcontact::test {

// Objects of tests compiled without sanitizers are linked with a core that has them, too.
#if defined(__SANITIZE_ADDRESS__)
inline const bool kSanitized = true;
#elif defined(__linux__)
extern "C" [[gnu::weak]] void __asan_init();
inline const bool kSanitized = &__asan_init != nullptr;
#else
inline const bool kSanitized = false;
#endif

/// How many cases to try. The sanitizers make each many times slower and look for other faults:
/// there fewer will do.
inline int cases(int all, int sanitized) { return kSanitized ? sanitized : all; }

/// The same of tests that take seconds: all in `./run soak`, which sets VOLCONTACT_SOAK.
inline int cases(int soak, int usual, int sanitized) {
  static const bool kSoaking = std::getenv("VOLCONTACT_SOAK") != nullptr;
  return cases(kSoaking ? soak : usual, sanitized);
}

}  // namespace volcontact::test
