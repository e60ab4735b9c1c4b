// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/octree/cell_sites.h"

#include <gtest/gtest.h>

#include <numeric>

namespace volcontact::cell_sites_test {
namespace {

constexpr double kRounding = 1e-9;  // of a volume

// Cubes of edge 2 full of volume, unless told otherwise.
Cell cube(double x, double y, double z, double volume = 8.0, double low = 8.0) {
  Cell cell;
  cell.center = Vec3(x, y, z);
  cell.half = Vec3::Ones();
  cell.sums.volume = volume;
  cell.low = low;
  cell.high = 8.0;
  cell.content_low = -cell.half;
  cell.content_high = cell.half;
  return cell;
}

struct Sorted {
  std::vector<int> leaves, ends;
};
Sorted sorted(const std::vector<Cell>& cells) {
  Sorted s;
  SiteScratch scratch;
  s.leaves.resize(cells.size());
  std::iota(s.leaves.begin(), s.leaves.end(), 0);
  ThreadTeam alone;
  sort_by_site(alone, cells, 1e-12, kRounding, s.leaves, s.ends, scratch);
  return s;
}

TEST(SortBySite, NeighboursBelongTogetherAndOthersDoNot) {
  const Sorted s = sorted({cube(0, 0, 0), cube(10, 0, 0), cube(2, 0, 0), cube(10, 2, 0)});
  EXPECT_EQ(s.leaves, (std::vector<int>{0, 2, 1, 3}));
  EXPECT_EQ(s.ends, (std::vector<int>{2, 4}));
}

TEST(SortBySite, AnEdgeOrACornerInCommonIsNotEnough) {
  EXPECT_EQ(sorted({cube(0, 0, 0), cube(2, 2, 0)}).ends.size(), 2u);
  EXPECT_EQ(sorted({cube(0, 0, 0), cube(2, 2, 2)}).ends.size(), 2u);
  EXPECT_EQ(sorted({cube(0, 0, 0), cube(2, 1, 1)}).ends.size(), 1u);
}

TEST(SortBySite, CellsWithoutVolumeDoNotConnect) {
  const Sorted s = sorted({cube(0, 0, 0), cube(2, 0, 0, 0.0, 0.0), cube(4, 0, 0)});
  EXPECT_EQ(s.ends.size(), 2u);
  EXPECT_EQ(s.ends.back(), 3);
}

// Neighbours of which one is filled only in part, away from the other.
TEST(SortBySite, ContentsAreWhatTouches) {
  std::vector<Cell> cells = {cube(0, 0, 0), cube(2, 0, 0)};
  cells[1].content_low.x() = 0.5;
  EXPECT_EQ(sorted(cells).ends.size(), 2u);
  cells[0].content_high.x() = 0.5;  // overlapping cells, of two pieces
  cells[1].center.x() = 0.0;
  EXPECT_EQ(sorted(cells).ends.size(), 1u);
}

// Its volume may be an error of the estimate: it goes with the nearest region, not the first.
TEST(SortBySite, ASpeckGoesWithTheNearestRegion) {
  const Sorted s = sorted({cube(0, 0, 0), cube(20, 0, 0), cube(15, 0, 0, 1e-3, 0.0)});
  EXPECT_EQ(s.leaves, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(s.ends, (std::vector<int>{1, 3}));
}

// Nor does it count that some of its volume is called certain.
TEST(SortBySite, ASpeckOfRoundingIsNoSite) {
  EXPECT_EQ(sorted({cube(0, 0, 0), cube(20, 0, 0, 1e-12, 1e-13)}).ends.size(), 1u);
  EXPECT_EQ(sorted({cube(0, 0, 0), cube(20, 0, 0, 1e-6, 1e-7)}).ends.size(), 2u);
}

// A thin overlap may have no certain volume anywhere, and still has its sites.
TEST(SortBySite, ThinRegionsStandForThemselves) {
  EXPECT_EQ(sorted({cube(0, 0, 0, 0.5, 0.0), cube(10, 0, 0, 0.4, 0.0)}).ends.size(), 2u);
}

TEST(SortBySite, NothingHasNoSites) { EXPECT_TRUE(sorted({}).ends.empty()); }

}  // namespace
}  // namespace volcontact::cell_sites_test
