// SPDX-License-Identifier: Apache-2.0
#include "adaptor/geoms/box_union.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "volcontact/base/fields.h"

namespace volcontact::adaptor::box_union_test {
namespace {

const Aabb kEverywhere{Vec3::Constant(-kInfinity), Vec3::Constant(kInfinity)};

// Tiles of unit size, numbered by rows, without some of them.
std::vector<Aabb> floor_of(int columns, int rows, const std::set<int>& missing = {}) {
  std::vector<Aabb> tiles;
  for (int i = 0; i < columns * rows; ++i) {
    if (missing.count(i)) continue;
    const double x = i % columns, y = i / columns;
    tiles.push_back({{x, y, -0.1}, {x + 1.0, y + 1.0, 0.0}});
  }
  return tiles;
}

int joined(const std::vector<Aabb>& tiles, const Aabb& region) {
  BoxUnion boxes;
  boxes.build(tiles, region);
  return boxes.count();
}

TEST(BoxUnion, AFloorOfTilesIsOneBox) {
  BoxUnion boxes;
  boxes.build(floor_of(7, 5), kEverywhere);
  ASSERT_EQ(boxes.count(), 1);
  EXPECT_EQ(boxes.box(0).min, Vec3(0.0, 0.0, -0.1));
  EXPECT_EQ(boxes.box(0).max, Vec3(7.0, 5.0, 0.0));
  for (std::size_t i = 0; i < 35; ++i) EXPECT_EQ(boxes.of(i), 0);
}

TEST(BoxUnion, AGapAStepAndAnotherWidthKeepBoxesApart) {
  const Aabb tile{{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}};
  EXPECT_EQ(joined({tile, {{1.0, 0.0, 0.0}, {2.0, 1.0, 1.0}}}, kEverywhere), 1);
  EXPECT_EQ(joined({tile, {{1.0 + 1e-15, 0.0, 0.0}, {2.0, 1.0, 1.0}}}, kEverywhere), 2);
  EXPECT_EQ(joined({tile, {{1.0, 0.0, 0.0}, {2.0, 1.0, 1.1}}}, kEverywhere), 2);
  EXPECT_EQ(joined({tile, {{1.0, 0.0, 0.0}, {2.0, 0.9, 1.0}}}, kEverywhere), 2);
  EXPECT_EQ(joined({tile, {{1.0, 1.0, 0.0}, {2.0, 2.0, 1.0}}}, kEverywhere), 2);
}

TEST(BoxUnion, WhatLiesBeyondTheRegionDoesNotCount) {
  // Bricks in running bond: rows of different joints, one box where the region cuts them alike.
  std::vector<Aabb> bricks;
  for (int row = 0; row < 4; ++row) {
    for (int i = 0; i < 4; ++i) {
      const double x = i + 0.5 * (row % 2), y = row;
      bricks.push_back({{x, y, 0.0}, {x + 1.0, y + 1.0, 0.2}});
    }
  }
  EXPECT_GT(joined(bricks, kEverywhere), 1);
  const Aabb region{{0.7, 0.3, 0.1}, {3.2, 3.4, 0.5}};
  BoxUnion boxes;
  boxes.build(bricks, region);
  ASSERT_EQ(boxes.count(), 1);
  EXPECT_EQ(boxes.box(0).min, Vec3(0.0, 0.0, 0.0));  // on the side where they go on, all of them
  EXPECT_EQ(boxes.box(0).max.z(), 0.2);
}

TEST(BoxUnion, BoxesOutsideOfTheRegionHaveNoPart) {
  BoxUnion boxes;
  boxes.build(floor_of(4, 1), {{0.5, 0.2, -0.05}, {2.0, 0.8, 1.0}});
  EXPECT_EQ(boxes.count(), 1);
  EXPECT_EQ(boxes.of(0), 0);
  EXPECT_EQ(boxes.of(1), 0);
  EXPECT_EQ(boxes.of(2), BoxUnion::kOutside);  // only its face is there
  EXPECT_EQ(boxes.of(3), BoxUnion::kOutside);
}

TEST(BoxUnion, OverlappingAndNestedBoxesAreOne) {
  const Aabb tile{{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}};
  EXPECT_EQ(joined({tile, tile}, kEverywhere), 1);
  EXPECT_EQ(joined({tile, {{0.5, 0.0, 0.0}, {2.0, 1.0, 1.0}}}, kEverywhere), 1);
  EXPECT_EQ(joined({tile, {{0.2, 0.0, 0.0}, {0.6, 1.0, 1.0}}}, kEverywhere), 1);
}

TEST(BoxUnion, TellsWhereASmallerRegionMayJoinMore) {
  const std::vector<Aabb> corner = floor_of(2, 2, {3});  // an L
  BoxUnion boxes;
  boxes.build(corner, {{0.2, 0.2, -0.05}, {1.8, 1.8, 1.0}});
  EXPECT_EQ(boxes.count(), 2);
  EXPECT_TRUE(boxes.may_join_in_less());
  boxes.build(corner, {{0.2, 0.2, -0.05}, {1.8, 0.9, 1.0}});
  EXPECT_EQ(boxes.count(), 1);
  EXPECT_FALSE(boxes.may_join_in_less());
  // A wall beside a floor: their faces end in different planes, but for one that is far away.
  const std::vector<Aabb> room{{{0.0, 0.0, 0.0}, {1.0, 1.0, 0.1}},
                               {{1.0, 0.0, 0.0}, {1.1, 1.0, 1.0}}};
  boxes.build(room, {{0.5, 0.4, 0.08}, {1.05, 0.6, 0.5}});
  EXPECT_EQ(boxes.count(), 2);
  EXPECT_FALSE(boxes.may_join_in_less());
}

// Whatever boxes are joined, a point of the region is in a joined box just where it is in a box.
TEST(BoxUnion, JoinedBoxesFillTheSamePlace) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> at(0, 5), length(1, 3), count(2, 30);
  std::uniform_real_distribution<double> place(0.0, 8.0);
  BoxUnion boxes;
  long joined_some = 0;
  for (int round = 0; round < 400; ++round) {
    std::vector<Aabb> tiles(static_cast<std::size_t>(count(random)));
    for (Aabb& tile : tiles) {
      tile.min = Vec3(at(random), at(random), at(random));
      tile.max = tile.min + Vec3(length(random), length(random), length(random));
    }
    Aabb region{Vec3(place(random), place(random), place(random)), Vec3::Zero()};
    region.max = region.min + 0.5 * Vec3(place(random), place(random), place(random));
    boxes.build(tiles, region);
    std::size_t inside = 0;
    for (std::size_t i = 0; i < tiles.size(); ++i) inside += boxes.of(i) >= 0 ? 1 : 0;
    joined_some += static_cast<int>(inside) - boxes.count();
    const auto holds = [](const Aabb& box, const Vec3& p) {
      return box.min.less_than(p) && p.less_than(box.max);
    };
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (int sample = 0; sample < 200; ++sample) {
      const Vec3 s(share(random), share(random), share(random));
      const Vec3 p = region.min + s.cwiseProduct(region.max - region.min);
      bool in_tiles = false, in_boxes = false;
      for (const Aabb& tile : tiles) in_tiles = in_tiles || holds(tile, p);
      for (int i = 0; i < boxes.count(); ++i) in_boxes = in_boxes || holds(boxes.box(i), p);
      ASSERT_EQ(in_tiles, in_boxes) << p;
    }
  }
  EXPECT_GT(joined_some, 50);
}

}  // namespace
}  // namespace volcontact::adaptor::box_union_test
