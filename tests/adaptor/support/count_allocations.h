// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace volcontact::adaptor::testing {

/// Counts this thread's allocations, by whatever function, while it lives.
class AllocationCounter {
 public:
  AllocationCounter();
  ~AllocationCounter();
  AllocationCounter(const AllocationCounter&) = delete;
  AllocationCounter& operator=(const AllocationCounter&) = delete;

  static long total();
};

}  // namespace volcontact::adaptor::testing
