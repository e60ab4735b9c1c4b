// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace volcontact::adaptor {

/// MuJoCo's counts and indices, which are int, for the standard library's containers.
inline std::size_t size(int count) { return static_cast<std::size_t>(count); }

}  // namespace volcontact::adaptor
