// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "volcontact/pair/mesh_columns/column_sums.h"
#include "volcontact/pair/mesh_columns/crossing/crossing_patches.h"
#include "volcontact/pair/mesh_columns/sampled_columns.h"
#include "volcontact/pair/mesh_columns/surface_view.h"
#include "volcontact/pair/overlap.h"
#include "volcontact/shape/half_space.h"

namespace volcontact {

/// Memory of the columns engine, reused from call to call; no value depends on what it holds.
struct ColumnsScratch {
  CrossingScratch crossing;
  PatchScratch patches;
  CellScratch cells;
  RegionScratch regions;
  SampledScratch sampled;
  std::vector<CellSum> sums;
  SurfaceStore store[2];  ///< of A and B
  ColumnPrism prism;
  std::vector<int> crossing_parts[2];  ///< of A and of B, of the whole pair
  std::vector<int> crossing_here[2];   ///< of one patch
  std::vector<std::pair<int, int>> own_pairs;
  std::vector<char> own_regions;
  std::vector<int> slot_of_triangle;  ///< of B's tree
};

/// Interference of two solids bounded by closed triangle meshes, exact to rounding: metrics in A's
/// frame about A's origin. When the budget of cells ends first, sampled columns with
/// Status::kApproximate. docs/theory.md, "Columns".
///
///   V = sum over cells of +-int (z_B - z_A) dx dy
/// over what the projections of two triangles have in common: a polynomial over a polygon
void columns_interference(const SurfaceView& a, const SurfaceView& b, const Pose& X_AB,
                          const InterferenceOptions& options, ColumnsScratch& scratch,
                          Interference& out);

/// The same with the half-space z < 0 of B's frame.
void columns_interference(const SurfaceView& a, const HalfSpace& b, const Pose& X_AB,
                          const InterferenceOptions& options, ColumnsScratch& scratch,
                          Interference& out);

}  // namespace volcontact
