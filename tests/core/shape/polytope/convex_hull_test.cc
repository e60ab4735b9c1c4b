// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/polytope/convex_hull.h"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

#include "core/support/random.h"

namespace volcontact::convex_hull_test {
namespace {

using test::Random;

using Triangles = std::vector<std::array<int, 3>>;

// Closed, oriented, of the topology of a sphere, and no point outside: the definition of the hull.
void expect_hull(const Triangles& triangles, const std::vector<Vec3>& points) {
  std::set<std::pair<int, int>> edges;
  std::set<int> corners;
  for (const auto& t : triangles) {
    for (int i = 0; i < 3; ++i) {
      corners.insert(t[i]);
      EXPECT_TRUE(edges.insert({t[i], t[(i + 1) % 3]}).second) << "edge used twice";
    }
  }
  for (const auto& [a, b] : edges) EXPECT_TRUE(edges.count({b, a})) << "open edge";
  EXPECT_EQ(corners.size() + triangles.size(), edges.size() / 2 + 2) << "not a sphere";
  int outside = 0;
  for (const auto& t : triangles) {
    for (const Vec3& p : points) {
      outside += side_of_plane(points[t[0]], points[t[1]], points[t[2]], p) > 0;
    }
  }
  EXPECT_EQ(outside, 0);
}

TEST(SideOfPlane, TellsAboveFromBelow) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  EXPECT_EQ(side_of_plane(a, b, c, Vec3(0.2, 0.2, 1e-300)), 1);
  EXPECT_EQ(side_of_plane(a, b, c, Vec3(0.2, 0.2, -1e-300)), -1);
  EXPECT_EQ(side_of_plane(a, b, c, Vec3(5, 7, 0)), 0);
}

TEST(SideOfPlane, IsExactWhereRoundingWouldDecide) {
  // Points a, b, c on the plane x + y + z = 3 u with coordinates that are exact multiples of
  // u = 2^-52; d is on it or one unit off.
  constexpr double u = 0x1p-52;
  const Vec3 a(1.0 + u, -0.5, -0.5 + 2 * u), b(-0.5, 1.0 + u, -0.5 + 2 * u),
      c(0.25, 0.25, -0.5 + 3 * u);
  const Vec3 d(0.125, 0.0625, -0.1875 + 3 * u);
  EXPECT_EQ(side_of_plane(a, b, c, d), 0);
  const int above = side_of_plane(a, b, c, Vec3(1, 1, 1));
  EXPECT_NE(above, 0);
  EXPECT_EQ(side_of_plane(a, b, c, d + Vec3(0, 0, u)), above);
  EXPECT_EQ(side_of_plane(a, b, c, d - Vec3(0, 0, u)), -above);
}

TEST(ConvexHull, OfRandomPointsInABallAndOnASphere) {
  Random random(1);
  for (int i = 0; i < 40; ++i) {
    std::vector<Vec3> points;
    const int count = 4 + 4 * i;
    for (int k = 0; k < count; ++k) {
      points.push_back((i % 2 ? 1.0 : random.uniform()) * random.direction());
    }
    expect_hull(convex_hull(points), points);
  }
}

TEST(ConvexHull, OfAGridHasManyCoplanarAndCollinearPoints) {
  std::vector<Vec3> points;
  for (int x = 0; x < 5; ++x) {
    for (int y = 0; y < 5; ++y) {
      for (int z = 0; z < 5; ++z) points.emplace_back(0.1 * x, 0.1 * y, 0.1 * z);
    }
  }
  expect_hull(convex_hull(points), points);
  for (Vec3& p : points) p = test::turn(Vec3(1, 2, 3), 0.7) * p;  // coplanar to rounding only
  expect_hull(convex_hull(points), points);
}

TEST(ConvexHull, OfPointsThatDifferByRounding) {
  Random random(2);
  std::vector<Vec3> points;
  for (int i = 0; i < 300; ++i) {
    const Vec3 corner(i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0);
    points.push_back(corner + 4e-16 * random.in_box(1.0));
  }
  expect_hull(convex_hull(points), points);
}

// Of integer points, whose sides are exact, one coordinate is made tiny: products of three
// underflow. The hull of four points is their tetrahedron.
TEST(ConvexHull, OfTetrahedraWithATinyCoordinate) {
  Random random(5);
  int count = 0;
  for (const double tiny : {0.0, 1e-320, 1e-310, -1e-300, 1e-300, 1e-280, 1e-200, 1e-100}) {
    for (int i = 0; i < 300; ++i) {
      std::vector<Vec3> points;
      for (int k = 0; k < 4; ++k) {
        points.push_back((7.0 * random.in_box(1.0)).rounded() / 7.0);
      }
      points[i % 4][i % 3] = tiny;
      const Vec3 a = points[0];
      if (std::abs((points[1] - a).cross(points[2] - a).dot(points[3] - a)) < 1e-3) continue;
      ++count;
      EXPECT_EQ(convex_hull(points).size(), 4u);
    }
  }
  EXPECT_GT(count, 1000);
}

TEST(ConvexHull, KeepsItsTopologyAtEverySize) {
  Random random(6);
  std::vector<Vec3> points;
  for (int i = 0; i < 30; ++i) points.push_back(random.in_box(1.0));
  const std::vector<std::array<int, 3>> hull = convex_hull(points);
  for (const int exponent : {-1000, -400, -200, 200, 400, 1000}) {
    std::vector<Vec3> scaled;
    for (const Vec3& p : points) scaled.push_back(std::ldexp(1.0, exponent) * p);
    EXPECT_EQ(convex_hull(scaled), hull);
  }
}

TEST(ConvexHull, RejectsWhatHasNoVolume) {
  Random random(3);
  std::vector<Vec3> flat;
  const Mat3 r = random.rotation();
  for (int i = 0; i < 20; ++i) flat.push_back(r * Vec3(random.uniform(), random.uniform(), 0.5));
  EXPECT_THROW(convex_hull(flat), std::invalid_argument);
  EXPECT_THROW(convex_hull(std::vector<Vec3>(10, Vec3(1, 2, 3))), std::invalid_argument);
  std::vector<Vec3> line;
  for (int i = 0; i < 10; ++i) line.push_back(i * Vec3(1, 2, 3));
  EXPECT_THROW(convex_hull(line), std::invalid_argument);
}

}  // namespace
}  // namespace volcontact::convex_hull_test
