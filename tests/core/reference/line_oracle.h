// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/reference/implicit_solid.h"
#include "core/support/random.h"
#include "volcontact/base/fields.h"

namespace volcontact::test {

/// What even lattices of lines in three skew directions say about an overlap. Every direction gives
/// the numbers by itself; how much they differ is the error.
struct LineEstimate {
  double volume = 0.0, volume_error = 0.0;  ///< [m^3]
  Vec3 centroid = Vec3::Zero();             ///< in A's frame [m]
  double centroid_error = 0.0;
  Vec3 area_vector = Vec3::Zero();  ///< of A's surface inside B, outward, in A's frame [m^2]
  double share = 0.0;               ///< of the lines that met the overlap, least of the directions
  double extent = 0.0;              ///< half the diagonal of the box that was looked at [m]
};

/// The judge of the random search: it has no part of an engine and no formula of a shape. A cell
/// search in a frame of random rotation bounds the overlap by the distances that the implicit
/// functions keep from zero; lines through that box are summed, 610 a direction and seven times as
/// many at every further level.
class LineOracle {
 public:
  static constexpr int kLevels = 6;

  /// A and B, posed in A's frame, not both unbounded.
  LineOracle(const ImplicitSolid& a, const ImplicitSolid& b_A, std::uint64_t seed);

  /// The cells prove that the two have nothing in common.
  bool is_apart() const { return cells_.empty(); }
  /// Bounds from the cells alone.
  double least_volume() const { return least_volume_; }
  double most_volume() const { return most_volume_; }

  /// All lines of a level, from 0. The window narrows to what the lines of earlier calls hit where
  /// both solids are convex and many of the lines hit them.
  LineEstimate estimate(int level);

 private:
  struct Cell {
    Vec3 middle;
  };
  struct Sum {
    double volume = 0.0, flux = 0.0;
    int hits = 0;
    Vec3 first = Vec3::Zero();
    Vec3 low = Vec3::Constant(kInfinity), high = Vec3::Constant(-kInfinity);
  };

  void find_cells();
  bool is_empty(const Vec3& middle_F, double reach) const;
  Sum along(int axis, int level, Random& random);
  void add_common(int axis, const Vec3& o_F, double reach, Sum& sum) const;

  ImplicitSolid a_, b_;  // in A's frame
  Mat3 frame_;           // columns: the directions of the lines
  std::vector<Cell> cells_;
  Vec3 half_cell_ = Vec3::Zero();
  Vec3 low_ = Vec3::Zero(), high_ = Vec3::Zero();  // the box of the lines, in their frame
  double least_volume_ = 0.0, most_volume_ = 0.0;
  Random random_;
  LineParts in_a_, in_b_;  // of the line at hand
};

}  // namespace volcontact::test
