// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/interference.h"

namespace volcontact {

/// A solid fixed on body A and a solid fixed on body B.
struct GeometricPair {
  Shape a;
  Shape b;
  Pose X_Aa;  ///< pose of solid a in body A
  Pose X_Bb;  ///< pose of solid b in body B
};

/// Interference of the pair with the bodies at X_WA and X_WB, in world frame and about the world
/// origin. Computed in solid a's frame, so that far-away bodies cost no accuracy.
void interference_W(const GeometricPair& pair, const Pose& X_WA, const Pose& X_WB,
                    const InterferenceOptions& options, InterferenceWorkspace& workspace,
                    Interference& out);

}  // namespace volcontact
