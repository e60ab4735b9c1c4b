// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace volcontact::test {

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

/// How many cases to try. The sanitizers make each many times slower and look for other faults:
/// there fewer will do.
constexpr int cases(int all, int sanitized) { return kSanitized ? sanitized : all; }

}  // namespace volcontact::test
