// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/interference.h"

namespace volcontact::test {

/// The interference of two solids in memory of its own.
inline Interference evaluated(const Shape& a, const Shape& b, const Pose& X_AB,
                              const InterferenceOptions& options = {}) {
  InterferenceWorkspace workspace;
  Interference result;
  interference(a, b, X_AB, options, workspace, result);
  return result;
}
inline Interference evaluated(const Shape& a, const Shape& b, const Pose& X_AB, Engine engine,
                              double tolerance = 1e-3) {
  return evaluated(a, b, X_AB, {.tolerance = tolerance, .engine = engine});
}

}  // namespace volcontact::test
