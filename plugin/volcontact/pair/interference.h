// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "volcontact/pair/engine.h"
#include "volcontact/pair/overlap.h"
#include "volcontact/shape/shapes.h"

namespace volcontact {

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

/// Whether `engine` can integrate this pair of shapes (in either order).
bool serves(Engine engine, const Shape& a, const Shape& b);

/// The engine kAuto stands for.
Engine engine_for(const Shape& a, const Shape& b);

/// Interference of A and B, in A's frame and about its origin. `X_AB` is the pose of B in A. A
/// non-finite pose gives Status::kInvalid, two unbounded solids Status::kUnbounded, a forced engine
/// that does not serve the pair falls back to kAuto (check with `serves` first). Throws
/// std::bad_alloc where the workspace has to grow and cannot, and nothing else.
/// The value depends on the arguments alone: no history, any thread count, the same bits.
void interference(const Shape& a, const Shape& b, const Pose& X_AB,
                  const InterferenceOptions& options, InterferenceWorkspace& workspace,
                  Interference& out);

}  // namespace volcontact
