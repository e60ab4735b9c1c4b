// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/pair/sections/bore/bore_outline.h"
#include "volcontact/pair/sections/bore/wall_film.h"

namespace volcontact {

/// Memory of the search for the parts of an overlap outside of a bore.
struct BoreScratch {
  std::vector<BoreOutline::Place> outline;
  std::vector<double> breaks;
  FaceSet body;
  WallFilmScratch film;
};

/// Regions of the overlap of two convex bodies outside of a bore, a tube (`bore`, in A's frame) cut
/// out of its owner. Adds them to `regions`; false when it cannot tell, as the overlap reaches past
/// the bore sideways. docs/theory.md, "Bores".
///
///   V = int dphi int (h_top - h_bottom) rho drho over rho > r,   r the wall of the tube
bool bored_lines(const ConvexView& a, const ConvexView& b, const Pose& X_AB, const Bore& bore,
                 Owner owner, const InterferenceOptions& options, LinesScratch& lines,
                 BoreScratch& scratch, LinesRegions& regions);

}  // namespace volcontact
