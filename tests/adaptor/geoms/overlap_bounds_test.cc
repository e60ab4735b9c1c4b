// SPDX-License-Identifier: Apache-2.0
#include "adaptor/geoms/overlap_bounds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <variant>

namespace volcontact::adaptor::overlap_bounds_test {
namespace {

const Aabb kFloor{{-1.0, -1.0, -0.1}, {1.0, 1.0, 0.0}};

TEST(OverlapBounds, OfABallOnAFaceAreThoseOfItsCap) {
  const Shape ball = Sphere({.radius = 0.05});
  const SolidView view = view_of(ball);
  for (const double h : {1e-2, 1e-4, 1e-6}) {
    const Aabb cap = overlap_bounds(view, {Mat3::Identity(), {0.3, 0.2, 0.05 - h}}, kFloor);
    const double radius = std::sqrt(h * (2.0 * 0.05 - h));
    EXPECT_NEAR(cap.max.x(), 0.3 + radius, 1e-9);
    EXPECT_NEAR(cap.min.x(), 0.3 - radius, 1e-9);
    EXPECT_NEAR(cap.max.y(), 0.2 + radius, 1e-9);
    EXPECT_NEAR(cap.min.z(), -h, 1e-9);
    EXPECT_EQ(cap.max.z(), 0.0);
  }
}

// A box with an edge down, turned about y by 45 degrees: the overlap is a wedge.
TEST(OverlapBounds, OfABoxOnItsEdgeAreThoseOfAWedge) {
  const Shape box = Box({.half_sizes = Vec3(0.1, 0.2, 0.1)});
  const SolidView view = view_of(box);
  const double c = std::sqrt(0.5), h = 0.01;
  Mat3 turned = {c, 0.0, c, 0.0, 1.0, 0.0, -c, 0.0, c};
  const Pose X_FS{turned, {0.0, 0.0, 0.1 * std::sqrt(2.0) - h}};
  const Aabb wedge = overlap_bounds(view, X_FS, kFloor);
  EXPECT_NEAR(wedge.max.x(), h, 1e-9);
  EXPECT_NEAR(wedge.min.x(), -h, 1e-9);
  EXPECT_NEAR(wedge.max.y(), 0.2, 1e-9);
  EXPECT_NEAR(wedge.min.z(), -h, 1e-9);
}

// What is searched for any solid is known of a box.
TEST(OverlapBounds, OfABoxAreThoseOfTheSearch) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> at(-1.0, 1.0);
  const Box solid({.half_sizes = Vec3(0.3, 0.5, 0.2)});
  const Shape shape = solid;
  const Aabb box{{-0.3, -0.4, -0.2}, {0.3, 0.2, 0.4}};
  int met = 0;
  for (int round = 0; round < 500; ++round) {
    const Vec3 axis = Vec3(at(random), at(random), at(random)).normalized();
    const Mat3 turned = rotation_about(axis, 3.0 * at(random));
    const Pose X_FS{round % 5 == 0 ? Mat3(Mat3::Identity()) : turned,
                    0.8 * Vec3(at(random), at(random), at(random))};
    const Aabb known = overlap_bounds(solid, X_FS, box);
    const Aabb searched = overlap_bounds(view_of(shape), X_FS, box);
    if (!searched.min.less_than(searched.max)) {
      EXPECT_FALSE(known.min.less_than(known.max)) << round;
      continue;
    }
    ++met;
    EXPECT_LE((known.min - searched.min).cwiseAbs().maxCoeff(), 1e-6) << round;
    EXPECT_LE((known.max - searched.max).cwiseAbs().maxCoeff(), 1e-6) << round;
  }
  EXPECT_GT(met, 250);
}

TEST(OverlapBounds, HoldEveryPointOfTheOverlap) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> at(-1.0, 1.0);
  const Shape solids[] = {Sphere({.radius = 0.4}), Box({.half_sizes = Vec3(0.3, 0.5, 0.2)}),
                          Cylinder({.radius = 0.3, .half_length = 0.2}),
                          Ellipsoid({.semi_axes = Vec3(0.2, 0.4, 0.3)}),
                          Capsule({.radius = 0.2, .half_length = 0.3})};
  const Aabb box{{-0.3, -0.4, -0.2}, {0.3, 0.2, 0.4}};
  long inside = 0;
  for (int round = 0; round < 200; ++round) {
    const SolidView view = view_of(solids[round % 5]);
    const Vec3 axis = Vec3(at(random), at(random), at(random)).normalized();
    const Pose X_FS{rotation_about(axis, 3.0 * at(random)),
                    0.5 * Vec3(at(random), at(random), at(random))};
    const Box* const solid = std::get_if<Box>(&solids[round % 5]);
    const Aabb bounds = solid ? overlap_bounds(*solid, X_FS, box) : overlap_bounds(view, X_FS, box);
    for (int sample = 0; sample < 200; ++sample) {
      const Vec3 p(0.3 * at(random), -0.1 + 0.3 * at(random), 0.1 + 0.3 * at(random));
      if (view.signed_distance(view.solid, X_FS.inverse() * p) > 0.0) continue;
      ++inside;
      ASSERT_TRUE(bounds.min.at_most(p + Vec3::Constant(1e-12))) << p;
      ASSERT_TRUE(p.at_most(bounds.max + Vec3::Constant(1e-12))) << p;
    }
  }
  EXPECT_GT(inside, 5000);
}

}  // namespace
}  // namespace volcontact::adaptor::overlap_bounds_test
