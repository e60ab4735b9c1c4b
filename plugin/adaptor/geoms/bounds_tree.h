// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "adaptor/geoms/bounds.h"

namespace volcontact::adaptor {

/// Which of many boxes are not apart from one more: a binary tree of boxes around boxes, for boxes
/// that stay while others move. Halves are those below and above the middle one along the axis on
/// which the boxes are spread most.
class BoundsTree {
 public:
  /// Over boxes 0 to n - 1; ends that are no numbers count as infinite.
  void build(const std::vector<Bounds>& boxes);

  /// Calls `visit(i)` for each box whose bounds may meet the given ones; in no order that matters.
  template <typename Visit>
  void find(const Bounds& with, Visit&& visit) const {
    if (nodes_.empty()) return;
    std::int32_t open[kDeepest];
    int count = 0;
    open[count++] = 0;
    while (count > 0) {
      const Node& node = nodes_[static_cast<std::size_t>(open[--count])];
      if (are_apart(node.box, with)) continue;
      if (node.right < 0) {
        for (std::int32_t i = node.first; i < node.last; ++i) {
          visit(order_[static_cast<std::size_t>(i)]);
        }
        continue;
      }
      open[count++] = node.right;
      open[count++] = static_cast<std::int32_t>(&node - nodes_.data()) + 1;
    }
  }

 private:
  // The left half follows its parent.
  struct Node {
    Bounds box;
    std::int32_t first, last;  // of `order_`
    std::int32_t right = -1;   // -1: a leaf
  };
  static constexpr int kLeaf = 4, kDeepest = 64;
  void split(std::int32_t first, std::int32_t last);

  std::vector<Node> nodes_;
  std::vector<std::int32_t> order_;
  std::vector<Bounds> boxes_;
};

}  // namespace volcontact::adaptor
