// SPDX-License-Identifier: Apache-2.0
#include "adaptor/geoms/box_union.h"

#include <algorithm>
#include <tuple>

#include "volcontact/base/sizes.h"

namespace volcontact::adaptor {
namespace {

Aabb around(const Aabb& a, const Aabb& b) { return {a.min.cwiseMin(b.min), a.max.cwiseMax(b.max)}; }

// Whether the two overlap in more than a face, an edge or a corner.
bool overlap_along(const Aabb& a, const Aabb& b, int axis) {
  return std::min(a.max[axis], b.max[axis]) > std::max(a.min[axis], b.min[axis]);
}

bool meet_along(const Aabb& a, const Aabb& b, int axis) {
  return std::min(a.max[axis], b.max[axis]) >= std::max(a.min[axis], b.min[axis]);
}

}  // namespace

// Boxes with the same ends along both other axes, one after the other.
bool BoxUnion::join_along(int axis) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const auto key = [&](int i) {
    const Aabb& box = parts_[size(i)].within;
    return std::tuple{box.min[u], box.max[u], box.min[v], box.max[v]};
  };
  std::sort(order_.begin(), order_.end(), [&](int i, int j) {
    return std::tuple{key(i), parts_[size(i)].within.min[axis], i} <
           std::tuple{key(j), parts_[size(j)].within.min[axis], j};
  });
  std::size_t kept = 0;
  for (std::size_t next = 1; next < order_.size(); ++next) {
    Part& last = parts_[size(order_[kept])];
    Part& other = parts_[size(order_[next])];
    if (key(order_[kept]) == key(order_[next]) && meet_along(last.within, other.within, axis)) {
      last.within = around(last.within, other.within);
      last.whole = around(last.whole, other.whole);
      other.joined = order_[kept];
    } else {
      order_[++kept] = order_[next];
    }
  }
  const bool some = kept + 1 < order_.size();
  order_.resize(kept + 1);
  return some;
}

void BoxUnion::build(std::span<const Aabb> boxes, const Aabb& region) {
  region_ = region;
  parts_.clear();
  order_.clear();
  for (const Aabb& box : boxes) {
    const auto i = static_cast<int>(parts_.size());
    const Aabb within{box.min.cwiseMax(region.min), box.max.cwiseMin(region.max)};
    const bool is_inside = within.min.less_than(within.max);
    parts_.push_back({within, box, is_inside ? i : kOutside});
    if (is_inside) order_.push_back(i);
  }
  for (int idle = 0, axis = 0; idle < 3 && order_.size() > 1; axis = (axis + 1) % 3) {
    idle = join_along(axis) ? 0 : idle + 1;
  }
  std::sort(order_.begin(), order_.end());
  joined_.clear();
  for (const int i : order_) joined_.push_back(parts_[size(i)]);
  joined_of_.clear();
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    int root = static_cast<int>(i);
    while (root != kOutside && parts_[size(root)].joined != root) root = parts_[size(root)].joined;
    joined_of_.push_back(
        root == kOutside ? kOutside
                         : static_cast<int>(std::lower_bound(order_.begin(), order_.end(), root) -
                                            order_.begin()));
  }
}

bool BoxUnion::may_join_in_less() const {
  const auto share_plane = [&](const Aabb& a, const Aabb& b, int axis) {
    return (a.min[axis] == b.min[axis] && a.min[axis] > region_.min[axis]) ||
           (a.max[axis] == b.max[axis] && a.max[axis] < region_.max[axis]);
  };
  for (std::size_t i = 0; i < joined_.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Aabb& a = joined_[i].within;
      const Aabb& b = joined_[j].within;
      for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        if (meet_along(a, b, axis) && overlap_along(a, b, u) && overlap_along(a, b, v) &&
            (share_plane(a, b, u) || share_plane(a, b, v))) {
          return true;
        }
      }
    }
  }
  return false;
}

}  // namespace volcontact::adaptor
