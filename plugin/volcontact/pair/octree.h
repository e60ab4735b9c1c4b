// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/pair/cell_cut.h"
#include "volcontact/pair/interference.h"
#include "volcontact/pair/solid_view.h"

namespace volcontact {

/// Memory of the octree, reused from call to call; no value depends on what it holds.
struct OctreeScratch {
  /// A leaf that still has a doubt about its volume.
  struct Pending {
    int cell;
    double volume, low, high;
  };
  /// Sums over cells, about the origin of W.
  struct Totals {
    double volume = 0.0, low = 0.0, high = 0.0;
    Vec3 first = Vec3::Zero();
    Mat3 second = Mat3::Zero();
    std::array<CellSums::Surface, 2> surface;
    std::array<double, 2> doubt = {0.0, 0.0};
    Totals& operator+=(const Totals& other);
  };

  struct Columns {
    double volume = 0.0, moment = 0.0;
    Columns& operator+=(const Columns& other) {
      volume += other.volume;
      moment += other.moment;
      return *this;
    }
  };

  PieceList pieces_a, pieces_b;
  CutPolytope hull, part;
  std::vector<CellFace> faces;
  std::vector<Cell> cells;  ///< all cells ever made, in order; grown, never shrunk
  int cell_count = 0;
  std::vector<Pending> pending, next_pending;
  std::vector<int> leaves;
  std::vector<CellCut> cutters;  ///< one per thread
  std::vector<Totals> partial_totals;
  std::vector<Columns> partial_columns;
  std::vector<int> site_of, order;
};

/// Interference of A and B by recursive cells, for any two solids of which at least one is bounded:
/// metrics in A's frame about A's origin. `options.tolerance` is met by the certified bound of V
/// (Status::kApproximate when the budget of cells ends first); for a solid that has neither pieces
/// nor curvature_bound it is met by an estimate. docs/theory.md, "Octree".
void octree_interference(const Shape& a, const Shape& b, const Pose& X_AB,
                         const InterferenceOptions& options, OctreeScratch& scratch,
                         Interference& out) noexcept;

/// The same for solids of any type: octree_interference(view_of(solid), ...).
void octree_interference(const SolidView& a, const SolidView& b, const Pose& X_AB,
                         const InterferenceOptions& options, OctreeScratch& scratch,
                         Interference& out) noexcept;

}  // namespace volcontact
