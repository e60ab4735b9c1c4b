// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/polytope/convex_polytope.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

#include "core/support/matchers.h"
#include "core/support/random.h"
#include "volcontact/shape/box.h"

namespace volcontact::convex_polytope_test {
namespace {

using test::Random;

std::vector<Vec3> box_corners(const Vec3& half) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    corners.emplace_back(i & 1 ? half.x() : -half.x(), i & 2 ? half.y() : -half.y(),
                         i & 4 ? half.z() : -half.z());
  }
  return corners;
}

std::string message_of(const std::vector<Vec3>& points) {
  try {
    ConvexPolytope polytope(points);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(ConvexPolytope, BoxHasSixFacesWhateverElseIsGiven) {
  const Vec3 half(0.3, 0.2, 0.1);
  Random random(1);
  for (int turned = 0; turned < 20; ++turned) {
    std::vector<Vec3> points = box_corners(half);
    for (int i = 0; i < 8; ++i) points.push_back(points[i]);  // twice
    for (int i = 0; i < 8; ++i) {
      points.push_back(0.25 * points[0] + 0.75 * points[4]);            // on an edge
      points.push_back(random.uniform(0.0, 0.9) * random.in_box(0.1));  // inside
    }
    for (int i = 0; i < 6; ++i) {  // in a face
      points.emplace_back(0.3, random.uniform(-0.19, 0.19), random.uniform(-0.09, 0.09));
    }
    const Mat3 r = turned ? random.rotation() : Mat3(Mat3::Identity());
    for (Vec3& p : points) p = r * p;
    const ConvexPolytope box(points);
    EXPECT_EQ(box.faces().size(), 6u);
    EXPECT_EQ(box.vertices().size(), 8u);
    EXPECT_EQ(box.graph().points.size(), 8u);
    for (const auto& face : box.faces()) EXPECT_EQ(face.loop.size(), 4u);
    const VolumeMetrics expected =
        transformed(Box({.half_sizes = half}).own_metrics(), Pose{r, Vec3::Zero()});
    EXPECT_TRUE(test::same(box.own_metrics(), expected, {1e-13, 1.0}));
    EXPECT_NEAR(box.surface_area(), 8.0 * (0.06 + 0.02 + 0.03), 1e-14);
  }
}

TEST(ConvexPolytope, PrismKeepsItsCapsWhole) {
  constexpr int kSides = 64;
  Random random(2);
  const Pose X = random.pose(1.0);
  std::vector<Vec3> points;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2.0 * kPi * i / kSides;
    for (double z : {-0.2, 0.2}) points.push_back(X * Vec3(std::cos(angle), std::sin(angle), z));
  }
  const ConvexPolytope prism(points);
  EXPECT_EQ(prism.faces().size(), kSides + 2u);
  // Area of the regular polygon times the height.
  const double volume = 0.5 * kSides * std::sin(2.0 * kPi / kSides) * 0.4;
  EXPECT_NEAR(prism.own_metrics().volume, volume, 1e-14);
  EXPECT_LT((prism.own_metrics().centroid - X.translation).norm(), 1e-14);
}

TEST(ConvexPolytope, OctahedronHasItsKnownMetrics) {
  const ConvexPolytope solid({Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0),
                              Vec3(0, 0, 1), Vec3(0, 0, -1)});
  EXPECT_EQ(solid.faces().size(), 8u);
  // V = 4/3, int x^2 dV = 2/15 each (integral over the unit ball of the 1-norm), surface 4 sqrt 3.
  EXPECT_NEAR(solid.own_metrics().volume, 4.0 / 3.0, 1e-15);
  EXPECT_LT((solid.own_metrics().inertia - 4.0 / 15.0 * Mat3::Identity()).norm(), 1e-15);
  EXPECT_NEAR(solid.surface_area(), 4.0 * std::sqrt(3.0), 1e-14);
}

TEST(ConvexPolytope, FacesAreSupportingPlanesAndCloseTheSurface) {
  Random random(3);
  for (int i = 0; i < 30; ++i) {
    std::vector<Vec3> points;
    for (int k = 0; k < 6 + 5 * i; ++k) points.push_back(random.direction());
    const ConvexPolytope solid(points);
    Vec3 closing = Vec3::Zero();
    double volume = 0.0;
    for (const auto& face : solid.faces()) {
      EXPECT_NEAR(face.normal.norm(), 1.0, 1e-15);
      for (int corner : face.loop) {
        EXPECT_NEAR(face.normal.dot(solid.vertices()[corner]), face.offset, 1e-12);
      }
      Vec3 twice_area = Vec3::Zero();
      for (std::size_t k = 2; k < face.loop.size(); ++k) {
        const Vec3& a = solid.vertices()[face.loop[0]];
        twice_area +=
            (solid.vertices()[face.loop[k - 1]] - a).cross(solid.vertices()[face.loop[k]] - a);
      }
      closing += twice_area;
      volume += face.offset * twice_area.norm() / 6.0;
    }
    for (const Vec3& p : points) EXPECT_LE(solid.signed_distance(p), 1e-13);
    EXPECT_LT(closing.norm(), 1e-12);
    // The pyramids from the origin to the faces: another sum than that of own_metrics().
    EXPECT_NEAR(solid.own_metrics().volume, volume, 1e-12);
  }
}

TEST(ConvexPolytope, SignedDistanceIsABoundExactInside) {
  Random random(4);
  const ConvexPolytope box(box_corners(Vec3(0.3, 0.2, 0.1)));
  const Box exact({.half_sizes = Vec3(0.3, 0.2, 0.1)});
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = random.in_box(0.5);
    const double distance = exact.signed_distance(p);
    if (distance <= 0.0) {
      EXPECT_NEAR(box.signed_distance(p), distance, 1e-15);
    } else {
      EXPECT_GT(box.signed_distance(p), 0.0);
      EXPECT_LE(box.signed_distance(p), distance + 1e-15);
    }
  }
  EXPECT_EQ(box.gradient(Vec3(0.29, 0, 0)), Vec3(1, 0, 0));
}

TEST(ConvexPolytope, SupportRayAndBoundsEqualThoseOfTheBox) {
  Random random(5);
  const Vec3 half(0.3, 0.2, 0.1);
  const ConvexPolytope solid(box_corners(half));
  const Box box({.half_sizes = half});
  EXPECT_EQ(solid.bounds().min, -half);
  EXPECT_EQ(solid.bounds().max, half);
  for (int i = 0; i < 200; ++i) {
    const Vec3 e = random.in_box(2.0), o = random.in_box(0.5);
    EXPECT_NEAR(solid.support_height(e), box.support_height(e), 1e-15);
    EXPECT_EQ(solid.support(e), box.support(e));
    const RayInterval span = solid.ray(o, e), expected = box.ray(o, e);
    EXPECT_EQ(span.empty(), expected.empty());
    if (span.empty()) continue;
    EXPECT_NEAR(span.enter, expected.enter, 1e-13);
    EXPECT_NEAR(span.leave, expected.leave, 1e-13);
  }
  EXPECT_TRUE(solid.ray(Vec3(0, 0.3, 0), Vec3::UnitX()).empty());
}

TEST(ConvexPolytope, MeshVerticesInSinglePrecisionAreFine) {
  Random random(6);
  const Mat3 r = random.rotation();
  std::vector<Vec3> points = box_corners(Vec3(0.3, 0.2, 0.1));
  for (Vec3& p : points) {
    p = r * p;
    for (double& x : p) x = static_cast<float>(x);
  }
  const ConvexPolytope solid(points);
  EXPECT_NEAR(solid.own_metrics().volume, 0.048, 1e-7);
  for (const Vec3& p : points) EXPECT_LE(solid.signed_distance(p), 1e-15);
}

TEST(ConvexPolytope, ThinPlateIsKept) {
  const ConvexPolytope plate(box_corners(Vec3(1.0, 1.0, 1e-9)));
  EXPECT_EQ(plate.faces().size(), 6u);
  EXPECT_NEAR(plate.own_metrics().volume, 8e-9, 1e-22);
}

TEST(ConvexPolytope, CopiesShareTheirData) {
  const ConvexPolytope a(box_corners(Vec3::Ones()));
  const ConvexPolytope b = a;
  EXPECT_EQ(&a.vertices(), &b.vertices());
}

TEST(ConvexPolytope, ErrorsNameCountAndReason) {
  EXPECT_EQ(message_of({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}),
            "convex_polytope: needs at least 4 vertices, got 3");
  std::vector<Vec3> points = box_corners(Vec3::Ones());
  points[5].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message_of(points), "convex_polytope: vertex 5 is not finite");
  EXPECT_EQ(message_of(box_corners(Vec3::Constant(1e-100))),
            "convex_polytope: the vertices are up to 2e-100 m apart; must be 1e-50 to 1e+50");
  EXPECT_EQ(message_of(box_corners(Vec3::Constant(1e100))),
            "convex_polytope: the vertices are up to 2e+100 m apart; must be 1e-50 to 1e+50");
  EXPECT_EQ(message_of(box_corners(Vec3(1, 1, 0))),
            "convex_polytope: the 8 vertices lie in one plane, so their hull has no volume");
}

}  // namespace
}  // namespace volcontact::convex_polytope_test
