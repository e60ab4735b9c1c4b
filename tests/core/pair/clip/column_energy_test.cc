// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/clip/column_energy.h"

#include <gtest/gtest.h>

#include <vector>

namespace volcontact::column_energy_test {
namespace {

using Point = ColumnEnergy::Point;

const std::vector<Point> kSquare{{0, 0}, {1, 0}, {1, 1}, {0, 1}};

TEST(ColumnEnergy, OfASlabIsHalfItsThicknessSquaredTimesItsArea) {
  ColumnEnergy columns;
  columns.start(2);
  columns.add_upper({3.0, 0.0, 0.0}, false, kSquare);
  columns.add_lower(1, {1.0, 0.0, 0.0}, false, kSquare, std::vector<int>{});
  EXPECT_DOUBLE_EQ(columns.value(), 2.0);
}

TEST(ColumnEnergy, OfAWedgeIsTheIntegralOfTheSquare) {
  // L = u over the unit square: int u^2 / 2 = 1/6.
  ColumnEnergy columns;
  columns.start(2);
  columns.add_upper({0.0, 1.0, 0.0}, false, kSquare);
  columns.add_lower(1, {0.0, 0.0, 0.0}, false, kSquare, std::vector<int>{});
  EXPECT_NEAR(columns.value(), 1.0 / 6.0, 1e-16);
}

// The half u > 1/2 of a roof h = min(u, 1 - u), and a keel h = -min(v, 1 - v).
void add_half_of_roof_and_keel(ColumnEnergy& columns) {
  columns.add_upper({1.0, -1.0, 0.0}, false,
                    std::vector<Point>{{0.5, 0}, {1, 0}, {1, 1}, {0.5, 1}});
  columns.add_lower(2, {0.0, 0.0, -1.0}, false,
                    std::vector<Point>{{0, 0}, {1, 0}, {1, 0.5}, {0, 0.5}}, std::vector<int>{3});
  columns.add_lower(3, {-1.0, 0.0, 1.0}, false,
                    std::vector<Point>{{0, 0.5}, {1, 0.5}, {1, 1}, {0, 1}}, std::vector<int>{2});
}

TEST(ColumnEnergy, OverlaysUpperAndLowerFacesThatDoNotMatch) {
  // L of a roof over u and a keel over v is their sum:
  // int L^2/2 = 1/2 (2 <a^2> + 2 <a>^2) with <a> = 1/4, <a^2> = 1/12.
  ColumnEnergy columns;
  columns.start(4);
  columns.add_upper({0.0, 1.0, 0.0}, false, std::vector<Point>{{0, 0}, {0.5, 0}, {0.5, 1}, {0, 1}});
  add_half_of_roof_and_keel(columns);
  EXPECT_NEAR(columns.value(), 1.0 / 12.0 + 1.0 / 16.0, 1e-16);
}

TEST(ColumnEnergy, LiesUnderAPlaneByItsLengthTimesTheGap) {
  // Of the roof and the keel above, columns that end at 1 - u where u > 1/2, under the plane u:
  // int (2 u - 1) ((1 - u) + <a>) du = 1/24 + 1/16.
  ColumnEnergy columns;
  columns.start(4);
  add_half_of_roof_and_keel(columns);
  EXPECT_NEAR(columns.value_above({0.0, 1.0, 0.0}), 1.0 / 24.0 + 1.0 / 16.0, 1e-16);
}

TEST(ColumnEnergy, AnOverhangAddsLengthTimesReach) {
  // A block of height 1, its top at 1, sunk into a solid with the top min(1.5, 2 - u); the other
  // solid reaches 2 below the block's bottom.
  ColumnEnergy columns;
  columns.start(2);
  columns.add_upper({1.0, 0.0, 0.0}, true, kSquare);
  columns.add_lower(1, {0.0, 0.0, 0.0}, true, kSquare, std::vector<int>{});
  EXPECT_TRUE(columns.has_overhang());
  columns.add_ceiling({1.5, 0.0, 0.0});
  columns.add_ceiling({9.0, 0.0, 0.0});  // nowhere the lowest
  columns.add_ceiling({2.0, -1.0, 0.0});
  columns.add_floor({-2.0, 0.0, 0.0});
  // Over the top: 0.5 up to u = 1/2, then down to 0 at u = 1.
  EXPECT_NEAR(columns.value(), 0.5 + 2.0 + (0.25 + 0.125), 1e-15);
}

TEST(ColumnEnergy, AShortNoisyEdgeLosesNothing) {
  // Four faces of a keel that meet in one point, which rounding has split into two with an edge of
  // arbitrary direction. int L^2/2 of the pyramid of height 1 over the square (-1, 1)^2 = 1/3.
  const std::vector<Point> square{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  ColumnEnergy columns;
  columns.start(5);
  columns.add_upper({0.0, 0.0, 0.0}, false, square);
  const Point a(1e-17, -2e-17), b(-1e-17, 3e-17);
  columns.add_lower(1, {-1, 1, 0}, false, std::vector<Point>{{1, -1}, {1, 1}, b, a},
                    std::vector<int>{0, 2, 3, 4});
  columns.add_lower(2, {-1, 0, 1}, false, std::vector<Point>{{1, 1}, {-1, 1}, b},
                    std::vector<int>{0, 3, 1});
  columns.add_lower(3, {-1, -1, 0}, false, std::vector<Point>{{-1, 1}, {-1, -1}, a, b},
                    std::vector<int>{0, 4, 1, 2});
  columns.add_lower(4, {-1, 0, -1}, false, std::vector<Point>{{-1, -1}, {1, -1}, a},
                    std::vector<int>{0, 1, 3});
  EXPECT_NEAR(columns.value(), 1.0 / 3.0, 1e-15);
}

}  // namespace
}  // namespace volcontact::column_energy_test
