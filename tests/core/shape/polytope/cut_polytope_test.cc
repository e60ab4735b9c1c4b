// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/polytope/cut_polytope.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/support/random.h"

namespace volcontact::cut_polytope_test {
namespace {

using test::Random;

constexpr int kNew = 6;

void start_cube(CutPolytope& polytope) {
  polytope.start(box_graph());
  for (int i = 0; i < 8; ++i) polytope.points()[i] = box_graph().points[i];
}

bool cut(CutPolytope& polytope, const Vec3& normal, double offset, int face = kNew,
         double tolerance = 0.0) {
  return polytope.cut([&](const Vec3& p) { return normal.dot(p) - offset; }, face, tolerance);
}

// Volume by tetrahedra, and a check that the faces close the surface.
double volume_of(CutPolytope& polytope) {
  double volume = 0.0;
  Vec3 closing = Vec3::Zero();
  for (const FaceLoop& face : polytope.faces()) {
    const auto vertex = [&](int i) {
      return polytope.points()[polytope.loop_vertices()[face.first + i]];
    };
    for (int i = 2; i < face.count; ++i) {
      volume += vertex(0).dot(vertex(i - 1).cross(vertex(i))) / 6.0;
      closing += (vertex(i - 1) - vertex(0)).cross(vertex(i) - vertex(0));
    }
  }
  EXPECT_LT(closing.norm(), 1e-13);
  return volume;
}

TEST(CutPolytope, UncutIsTheCube) {
  CutPolytope polytope;
  start_cube(polytope);
  EXPECT_NEAR(volume_of(polytope), 8.0, 1e-14);
}

TEST(CutPolytope, FacesLookOutwardsAndKnowTheirNumbers) {
  CutPolytope polytope;
  start_cube(polytope);
  for (const FaceLoop& face : polytope.faces()) {
    const auto vertex = [&](int i) {
      return polytope.points()[polytope.loop_vertices()[face.first + i]];
    };
    const Vec3 normal = (vertex(1) - vertex(0)).cross(vertex(2) - vertex(0)).normalized();
    const int axis = 2 - (face.face >> 1);
    EXPECT_EQ(normal, Vec3((face.face & 1 ? 1.0 : -1.0) * Vec3::Unit(axis)));
  }
}

TEST(CutPolytope, KeepsTheSideBelowThePlane) {
  CutPolytope polytope;
  start_cube(polytope);
  EXPECT_TRUE(cut(polytope, Vec3::UnitZ(), -0.5));
  EXPECT_NEAR(volume_of(polytope), 2.0, 1e-15);
  start_cube(polytope);
  EXPECT_TRUE(cut(polytope, Vec3(1, 1, 1), 0.0));  // a hexagon, through no corner
  EXPECT_NEAR(volume_of(polytope), 4.0, 1e-15);
}

TEST(CutPolytope, AllOrNothing) {
  CutPolytope polytope;
  start_cube(polytope);
  EXPECT_TRUE(cut(polytope, Vec3::UnitX(), 1.0));  // flush
  EXPECT_EQ(polytope.size(), 8);
  EXPECT_TRUE(cut(polytope, Vec3::UnitX(), 1.0 - 1e-16, kNew, 1e-15));  // within the tolerance
  EXPECT_EQ(polytope.size(), 8);
  EXPECT_FALSE(cut(polytope, Vec3::UnitX(), -1.1));
  EXPECT_EQ(polytope.size(), 0);
}

TEST(CutPolytope, PlanesThroughCornersAndEdgesHalveTheCube) {
  for (const Vec3& normal : {Vec3(1, 1, 0), Vec3(1, -1, 0), Vec3(0, 1, 1), Vec3(1, 0, 0)}) {
    CutPolytope polytope;
    start_cube(polytope);
    EXPECT_TRUE(cut(polytope, normal, 0.0));
    EXPECT_NEAR(volume_of(polytope), 4.0, 1e-14);
  }
  CutPolytope polytope;
  start_cube(polytope);
  // Through three corners: the tetrahedron beyond has a sixth of 8.
  EXPECT_TRUE(cut(polytope, Vec3(1, 1, 1), 1.0));
  EXPECT_NEAR(volume_of(polytope), 8.0 - 8.0 / 6.0, 1e-14);
}

TEST(CutPolytope, CutsOfBothSidesAddToTheWhole) {
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    const Vec3 n = random.direction(), m = random.direction();
    const double offset = random.uniform(-1.2, 1.2), first = random.uniform(-0.5, 1.0);
    double parts[2] = {0.0, 0.0}, whole = 0.0;
    CutPolytope polytope;
    start_cube(polytope);
    if (cut(polytope, m, first)) whole = volume_of(polytope);
    for (double sign : {1.0, -1.0}) {
      start_cube(polytope);
      if (cut(polytope, m, first) && cut(polytope, sign * n, sign * offset, kNew + 1)) {
        parts[sign < 0.0] = volume_of(polytope);
      }
    }
    EXPECT_NEAR(parts[0] + parts[1], whole, 1e-13);
  }
}

TEST(CutPolytope, StaysAClosedSurfaceUnderManyNearlyEqualPlanes) {
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    CutPolytope polytope;
    start_cube(polytope);
    const Vec3 n = random.direction();
    for (int k = 0; k < 60; ++k) {
      // The same plane again and again, off by rounding and a little more.
      const Vec3 tilt = random.log_uniform(1e-18, 1e-3) * random.direction();
      ASSERT_TRUE(cut(polytope, (n + tilt).normalized(), 0.2, kNew + k));
    }
    const double left = volume_of(polytope);
    CutPolytope once;
    start_cube(once);
    cut(once, n, 0.2);
    EXPECT_NEAR(left, volume_of(once), 0.1);
    EXPECT_GT(left, 0.0);
  }
}

TEST(CutPolytope, KnowsTheFaceAcrossAnEdge) {
  CutPolytope polytope;
  start_cube(polytope);
  cut(polytope, Vec3(1, 1, 1), 2.5);  // a small triangle at one corner
  for (const FaceLoop& face : polytope.faces()) {
    std::set<int> around;
    for (int i = 0; i < face.count; ++i) around.insert(polytope.face_across(face.first + i));
    if (face.face == kNew) {
      EXPECT_EQ(around, (std::set<int>{1, 3, 5}));
    } else {
      EXPECT_EQ(around.count(kNew), static_cast<std::size_t>(face.face & 1));
      EXPECT_EQ(around.count(face.face ^ 1), 0u);  // never the opposite one
    }
  }
}

}  // namespace
}  // namespace volcontact::cut_polytope_test
