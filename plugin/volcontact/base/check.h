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

}  // namespace volcontact
