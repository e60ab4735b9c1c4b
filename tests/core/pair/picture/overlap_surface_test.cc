// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/picture/overlap_surface.h"

#include <gtest/gtest.h>

#include <map>

#include "core/support/csg_solids.h"
#include "core/support/meshes.h"
#include "volcontact/pair/interference.h"

namespace volcontact::overlap_surface_test {
namespace {

using testing::at;
using testing::turned;

constexpr int kResolution = 32;

// The closed body: the high ends, the low ends turned over, and a wall along the rim.
struct Body {
  double volume = 0.0;
  Vec3 first = Vec3::Zero();  // int x dV
  std::map<std::pair<int, int>, int> edges;

  // `center`: of the moments, near the body.
  Body(OverlapSurface s, const Vec3& center) {
    for (auto& column : s.columns) column.low -= center, column.high -= center;
    const int n = static_cast<int>(s.columns.size());
    for (const auto& t : s.triangles) {
      add(s, {t[0] + n, t[1] + n, t[2] + n});
      add(s, {t[0], t[2], t[1]});
    }
    for (const auto& [p, q] : s.rim) {
      add(s, {p, q, q + n});
      add(s, {p, q + n, p + n});
    }
  }

  void add(const OverlapSurface& s, const std::array<int, 3>& t) {
    const int n = static_cast<int>(s.columns.size());
    const auto point = [&](int i) {
      return i < n ? s.columns[static_cast<std::size_t>(i)].low
                   : s.columns[static_cast<std::size_t>(i - n)].high;
    };
    const Vec3 a = point(t[0]), b = point(t[1]), c = point(t[2]);
    const double part = a.dot(b.cross(c)) / 6.0;
    volume += part;
    first += 0.25 * part * (a + b + c);
    for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  }

  bool closed() const {
    for (const auto& [edge, count] : edges) {
      const auto back = edges.find({edge.second, edge.first});
      if (back == edges.end() || back->second != count) return false;
    }
    return true;
  }
};

// The surface encloses the volume that the engines integrate: neither knows of the other.
void expect_encloses(const Shape& a, const Shape& b, const Pose& X_WA, const Pose& X_WB,
                     double tolerance) {
  InterferenceWorkspace workspace;
  Interference found;
  interference(a, b, X_WA.inverse() * X_WB, {}, workspace, found);
  ASSERT_FALSE(found.sites.empty());
  for (const VolumeMetrics& site_A : found.sites) {
    const VolumeMetrics site = transformed(site_A, X_WA);
    const OverlapSurface surface = overlap_surface(a, X_WA, b, X_WB, site, kResolution);
    const Body body(surface, site.centroid);
    EXPECT_TRUE(body.closed());
    EXPECT_NEAR(body.volume / site.volume, 1.0, tolerance);
    const double size = std::sqrt(site.area_vector.norm());
    EXPECT_LT((body.first / body.volume).norm(), tolerance * size);
  }
}

const Pose kSomewhere = turned({1, 2, 3}, 0.9, {0.3, -0.2, 0.5});

TEST(OverlapSurface, EnclosesTheCapOfABall) {
  for (const double depth : {0.03, 1e-6}) {
    expect_encloses(HalfSpace(), Sphere({.radius = 0.05}), kSomewhere,
                    kSomewhere * at(0.01, 0.02, 0.05 - depth), 0.02);
  }
}

// A pose of the box in which its lowest point is so far below the floor.
Pose sunk(const Box& box, const Pose& turn, double depth) {
  const Vec3 down = turn.rotation.transpose() * -Vec3::UnitZ();
  return {turn.rotation, Vec3(0, 0, box.support_height(down) - depth)};
}

TEST(OverlapSurface, EnclosesABoxOnItsFaceEdgeAndCorner) {
  const Box box({.half_sizes = {0.1, 0.02, 0.05}});
  const Pose on_edge = turned(Vec3::UnitX(), 0.3, Vec3::Zero()),
             on_corner = turned({1, 1, 0}, 0.6, Vec3::Zero());
  expect_encloses(HalfSpace(), box, {}, sunk(box, {}, 1e-5), 0.02);
  expect_encloses(HalfSpace(), box, kSomewhere, kSomewhere * sunk(box, on_edge, 1e-3), 0.02);
  expect_encloses(HalfSpace(), box, kSomewhere, kSomewhere * sunk(box, on_corner, 1e-3), 0.05);
}

TEST(OverlapSurface, EnclosesARing) {
  const Csg ring = testing::tube(0.05, 0.02) - testing::tube(0.03, 0.03);
  expect_encloses(HalfSpace(), ring, {}, at(0, 0, 0.02 - 1e-4), 0.02);
}

TEST(OverlapSurface, EnclosesAPegAgainstTheWallOfItsBore) {
  const Csg bored = testing::box(0.1, 0.1, 0.02) - testing::tube(0.0202, 0.03);
  expect_encloses(bored, Cylinder({.radius = 0.02, .half_length = 0.05}), kSomewhere,
                  kSomewhere * at(0.00022, 0, 0.04), 0.05);
}

TEST(OverlapSurface, EnclosesMeshesThatCross) {
  const Mesh box = test::mesh_of(test::box_soup({0.1, 0.1, 0.1}));
  expect_encloses(box, box, {}, turned({1, 0.2, 0}, 0.4, {0.05, 0.02, 0.21}), 0.05);
}

TEST(OverlapSurface, IsEmptyWhereNothingTouches) {
  const OverlapSurface surface =
      overlap_surface(HalfSpace(), {}, Sphere({.radius = 1.0}), at(0, 0, 2), {}, kResolution);
  EXPECT_TRUE(surface.columns.empty());
  EXPECT_TRUE(surface.triangles.empty());
}

}  // namespace
}  // namespace volcontact::overlap_surface_test
