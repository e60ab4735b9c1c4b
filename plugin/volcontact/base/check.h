// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace volcontact {

/// Throws std::invalid_argument with `message` unless `condition` holds. For the boundary only:
/// the evaluation path never throws.
inline void require(bool condition, const std::string& message) {
  if (!condition) throw std::invalid_argument(message);
}

/// The same for a message without numbers in it: no string is made where the condition holds.
inline void require(bool condition, const char* message) {
  if (!condition) throw std::invalid_argument(message);
}

}  // namespace volcontact
