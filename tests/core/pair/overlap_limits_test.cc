// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/overlap_limits.h"

#include <gtest/gtest.h>

#include "core/support/csg_solids.h"
#include "core/support/evaluated.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"

namespace volcontact::overlap_limits_test {
namespace {

using namespace testing;

// A ball of radius 1 over a block, 0.1 deep: a cap of the ball. Closed forms.
const Sphere kBall({.radius = 1.0});
const Box kBlock({.half_sizes = {2.0, 2.0, 1.0}});
const Pose kPlace{Mat3::Identity(), {0.0, 0.0, -1.9}};  // of the block

VolumeMetrics cap() {
  VolumeMetrics m;
  m.volume = kPi * .01 * (1.0 - .1 / 3.0);
  m.centroid = Vec3(0.0, 0.0, -.93);
  m.area_vector = Vec3(0.0, 0.0, -kPi * .19);
  m.area = m.counter_area = kPi * .2;
  m.volume_error = 1e-6 * m.volume;
  return m;
}

bool possible(const VolumeMetrics& m) {
  return is_possible(m, limits_of(kBall), limits_of(kBlock), kPlace);
}

TEST(OverlapLimits, ARightNumberIsPossible) { EXPECT_TRUE(possible(cap())); }

TEST(OverlapLimits, AVolumeBeyondTheSmallerSolidIsNot) {
  VolumeMetrics m = cap();
  m.volume = 4.0 / 3.0 * kPi;
  EXPECT_TRUE(possible(m));
  m.volume *= 1.001;
  EXPECT_FALSE(possible(m));
  m.volume = 1e52;
  m.volume_error = 1e53;  // an engine that doubts its number all over gives none
  EXPECT_FALSE(possible(m));
  m.volume = -1e-3;
  EXPECT_FALSE(possible(m));
}

TEST(OverlapLimits, WhatIsNoNumberIsNot) {
  for (const double wrong : {std::numeric_limits<double>::quiet_NaN(), kInfinity}) {
    VolumeMetrics m[9];
    for (VolumeMetrics& one : m) one = cap();
    m[0].volume = m[1].centroid.y() = m[2].area_vector.x() = m[3].area_moment.z() = wrong;
    m[4].inertia(1, 2) = m[5].area = m[6].counter_area = m[7].depth = m[8].volume_error = wrong;
    for (const VolumeMetrics& one : m) EXPECT_FALSE(possible(one));
  }
}

TEST(OverlapLimits, ACentroidOutsideOfEitherIsNot) {
  VolumeMetrics m = cap();
  m.centroid.z() = -1.001;  // beneath the ball
  EXPECT_FALSE(possible(m));
  m.centroid.z() = -.899;  // above the block
  EXPECT_FALSE(possible(m));
}

TEST(OverlapLimits, AnAreaVectorBeyondTheShadowIsNot) {
  VolumeMetrics m = cap();
  m.area_vector.z() = -4.1;  // the bounds of the ball show 4
  EXPECT_FALSE(possible(m));
  m.area_vector.z() = -3.9;
  EXPECT_TRUE(possible(m));
}

// Interleaved combs push at every tooth: more than the bounds show, but not more than teeth do.
TEST(OverlapLimits, ALayerCountsOnItsOwn) {
  Csg comb = box(.5, .5, .02), other = comb.posed(at(0, 0, .03));
  for (int i = 1; i < 10; ++i) {
    comb = comb + box(.5, .5, .02, at(0, 0, .1 * i));
    other = other + box(.5, .5, .02, at(0, 0, .1 * i + .03));
  }
  const Interference out = test::evaluated(comb, other, Pose{});
  EXPECT_NEAR(out.total.area_vector.z(), 10.0, 1e-6);
  EXPECT_NEAR(out.total.volume, 10.0 * .01, 1e-6);
  EXPECT_TRUE(is_possible(out.total, limits_of(comb), limits_of(other), Pose{}));
}

TEST(OverlapLimits, HoldForUnboundedSolidsAndForAnyPose) {
  test::Random random(5);
  const HalfSpace ground;
  for (int i = 0; i < 200; ++i) {
    const Pose X = random.pose(1.0);
    const Interference out = test::evaluated(ground, kBall, X);
    EXPECT_EQ(out.engine, Engine::kClosedForm);
    EXPECT_TRUE(is_possible(out.total, limits_of(ground), limits_of(kBall), X));
  }
}

TEST(OverlapLimits, ADepthMomentIsBoundedByTheVolume) {
  const double square = longest_square(limits_of(kBall), limits_of(HalfSpace()));
  EXPECT_NEAR(square, 12.0, 1e-12);
  VolumeMetrics m = cap();
  m.depth_moment = .05 * m.volume;
  bound_depth_moment(square, m);
  EXPECT_EQ(m.depth_moment, .05 * m.volume);
  for (const double wrong : {std::numeric_limits<double>::quiet_NaN(), kInfinity, 1e10}) {
    m.volume = 7e-18;
    m.depth_moment = wrong;
    bound_depth_moment(square, m);
    EXPECT_EQ(m.depth_moment, std::sqrt(square) * 7e-18);
  }
  m.depth_moment = -1e-3;
  bound_depth_moment(square, m);
  EXPECT_EQ(m.depth_moment, 0.0);
}

// Solids that touch, in any order and pose: the energy of a law, k times the moment, is none.
TEST(OverlapLimits, ATouchHoldsNoEnergy) {
  test::Random random(8);
  const Csg bored = box(.3, .3, .2) - tube(.15, .4), pipe = tube(.3, .3) - tube(.15, .4);
  struct Touch {
    Shape a, b;
    Pose X;
  };
  const Touch touches[] = {
      {bored, Cylinder({.radius = .15, .half_length = .3}), at(0, 0, 0)},
      {pipe, Capsule({.radius = .15, .half_length = .1}), at(0, 0, .05)},
      {bored, Sphere({.radius = .15}), at(0, 0, .1)},
      {bored, Box({.half_sizes = {.1, .1, .1}}), at(0, 0, .3)},
      {pipe, Cylinder({.radius = .1, .half_length = .2}), at(.4, 0, 0)},
      {Cylinder({.radius = .1, .half_length = .2}), Frustum({.bottom_radius = .2}), at(0, 0, .3)},
      {Sphere({.radius = .1}), Ellipsoid({.semi_axes = {.1, .2, .3}}), at(0, .3, 0)},
      {Torus({.major_radius = .3, .minor_radius = .1}), Sphere({.radius = .2}), at(0, 0, 0)},
      {Torus({.major_radius = .3, .minor_radius = .1}), Torus({.major_radius = .3}), at(.9, 0, 0)},
  };
  for (const Touch& touch : touches) {
    for (int i = 0; i < 20; i += test::cases(1, 7)) {
      Pose X = touch.X;
      if (i > 0) X.translation += random.in_box(std::pow(10.0, i - 18));
      const Interference out = test::evaluated(touch.a, touch.b, X);
      EXPECT_LE(out.total.depth_moment, 2.0 * out.total.volume) << name_of(touch.b) << " " << i;
      EXPECT_GE(out.total.depth_moment, 0.0);
    }
  }
}

// What an engine claims of its error is taken at its word, but for specks.
TEST(OverlapLimits, AnErrorOfTheSizeOfTheVolumeIsNoAnswer) {
  const OverlapLimits ball = limits_of(kBall), block = limits_of(kBlock);
  const double least = std::min(ball.volume, block.volume);
  VolumeMetrics m;
  m.volume = 1e-2 * least;
  m.volume_error = 0.04 * m.volume;
  EXPECT_FALSE(is_doubtful(m, ball, block));
  m.volume_error = 0.06 * m.volume;
  EXPECT_TRUE(is_doubtful(m, ball, block));
  m.volume = 1e-12 * least;
  m.volume_error = m.volume;
  EXPECT_FALSE(is_doubtful(m, ball, block));
}

}  // namespace
}  // namespace volcontact::overlap_limits_test
