// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/overlap.h"
#include "volcontact/pair/sections/section_region.h"
#include "volcontact/pair/sections/torus/torus_sites.h"
#include "volcontact/shape/torus.h"

namespace volcontact {

/// Memory of the engine for rings.
struct TorusSectionsScratch {
  SimdPath path = best_simd_path();
  FaceSet faces;
  TorusSection sections;
  TorusSites sites;
  std::vector<TorusExit> exits;
  std::vector<double> breaks, roots, angles, corners;
};

/// Where area vector and depth are taken from: a body without round faces gives them best by its
/// planes, but not when some of these are seams of a composed solid.
enum class TorusSurface { kBest, kTorus };

/// Regions of the overlap of a torus with a bounded convex body at the pose X in its frame, by
/// columns in half-planes through the axis of the torus. Adds them to `regions`, in the frame of
/// the torus, with the torus as A; one for every contact site. False where the surface it finds is
/// not closed, so that part of the overlap may be missed. docs/theory.md, "Tori".
bool add_torus_regions(const Torus& torus, const ConvexView& body, const Pose& X,
                       const InterferenceOptions& options, TorusSectionsScratch& scratch,
                       LinesRegions& regions, TorusSurface surface = TorusSurface::kBest);

/// Interference of a torus with a convex body: metrics in the frame of the torus. False as above.
bool torus_interference(const Torus& torus, const ConvexView& body, const Pose& X_AB,
                        const InterferenceOptions& options, TorusSectionsScratch& scratch,
                        LinesRegions& regions, Interference& out);

}  // namespace volcontact
