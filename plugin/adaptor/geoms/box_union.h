// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "volcontact/shape/solid.h"

namespace volcontact::adaptor {

/// Which boxes with common axes make one box together, as far as a region is concerned: tiles of a
/// floor under a body that stands on some of them. Two are joined where they meet or overlap along
/// one axis and have the same ends along the two others, once both are cut to the region; so on
/// until no two are left. Ends are compared exactly. Memory is reused from call to call.
class BoxUnion {
 public:
  static constexpr int kOutside = -1;  ///< of a box that has no part in the region

  /// `region` may be unbounded.
  void build(std::span<const Aabb> boxes, const Aabb& region);

  /// How many boxes the union consists of.
  int count() const { return static_cast<int>(joined_.size()); }
  /// The joined box that the given box `i` is part of, or kOutside.
  int of(std::size_t i) const { return joined_of_[i]; }
  /// A joined box; beyond the region as far as any of its boxes reaches.
  const Aabb& box(int joined) const { return joined_[static_cast<std::size_t>(joined)].whole; }

  /// Whether there are joined boxes that share a part of a face and a plane that goes on across it,
  /// both within the region: in a smaller region they may make one box.
  bool may_join_in_less() const;

 private:
  struct Part {
    Aabb within;  // cut to the region
    Aabb whole;
    int joined;  // the part that it became part of; itself where it stands
  };
  bool join_along(int axis);

  Aabb region_{Vec3::Zero(), Vec3::Zero()};
  std::vector<Part> parts_;
  std::vector<int> order_;
  std::vector<Part> joined_;
  std::vector<int> joined_of_;
};

}  // namespace volcontact::adaptor
