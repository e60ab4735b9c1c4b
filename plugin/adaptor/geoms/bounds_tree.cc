// SPDX-License-Identifier: Apache-2.0
#include "adaptor/geoms/bounds_tree.h"

#include <algorithm>
#include <numeric>

namespace volcontact::adaptor {

void BoundsTree::build(const std::vector<Bounds>& boxes) {
  boxes_ = boxes;
  for (Bounds& box : boxes_) {
    for (int i = 0; i < 3; ++i) {
      const double low = box.low(i), high = box.high(i);
      if (low - low == 0.0 && high - high == 0.0) continue;
      box.set(i, -kInfinity, -kInfinity);
    }
  }
  order_.resize(boxes.size());
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.clear();
  if (!boxes.empty()) split(0, static_cast<std::int32_t>(boxes.size()));
}

void BoundsTree::split(std::int32_t first, std::int32_t last) {
  const auto box_at = [this](std::int32_t i) -> const Bounds& {
    return boxes_[static_cast<std::size_t>(order_[static_cast<std::size_t>(i)])];
  };
  const std::size_t index = nodes_.size();
  Node& node = nodes_.emplace_back(Node{box_at(first), first, last});
  Bounds begins = box_at(first);  // of the lower ends, whose spread chooses the axis
  for (int i = 0; i < 3; ++i) begins.set(i, begins.low(i), -begins.low(i));
  for (std::int32_t i = first + 1; i < last; ++i) {
    Bounds begin = box_at(i);
    node.box.add(begin);
    for (int k = 0; k < 3; ++k) begin.set(k, begin.low(k), -begin.low(k));
    begins.add(begin);
  }
  if (last - first <= kLeaf) return;
  int axis = 0;
  double widest = -1.0;
  for (int k = 0; k < 3; ++k) {
    const double width = begins.high(k) - begins.low(k);
    if (width > widest) widest = width, axis = k;
  }
  const std::int32_t middle = first + (last - first) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                   [&](std::int32_t i, std::int32_t j) {
                     const double a = boxes_[static_cast<std::size_t>(i)].low(axis);
                     const double b = boxes_[static_cast<std::size_t>(j)].low(axis);
                     return a != b ? a < b : i < j;
                   });
  split(first, middle);
  nodes_[index].right = static_cast<std::int32_t>(nodes_.size());
  split(middle, last);
}

}  // namespace volcontact::adaptor
