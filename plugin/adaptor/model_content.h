// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "adaptor/content_copy.h"
#include "adaptor/keys/scene_keys.h"

namespace volcontact::adaptor {

/// Some neighbouring geoms or bodies.
struct IndexSpan {
  int first, count;
};

/// A copy of the parts of an mjModel on which volcontact's reading of it depends. Models are known
/// by content: an address says nothing, since MuJoCo copies models (Batch) and memory is reused.
class ModelContent {
 public:
  /// `flush`: geoms that were found to continue each other.
  ModelContent(const mjModel* m, const SceneKeys& keys,
               const std::vector<std::vector<int>>& flush = {});

  /// Names, bodies and tuples are the same: `m` is this model or a copy of it.
  bool is_same_model(const mjModel* m) const noexcept;

  /// And so are the numbers that may be changed in a compiled model: our numerics, the sizes,
  /// friction, types and masks of the geoms, and how the geoms of a composed solid or of flush
  /// solids stand to each other. Only to be asked when is_same_model().
  bool has_same_values(const mjModel* m) const noexcept;

 private:
  std::vector<NumericSpan> numerics_;
  std::vector<IndexSpan> parts_;   // geoms of composed solids, and flush ones
  std::vector<IndexSpan> bodies_;  // bodies of flush geoms, and those that these are fixed to
  ContentCopy structure_, values_;
};

}  // namespace volcontact::adaptor
