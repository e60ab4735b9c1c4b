// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace volcontact {

/// Counts and indices that are int, as those of MuJoCo, for the containers of the standard library.
inline std::size_t size(int count) { return static_cast<std::size_t>(count); }

}  // namespace volcontact
