// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/mesh_columns/column_cells.h"
#include "volcontact/pair/mesh_columns/in_round/round_pieces.h"
#include "volcontact/pair/mesh_columns/in_round/round_rims.h"
#include "volcontact/pair/mesh_columns/in_round/round_sums.h"
#include "volcontact/pair/mesh_columns/in_round/star_sums.h"
#include "volcontact/pair/mesh_columns/surface_view.h"
#include "volcontact/pair/overlap.h"

namespace volcontact {

/// Memory of the columns over round solids, reused from call to call; no value depends on it.
struct RoundColumnsScratch {
  FaceSet faces;
  RoundSearchScratch search;
  RoundPieces pieces;
  struct Patch {
    MomentSum moments;  ///< of what lies below it, in Q
    double depth_moment, depth, volume_error;
    bool deep;  ///< its depth is that of a layer as thick everywhere
    int first_triangle, last_triangle, first_sliver, last_sliver;
  };
  std::vector<Patch> patches;
  std::vector<int> triangle_order, sliver_order, starts;
  std::vector<RoundPieces::Triangle> pieces_of_patch, parts, divided;
  std::vector<RimExcess> excess;
  std::vector<RoundPieces::Sliver> slivers_of_patch;
  StarScratch star;
  RoundTriangles triangles;
  RoundPoints points;
  CellScratch cells;
};

/// Interference of a closed triangle mesh and a convex solid with a round face, by columns from the
/// triangles inside of B down to B's exact surface, or away from a point where no direction sees a
/// patch whole: metrics in A's frame about A's origin. False when there are more triangles than the
/// budget. docs/theory.md, "Columns over round solids".
bool round_columns(const SurfaceView& a, const ConvexView& b, const Pose& X_AB,
                   const InterferenceOptions& options, RoundColumnsScratch& scratch,
                   Interference& out);

}  // namespace volcontact
