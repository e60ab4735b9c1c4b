// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/pair/sections/bore/bore_outline.h"
#include "volcontact/pair/sections/section_region.h"

namespace volcontact {

/// Two convex bodies and a bore (all in A's frame) that is cut out of one of them.
struct BoredBodies {
  const ConvexView& a;
  const ConvexView& b;
  const Pose& X_AB;
  const Bore& bore;
  Owner owner;
  const FaceSet& faces;  ///< of both
};

/// Memory of the search for a film.
struct WallFilmScratch {
  std::vector<double> angles, depths;  ///< about the axis, and how thick the film is there
  struct Dip {
    double angle;
    bool parts;  ///< the film in two
  };
  std::vector<Dip> dips;
};

/// Whether a body fits the bore so closely that an overlap, which reaches `depth` out of its wall
/// [m] over about `length` along it, is to be measured across the wall: next to nothing, or with a
/// face that leans against the wall by next to nothing. Sections along the bore take such a face to
/// be parallel to it, or see its silhouette at heights that are mostly rounding.
bool is_wall_film(const FaceSet& faces, const Bore& bore, double depth, double length);

/// The regions of an overlap that lies on the wall of a bore like a film, much wider than thick:
/// its thickness is that of rays across the wall. `places` are of its outline, if any. With theta
/// about the axis, h along it, r the wall and d the thickness across the axis
///
///   V = int int (r + d/2) d dh dtheta
///
/// False where the overlap is none: an edge, say, that reaches out of the wall as far as it is
/// wide. docs/theory.md, "Bores".
bool add_wall_film(const BoredBodies& bodies, const Vec3& middle,
                   const std::vector<BoreOutline::Place>& places,
                   const InterferenceOptions& options, WallFilmScratch& scratch,
                   LinesRegions& regions);

}  // namespace volcontact
