// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/pair/lines.h"

namespace volcontact {

/// Memory of the search for the parts of an overlap outside of a bore.
struct BoreScratch {
  struct Place {
    double angle;  ///< about the middle of the overlap
    double rho;    ///< from the axis of the bore, in its radii
    Vec3 point;
  };
  std::vector<Place> outline;
  std::vector<double> breaks;
};

/// Regions of the overlap of two convex bodies outside of a bore, a tube (`bore`, in A's frame) cut
/// out of its owner. Adds them to `regions`; false when it cannot tell, as the overlap reaches past
/// the bore sideways. docs/theory.md, "Bores".
bool bored_lines(const ConvexView& a, const ConvexView& b, const Pose& X_AB, const RoundFace& bore,
                 const InterferenceOptions& options, LinesScratch& lines, BoreScratch& scratch,
                 LinesRegions& regions) noexcept;

}  // namespace volcontact
