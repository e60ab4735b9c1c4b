// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "volcontact/shape/shapes.h"

namespace volcontact::adaptor {

/// Bounds along x, y and z, in both orders: two boxes are compared by adding one to the other's
/// reverse.
struct Bounds {
  using Two [[gnu::vector_size(16)]] = double;
  std::array<Two, 3> ends;     ///< min, -max
  std::array<Two, 3> reverse;  ///< -max, min

  double low(int axis) const noexcept { return ends[static_cast<std::size_t>(axis)][0]; }
  double high(int axis) const noexcept { return -ends[static_cast<std::size_t>(axis)][1]; }

  void set(int axis, double min, double minus_max) noexcept {
    ends[static_cast<std::size_t>(axis)] = Two{min, minus_max};
    reverse[static_cast<std::size_t>(axis)] = Two{minus_max, min};
  }

  /// Grows to hold another.
  void add(const Bounds& other) noexcept {
    for (int i = 0; i < 3; ++i) {
      const Two theirs = other.ends[static_cast<std::size_t>(i)];
      const Two ours = ends[static_cast<std::size_t>(i)];
      set(i, theirs[0] < ours[0] ? theirs[0] : ours[0], theirs[1] < ours[1] ? theirs[1] : ours[1]);
    }
  }
};

/// Apart along an axis when min_a >= max_b or min_b >= max_a. Comparisons with NaN are false, so
/// that a pose that is no number reaches the engine, which reports it.
inline bool are_apart(const Bounds& a, const Bounds& b) noexcept {
  const auto apart = (a.ends[0] + b.reverse[0] >= 0.0) | (a.ends[1] + b.reverse[1] >= 0.0) |
                     (a.ends[2] + b.reverse[2] >= 0.0);
  return (apart[0] | apart[1]) != 0;
}

/// Not where a number is NaN.
inline bool are_within(const Bounds& inner, const Bounds& outer) noexcept {
  const auto within = (inner.ends[0] >= outer.ends[0]) & (inner.ends[1] >= outer.ends[1]) &
                      (inner.ends[2] >= outer.ends[2]);
  return (within[0] & within[1]) != 0;
}

/// Of a solid at a pose, in the world.
inline Bounds world_bounds(const Shape& solid, const Pose& X_WG) {
  return std::visit(
      [&](const auto& s) {
        Bounds box;
        for (int i = 0; i < 3; ++i) {
          const Vec3 axis = X_WG.rotation.row(i);
          // With -max instead of max both ends are lower bounds of the same kind.
          box.set(i, X_WG.translation[i] - s.support_height(-axis),
                  -X_WG.translation[i] - s.support_height(axis));
        }
        return box;
      },
      solid);
}

}  // namespace volcontact::adaptor
