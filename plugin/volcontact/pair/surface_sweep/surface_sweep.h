// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/pair/overlap.h"
#include "volcontact/pair/sections/bore/composed_sections.h"
#include "volcontact/pair/sections/torus/torus_arcs.h"
#include "volcontact/pair/sections/torus/torus_exits.h"
#include "volcontact/pair/surface_sweep/sweep_patch.h"
#include "volcontact/pair/window/overlap_window.h"
#include "volcontact/shape/shapes.h"

namespace volcontact {

/// Memory of the search, reused from call to call; no value depends on what it holds.
struct SurfaceSweepScratch {
  CutPolytope hull, part;
  SweepSolids solids;
  std::vector<CurveFamily> families;
  std::vector<int> family_of;  ///< by face; -1 for none
  std::vector<SweepPatch> patches;
  SweepPatchScratch patch;
  SweepSurface surface;
  struct Region {
    SweepFlux flux[2];  ///< through the surface of A, of B
    double error = 0.0;
    int root = -1;
    int into = -1;      ///< the region it is counted with
    bool open = false;  ///< its surface has a gap
    bool part = false;  ///< no region of its own
    Aabb box;

    bool is_open(int self) const { return open && into == self; }
  };
  std::vector<Region> regions;
  std::vector<LinesPiece> pieces;
  TorusArcs arcs;
  FaceSet faces;
  std::vector<TorusExit> exits;
};

/// Interference of any two solids made of simple ones, from the surface of their overlap: metrics
/// in A's frame and about A's origin. False where it finds no overlap, or not all of its surface,
/// or where a solid is a mesh or a signed distance. docs/theory.md, "Surface sweep".
///
///   V = 1/3 int x . n dS = 1/3 sum over faces of int du int x . (x_u cross x_t) dt
/// over the stretches in t of the curves u of a face that bound the overlap
bool surface_sweep(const Shape& a, const Shape& b, const Pose& X_AB,
                   const InterferenceOptions& options, SurfaceSweepScratch& scratch,
                   Interference& out);

}  // namespace volcontact
