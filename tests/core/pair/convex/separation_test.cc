// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/convex/separation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/support/random_shapes.h"
#include "volcontact/pair/clip/clip.h"

namespace volcontact::separation_test {
namespace {

using test::Random;

bool apart(const Vec3& half_a, const Vec3& half_b, const Pose& X_AB) {
  return boxes_apart(half_a, half_b, X_AB.rotation, X_AB.translation);
}

// The overlap of slightly larger boxes, cut as polytopes: another way to decide.
double overlap_of_larger(const Box& a, const Box& b, const Pose& X_AB, double margin) {
  ClipScratch scratch;
  const Vec3 more = Vec3::Constant(margin);
  return clip(Box({.half_sizes = a.half_sizes() + more}),
              Box({.half_sizes = b.half_sizes() + more}), X_AB, scratch)
      .volume;
}

TEST(BoxesApart, NeverSeparatesBoxesThatShareAPoint) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 half_a = random.in_box(1.0).cwiseAbs(), half_b = random.in_box(1.0).cwiseAbs();
    // Any point of A brought onto any point of B, corners and edges included.
    const auto point_in = [&](const Vec3& half) {
      Vec3 p = random.in_box(1.0).cwiseProduct(half);
      for (int k = 0; k < 3; ++k) {
        if (random.uniform() < 0.5) p[k] = std::copysign(half[k], p[k]);
      }
      return p;
    };
    const Mat3 R = i % 3 ? random.rotation() : Mat3(Mat3::Identity());
    const Pose X{R, point_in(half_a) - R * point_in(half_b)};
    EXPECT_FALSE(apart(half_a, half_b, X));
  }
}

TEST(BoxesApart, SeparatesBoxesWithAGapInAllFifteenWays) {
  Random random(2);
  int separated = 0;
  for (int i = 0; i < 5000; ++i) {
    const Box a = test::random_box(random), b = test::random_box(random);
    const Pose X = random.pose(2.0);
    if (apart(a.half_sizes(), b.half_sizes(), X)) {
      ++separated;
      EXPECT_EQ(overlap_of_larger(a, b, X, -1e-12), 0.0);
    } else {
      // No gap: then boxes a little larger overlap.
      EXPECT_GT(overlap_of_larger(a, b, X, 1e-5), 0.0);
    }
  }
  EXPECT_GT(separated, 1000);
}

TEST(BoxesApart, EdgesDecideWhereNoFaceDoes) {
  // Two beams crossed at right angles, each turned on edge: only edge x edge tells them apart.
  const Vec3 half(1.0, 0.1, 0.1);
  const Mat3 on_edge = test::turn(Vec3::UnitX(), kPi / 4);
  const Mat3 R = on_edge.transpose() * test::turn(Vec3::UnitZ(), kPi / 2) * on_edge;
  const auto at = [&](double z) { return Pose{R, on_edge.transpose() * Vec3(0, 0, z)}; };
  const double touch = 2.0 * 0.1 * std::sqrt(2.0);
  EXPECT_TRUE(apart(half, half, at(touch + 1e-9)));
  EXPECT_FALSE(apart(half, half, at(touch - 1e-9)));
}

// Any point of one axis brought to any place within both radii of any point of the other one.
TEST(CapsulesApart, NeverSeparatesCapsulesThatShareAPoint) {
  Random random(3);
  for (int i = 0; i < 20000; ++i) {
    const double half_a = i % 5 ? random.uniform() : 0.0, half_b = i % 7 ? random.uniform() : 0.0;
    const double radius_a = random.uniform(), radius_b = random.uniform();
    const Mat3 R = i % 3   ? random.rotation()
                   : i % 2 ? Mat3(Mat3::Identity())
                           : test::turn(random.direction(), 1e-8 * random.uniform());
    const double s = random.uniform(-half_a, half_a), t = random.uniform(-half_b, half_b);
    const Vec3 between = (radius_a + radius_b) * random.uniform() * random.direction();
    const Pose X{R, s * Vec3::UnitZ() + between - t * R.col(2)};
    EXPECT_FALSE(capsules_apart(half_a, radius_a, half_b, radius_b, X));
  }
}

// The nearest points by another way: for places along one axis, the nearest of the other one.
TEST(CapsulesApart, SeparatesCapsulesWithAGap) {
  Random random(4);
  int separated = 0;
  for (int i = 0; i < 2000; ++i) {
    const double half_a = random.uniform(), half_b = random.uniform(), radius = 0.2;
    Pose X = random.pose(1.5);
    if (i % 3 == 0) X.rotation = Mat3::Identity();
    const auto distance = [&](double s) {
      const Vec3 from = s * Vec3::UnitZ() - X.translation, axis = X.rotation.col(2);
      return (from - std::clamp(axis.dot(from), -half_b, half_b) * axis).norm();
    };
    double low = -half_a, high = half_a;  // the distance is a convex function
    for (int k = 0; k < 200; ++k) {
      const double a = (2.0 * low + high) / 3.0, b = (low + 2.0 * high) / 3.0;
      (distance(a) < distance(b) ? high : low) = distance(a) < distance(b) ? b : a;
    }
    const double gap = distance(0.5 * (low + high)) - 2.0 * radius;
    if (std::abs(gap) < 1e-9) continue;
    EXPECT_EQ(capsules_apart(half_a, radius, half_b, radius, X), gap > 0.0) << gap;
    separated += gap > 0.0;
  }
  EXPECT_GT(separated, 500);
  EXPECT_LT(separated, 1900);
}

}  // namespace
}  // namespace volcontact::separation_test
