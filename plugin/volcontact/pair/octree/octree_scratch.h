// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/base/thread_team.h"
#include "volcontact/pair/octree/cell_cut.h"
#include "volcontact/pair/octree/cell_sites.h"
#include "volcontact/pair/overlap.h"
#include "volcontact/pair/window/overlap_window.h"
#include "volcontact/pair/window/solid_view.h"

namespace volcontact {

/// Memory of the octree, reused from call to call; no value depends on what it holds.
struct OctreeScratch {
  /// A leaf, as far as the division goes by it: cells themselves are large, and half of them lie in
  /// the cache of another core. No leaf where `cell` is -1.
  struct Leaf {
    int cell;
    std::uint8_t split;
    double volume, low, high;
  };
  /// Where a new cell comes from.
  struct Birth {
    int parent;
    std::uint8_t child;  ///< which half of each axis, by bits
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
  /// Columns along the contact normal: what they start from, and how far they reach.
  struct Columns {
    struct Start {
      Vec3 p_W;
      double area;
    };
    std::vector<Start> starts;
    std::array<std::vector<RayInterval>, 2> within;  ///< of A and B
    std::vector<int> open;                           ///< columns whose end is not found yet
    std::vector<Vec3> points;
    std::vector<double> distances;
  };
  struct ColumnSum {
    double volume = 0.0, moment = 0.0;
    double depth = 0.0;  ///< length of the longest one
  };

  PieceList pieces_a, pieces_b;
  CutPolytope hull, part;
  std::vector<CellFace> faces;
  std::vector<Cell> cells;  ///< all cells ever made, in order; grown, never shrunk
  int cell_count = 0;
  std::vector<char> is_leaf;                ///< by cell: not divided, and perhaps not empty
  std::vector<Birth> births;                ///< of the cells of this round
  std::vector<Leaf> fresh;                  ///< what they came to
  std::vector<Leaf> pending, next_pending;  ///< leaves with a doubt about their volume
  std::vector<int> leaves;                  ///< by site
  std::vector<int> site_ends;
  SiteScratch sites;
  std::vector<int> sampled;  ///< cells that a field passes through, perhaps
  std::vector<Vec3> sample_points;
  std::vector<double> sample_values;
  std::vector<CellCut> cutters;  ///< one per thread
  std::vector<Columns> columns;  ///< one per thread
  std::vector<Totals> partial_totals;
  std::vector<ColumnSum> partial_columns;
  std::vector<double> partial_heights;
};

/// One question to the octree: the solids, where they overlap and how well it must be known.
struct OctreeTask {
  const SolidView& a;
  const SolidView& b;
  const OverlapWindow& window;
  double tolerance;
  int most_cells;
  int asked_threads;  ///< 0: by work
  int thread_limit;
  ThreadTeam& team;
  double scale = 0.0;     ///< size of the numbers that the faces are computed from [m]
  double rounding = 0.0;  ///< of a volume [m^3]

  const SolidView& solid(int owner) const { return owner == 0 ? a : b; }
  const Pose& X_SW(int owner) const { return owner == 0 ? window.X_AW : window.X_BW; }
  bool worth_sharing(int cells) const {
    constexpr int kWorthAsking = 8;     // cells, when the caller wants threads
    constexpr int kWorthThreads = 256;  // cells, when their number is our choice
    return thread_limit > 1 && cells >= (asked_threads == 0 ? kWorthThreads : kWorthAsking);
  }
  /// Number of the calling thread, below thread_limit; 0 for a caller that is one of many.
  int thread() const { return thread_limit == 1 ? 0 : ThreadTeam::number(); }
};

}  // namespace volcontact
