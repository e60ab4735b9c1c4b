// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/octree/piece_ray.h"

#include <gtest/gtest.h>

namespace volcontact::piece_ray_test {
namespace {

constexpr double kNudge = 1e-9;

// |x| <= half of a slab along x.
void add_slab(PieceList& list, double low, double high) {
  list.add(Quadric::plane(-Vec3::UnitX(), -low));
  list.add(Quadric::plane(Vec3::UnitX(), high));
  list.end_piece();
}

TEST(WayInside, EndsAtThePlane) {
  PieceList list;
  add_slab(list, -1.0, 2.0);
  EXPECT_NEAR(way_inside(list, Vec3(-1.0, 0.3, 0.0), Vec3::UnitX(), kNudge), 3.0, 1e-12);
  EXPECT_EQ(way_inside(list, Vec3(-1.0, 0.3, 0.0), -Vec3::UnitX(), kNudge), 0.0);
}

TEST(WayInside, RunsThroughPiecesThatTouch) {
  PieceList list;
  add_slab(list, 3.0, 4.0);
  add_slab(list, -1.0, 2.0);
  add_slab(list, 2.0, 3.0);
  EXPECT_NEAR(way_inside(list, Vec3(-1.0, 0.0, 0.0), Vec3::UnitX(), kNudge), 5.0, 1e-12);
}

TEST(WayInside, StopsAtAGap) {
  PieceList list;
  add_slab(list, -1.0, 2.0);
  add_slab(list, 2.1, 3.0);
  EXPECT_NEAR(way_inside(list, Vec3(-1.0, 0.0, 0.0), Vec3::UnitX(), kNudge), 3.0, 1e-12);
}

// A slab with a bore of radius 1/2 along z: the chord ends at its near side, at
// x = -sqrt(1/4 - y^2), and beyond it begins at the far side.
TEST(WayInside, EndsAtABore) {
  PieceList list;
  list.add(Quadric::plane(-Vec3::UnitX(), 2.0));
  list.add(Quadric::plane(Vec3::UnitX(), 2.0));
  list.add(Quadric::round({1.0, 1.0, 0.0}, Vec3::Zero(), 0.25).reversed());
  list.end_piece();
  for (const double y : {0.0, 0.3, 0.49}) {
    const double half = std::sqrt(0.25 - y * y);
    EXPECT_NEAR(way_inside(list, Vec3(-2.0, y, 0.0), Vec3::UnitX(), kNudge), 2.0 - half, 1e-12);
    EXPECT_NEAR(way_inside(list, Vec3(half, y, 0.0), Vec3::UnitX(), kNudge), 2.0 - half, 1e-12);
  }
  EXPECT_NEAR(way_inside(list, Vec3(-2.0, 0.6, 0.0), Vec3::UnitX(), kNudge), 4.0, 1e-12);
}

TEST(WayInside, ChordOfABall) {
  PieceList list;
  list.add(Quadric::round(Vec3::Ones(), Vec3(1.0, 0.0, 0.0), 0.25));
  list.end_piece();
  EXPECT_NEAR(way_inside(list, Vec3(0.5, 0.0, 0.0), Vec3::UnitX(), kNudge), 1.0, 1e-12);
  const Vec3 d = Vec3(1.0, 1.0, 0.0).normalized();
  EXPECT_NEAR(way_inside(list, Vec3(0.5, 0.0, 0.0), d, kNudge), std::sqrt(0.5), 1e-12);
}

TEST(WayInside, IsInfiniteWhereTheSolidIs) {
  PieceList list;
  list.add(Quadric::plane(Vec3::UnitZ(), 0.0));
  list.end_piece();
  EXPECT_EQ(way_inside(list, Vec3::Zero(), -Vec3::UnitZ(), kNudge), kInfinity);
}

TEST(FirstExit, FindsTheRootThatCounts) {
  EXPECT_DOUBLE_EQ(first_exit(1.0, 0.0, -4.0, 0.0), 2.0);
  EXPECT_DOUBLE_EQ(first_exit(-1.0, 3.0, -2.0, 0.0), 1.0);
  EXPECT_EQ(first_exit(-1.0, 3.0, -2.0, 2.0), kInfinity);
  EXPECT_DOUBLE_EQ(first_exit(0.0, 2.0, -3.0, 0.0), 1.5);
  EXPECT_EQ(first_exit(0.0, -2.0, -3.0, 0.0), kInfinity);
  EXPECT_EQ(first_exit(-1.0, 0.0, -1.0, 0.0), kInfinity);
}

}  // namespace
}  // namespace volcontact::piece_ray_test
