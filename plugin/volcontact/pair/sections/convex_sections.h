// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/pair/overlap.h"
#include "volcontact/pair/sections/section.h"
#include "volcontact/pair/sections/section_breaks.h"
#include "volcontact/pair/sections/section_region.h"
#include "volcontact/pair/window/convex_window.h"

namespace volcontact {

/// Memory of the lines engine, reused from call to call; no value depends on what it holds.
struct LinesScratch {
  /// A part of the rim of the overlap seen along the columns, as a quadratic arc through three
  /// places.
  struct Arc {
    Vec2 from, through, to;
    int depth;
  };
  SimdPath path = best_simd_path();
  LinesFaces faces;
  Sections sections;
  SectionBreaks breaks;
  std::vector<Vec2> corners;
  std::vector<Arc> arcs;
};

/// Interference of two convex solids of which at least one is round, by columns along the contact
/// normal: metrics in A's frame and about A's origin, one site. `volume_error` is an estimate, no
/// less than the surface found is from closed. False in a degenerate pose that it cannot make out,
/// or where the surface stays open. docs/theory.md, "Lines".
///
///   V = int dphi int rho (h_top - h_bottom) drho
/// over half-planes at the angle phi about a column inside, with rho the distance from it and h the
/// height along it: columns between A's face and B's.
bool lines_interference(const ConvexView& a, const ConvexView& b, const Pose& X_AB,
                        const InterferenceOptions& options, LinesScratch& scratch,
                        Interference& out);

/// Adds the overlap of two convex bodies that are pieces of solids, if there is one. False as
/// above.
bool add_lines_region(const ConvexView& a, const ConvexView& b, const Pose& X_AB,
                      const InterferenceOptions& options, LinesScratch& scratch,
                      LinesRegions& regions);

}  // namespace volcontact
