// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "volcontact/metrics/volume_metrics.h"
#include "volcontact/pair/engine.h"
#include "volcontact/shape/shapes.h"

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

/// Scratch memory of the engines, reused from call to call so that a warm evaluation allocates
/// nothing. One per thread; holds no state that could change a value.
class InterferenceWorkspace {
 public:
  InterferenceWorkspace();
  ~InterferenceWorkspace();
  InterferenceWorkspace(InterferenceWorkspace&&) noexcept;
  InterferenceWorkspace& operator=(InterferenceWorkspace&&) noexcept;

  struct Scratch;
  Scratch& scratch() { return *scratch_; }

 private:
  std::unique_ptr<Scratch> scratch_;
};

/// Overlap of two solids: the sum, and each connected region (contact site) apart.
struct Interference {
  VolumeMetrics total;
  std::vector<VolumeMetrics> sites;  ///< empty when apart
  Engine engine = Engine::kAuto;     ///< the engine that made the numbers
};

/// Whether `engine` can integrate this pair of shapes (in either order).
bool serves(Engine engine, const Shape& a, const Shape& b);

/// The engine kAuto stands for.
Engine engine_for(const Shape& a, const Shape& b);

/// Interference of A and B, in A's frame and about its origin. `X_AB` is the pose of B in A. Never
/// throws: a non-finite pose gives Status::kInvalid, two unbounded solids Status::kUnbounded, a
/// forced engine that does not serve the pair falls back to kAuto (check with `serves` first).
/// The value depends on the arguments alone: no history, any thread count, the same bits.
void interference(const Shape& a, const Shape& b, const Pose& X_AB,
                  const InterferenceOptions& options, InterferenceWorkspace& workspace,
                  Interference& out) noexcept;

}  // namespace volcontact
