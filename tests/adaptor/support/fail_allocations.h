// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace volcontact::test {

/// While it lives, operator new gives so many pieces of memory more to all threads together, and
/// then throws std::bad_alloc. What the C library hands out by malloc is not touched.
class AllocationLimit {
 public:
  explicit AllocationLimit(long left);
  ~AllocationLimit();
  AllocationLimit(const AllocationLimit&) = delete;
  AllocationLimit& operator=(const AllocationLimit&) = delete;

  /// Whether one was refused.
  bool was_reached() const;
};

}  // namespace volcontact::test
