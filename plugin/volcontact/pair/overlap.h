// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/metrics/volume_metrics.h"
#include "volcontact/pair/engine.h"

namespace volcontact {

/// Budgets of the octree: 0.1 s on one core for a question of its own, 20 ms for a pair in a time
/// step that did not choose the octree.
inline constexpr int kMostCells = 60000;
inline constexpr int kMostCellsInStep = 10000;

struct InterferenceOptions {
  double tolerance = 1e-3;        ///< relative error asked of V [-]
  Engine engine = Engine::kAuto;  ///< kAuto picks per pair
  int threads = 1;                ///< for one pair; 0 = decide by work; never changes a bit
  /// Of the octree, or of columns. When they end before the tolerance is met, the status is
  /// kApproximate and volume_error the bound that was reached.
  int most_cells = kMostCells;
};

/// Overlap of two solids: the sum, and each connected region (contact site) apart.
struct Interference {
  VolumeMetrics total;
  std::vector<VolumeMetrics> sites;  ///< empty when apart
  Engine engine = Engine::kAuto;     ///< the engine that made the numbers
};

}  // namespace volcontact
