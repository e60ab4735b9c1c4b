// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/interference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "core/support/evaluated.h"
#include "core/support/gradient.h"
#include "core/support/matchers.h"
#include "core/support/meshes.h"
#include "core/support/random_shapes.h"
#include "core/support/sanitized.h"
#include "volcontact/pair/geometric_pair.h"

namespace volcontact::interference_test {
namespace {

using test::evaluated;

using test::Random;

Shape some_polytope() {
  Random random(1);
  return test::random_polytope(12, random);
}

// One of each shape that an exact engine serves.
const Shape kGround = HalfSpace();
const Shape kBall = Sphere({.radius = 0.5});
const Shape kEgg = Ellipsoid({.semi_axes = Vec3(0.5, 0.4, 0.3)});
const Shape kBox = Box({.half_sizes = Vec3(0.5, 0.4, 0.3)});
const Shape kGem = some_polytope();
const Shape kCan = Cylinder({.radius = 0.3, .half_length = 0.4});
const Shape kPill = Capsule({.radius = 0.3, .half_length = 0.2});
const Shape kCup = Frustum({.bottom_radius = 0.3, .top_radius = 0.5, .half_length = 0.4});
const Shape kRing = Torus({.major_radius = 0.3, .minor_radius = 0.1});

struct Served {
  Shape a, b;
  Engine engine;
};
const std::vector<Served> kServed{
    {kGround, kBall, Engine::kClosedForm}, {kGround, kEgg, Engine::kClosedForm},
    {kGround, kCan, Engine::kClosedForm},  {kGround, kPill, Engine::kClosedForm},
    {kGround, kCup, Engine::kClosedForm},  {kGround, kRing, Engine::kClosedForm},
    {kBall, kBall, Engine::kClosedForm},   {kGround, kBox, Engine::kClip},
    {kGround, kGem, Engine::kClip},        {kBox, kBox, Engine::kClip},
    {kBox, kGem, Engine::kClip},           {kGem, kGem, Engine::kClip}};

Pose touching_pose(Random& random) { return {random.rotation(), random.in_box(0.35)}; }

TEST(Interference, AutoTakesTheFirstEngineThatServes) {
  Random random(2);
  for (const Served& pair : kServed) {
    EXPECT_EQ(engine_for(pair.a, pair.b), pair.engine);
    EXPECT_EQ(engine_for(pair.b, pair.a), pair.engine);
    EXPECT_EQ(evaluated(pair.a, pair.b, touching_pose(random)).engine, pair.engine);
    EXPECT_EQ(evaluated(pair.b, pair.a, touching_pose(random)).engine, pair.engine);
  }
  EXPECT_EQ(engine_for(kBox, kCan), Engine::kLines);
  EXPECT_EQ(evaluated(kBox, kCan, touching_pose(random)).engine, Engine::kLines);
  EXPECT_EQ(engine_for(kBox, kRing), Engine::kLines);
  EXPECT_EQ(evaluated(kBox, kRing, touching_pose(random)).engine, Engine::kLines);
  EXPECT_EQ(engine_for(kRing, kRing), Engine::kLines);
  EXPECT_EQ(evaluated(kRing, kRing, touching_pose(random)).engine, Engine::kLines);
}

TEST(Interference, ServesSaysWhichEnginesCan) {
  EXPECT_TRUE(serves(Engine::kClosedForm, kGround, kBall));
  EXPECT_TRUE(serves(Engine::kClosedForm, kBall, kGround));
  EXPECT_FALSE(serves(Engine::kClosedForm, kBox, kBall));
  EXPECT_FALSE(serves(Engine::kClip, kGround, kBall));
  EXPECT_TRUE(serves(Engine::kClip, kGem, kBox));
  EXPECT_TRUE(serves(Engine::kOctree, kGround, kBall));
  EXPECT_FALSE(serves(Engine::kOctree, kGround, kGround));
  for (const Served& pair : kServed) EXPECT_TRUE(serves(Engine::kAuto, pair.a, pair.b));
}

TEST(Interference, AnEngineThatDoesNotServeFallsBack) {
  Random random(3);
  const Pose X = touching_pose(random);
  const Interference forced = evaluated(kBox, kBox, X, {.engine = Engine::kClosedForm});
  EXPECT_EQ(forced.engine, Engine::kClip);
  EXPECT_EQ(forced.total.volume, evaluated(kBox, kBox, X).total.volume);
}

TEST(Interference, AForcedEngineIsUsed) {
  Random random(4);
  const Pose X = touching_pose(random);
  const Interference exact = evaluated(kBall, kBall, X);
  const Interference cells =
      evaluated(kBall, kBall, X, {.tolerance = 1e-2, .engine = Engine::kOctree});
  EXPECT_EQ(cells.engine, Engine::kOctree);
  EXPECT_NEAR(cells.total.volume, exact.total.volume, 1e-2 * exact.total.volume);
}

TEST(Interference, SwapIsTheMirror) {
  Random random(5);
  int directed = 0;
  for (const Served& pair : kServed) {
    for (int i = 0; i < 100; ++i) {
      const Pose X{random.rotation(), random.in_box(0.9)};
      const VolumeMetrics m = evaluated(pair.a, pair.b, X).total;
      const VolumeMetrics swapped = evaluated(pair.b, pair.a, X.inverse()).total;
      EXPECT_EQ(m.touching(), swapped.touching());
      if (m.volume < 1e-6) continue;
      directed += m.status == Status::kOk;
      EXPECT_TRUE(test::same(reversed(transformed(swapped, X)), m, {1e-9, 1.0}));
    }
  }
  EXPECT_GT(directed, 300);
}

TEST(Interference, MovingBothSolidsTogetherMovesTheMetrics) {
  Random random(6);
  InterferenceWorkspace workspace;
  for (const Served& shapes : kServed) {
    const GeometricPair pair{shapes.a, shapes.b, random.pose(0.2), random.pose(0.2)};
    for (int i = 0; i < 20; ++i) {
      const Pose X_WA = random.pose(0.3), X_WB = random.pose(0.3), X_VW = random.pose(1.0);
      Interference here, there;
      interference_W(pair, X_WA, X_WB, {}, workspace, here);
      interference_W(pair, X_VW * X_WA, X_VW * X_WB, {}, workspace, there);
      EXPECT_EQ(here.sites.size(), there.sites.size());
      if (here.total.volume < 1e-6) continue;
      EXPECT_TRUE(test::same(there.total, transformed(here.total, X_VW), {1e-9, 1.0}));
    }
  }
}

TEST(Interference, AreaVectorOfTheMirrorIsAGradientToo) {
  Random random(7);
  for (const Served& pair : kServed) {
    for (int i = 0; i < 10; ++i) {
      const Pose X{random.rotation(), random.in_box(0.5)};
      const auto volume = [&](const Pose& pose) {
        return evaluated(pair.b, pair.a, pose).total.volume;
      };
      const VolumeMetrics m = evaluated(pair.b, pair.a, X).total;
      if (m.volume < 1e-6 || m.status != Status::kOk) continue;
      const test::Gradient gradient = test::gradient_of_A(volume, X, 2e-5);
      EXPECT_LT((m.area_vector - gradient.shift).norm(), 1e-7);
      EXPECT_LT((m.area_moment - gradient.turn).norm(), 1e-7);
    }
  }
}

TEST(Interference, ExactEnginesGiveOneSiteAndItIsTheTotal) {
  Random random(8);
  for (const Served& pair : kServed) {
    const Interference result = evaluated(pair.a, pair.b, touching_pose(random));
    ASSERT_EQ(result.sites.size(), 1u);
    EXPECT_EQ(result.sites[0].volume, result.total.volume);
    EXPECT_EQ(result.sites[0].area_vector, result.total.area_vector);
  }
}

TEST(Interference, ApartIsAValueWithoutSites) {
  for (const Served& pair : kServed) {
    for (const auto& [a, b, z] : {std::tuple{pair.a, pair.b, 5.0}, {pair.b, pair.a, -5.0}}) {
      const Interference result = evaluated(a, b, Pose{Mat3::Identity(), Vec3(0, 0, z)});
      EXPECT_FALSE(result.total.touching());
      EXPECT_TRUE(result.sites.empty());
      EXPECT_EQ(result.total.status, Status::kOk);
      EXPECT_EQ(result.total.centroid, Vec3(Vec3::Zero()));
    }
  }
}

TEST(Interference, ANonFinitePoseIsInvalidAndLeavesNothingBehind) {
  Random random(9);
  InterferenceWorkspace workspace;
  Interference result;
  for (const Served& pair : kServed) {
    for (double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      interference(pair.a, pair.b, touching_pose(random), {}, workspace, result);
      EXPECT_TRUE(result.total.touching());
      Pose X = touching_pose(random);
      X.translation.y() = bad;
      interference(pair.a, pair.b, X, {}, workspace, result);
      EXPECT_EQ(result.total.status, Status::kInvalid);
      EXPECT_FALSE(result.total.touching());
      EXPECT_TRUE(is_finite(result.total));
      EXPECT_TRUE(result.sites.empty());
      X = touching_pose(random);
      X.rotation(1, 1) = bad;
      interference(pair.a, pair.b, X, {}, workspace, result);
      EXPECT_EQ(result.total.status, Status::kInvalid);
    }
  }
}

TEST(Interference, TwoHalfSpacesAreUnbounded) {
  Random random(10);
  for (Engine engine : kEngines) {
    const Interference result =
        evaluated(kGround, kGround, touching_pose(random), {.engine = engine});
    EXPECT_EQ(result.total.status, Status::kUnbounded);
    EXPECT_FALSE(result.total.touching());
    EXPECT_TRUE(result.sites.empty());
  }
}

TEST(Interference, TheValueHasNoHistory) {
  Random random(12);
  InterferenceWorkspace used;
  Interference result;
  std::vector<Pose> poses;
  for (int i = 0; i < 20; ++i) poses.push_back(touching_pose(random));
  for (const Served& pair : kServed) {
    for (const Pose& X : poses) {
      interference(pair.a, pair.b, X, {}, used, result);
      const Interference fresh = evaluated(pair.a, pair.b, X);
      EXPECT_EQ(result.total.volume, fresh.total.volume);
      EXPECT_EQ(result.total.inertia, fresh.total.inertia);
      EXPECT_EQ(result.total.area_moment, fresh.total.area_moment);
      EXPECT_EQ(result.total.depth_moment, fresh.total.depth_moment);
    }
  }
}

// A peg that is off the axis of its bore by e presses on the wall by e less the play, whatever the
// engine and the way the solids are written. The crescent of the overlap reaches much farther.
TEST(Interference, DepthMeansTheSameInEveryEngine) {
  const double r = 0.005, play = 2e-5, e = 2.13e-5;
  const int sides = 720;
  const Cylinder peg({.radius = r, .half_length = 0.02});
  const Csg block(Csg::Operation::kDifference, Csg(Box({.half_sizes = Vec3(0.02, 0.02, 0.01)})),
                  Csg(Cylinder({.radius = r + play, .half_length = 0.03})));
  const Mesh peg_mesh = test::mesh_of(test::regular_prism_soup(sides, r, 0.02));
  const Mesh sleeve = test::mesh_of(test::ring_soup(r + play, 0.02, 0.01, sides));
  const double facet = r * (1.0 - std::cos(kPi / sides));  // of play that facets take or give
  const std::tuple<Shape, Shape, Engine> cases[] = {{block, peg, Engine::kLines},
                                                    {block, peg, Engine::kOctree},
                                                    {block, peg_mesh, Engine::kColumns},
                                                    {sleeve, peg_mesh, Engine::kColumns},
                                                    {sleeve, peg, Engine::kColumns}};
  int number = 0;
  for (const auto& [a, b, engine] : cases) {
    const Pose X_AB = test::shifted(e, 0.0, 0.0);
    for (const Interference& out :
         {evaluated(a, b, X_AB, engine), evaluated(b, a, X_AB.inverse(), engine)}) {
      EXPECT_EQ(out.engine, engine);
      ASSERT_EQ(out.sites.size(), 1u) << number;
      EXPECT_NEAR(out.total.depth, e - play, 2.0 * facet) << number;
      EXPECT_EQ(out.sites[0].depth, out.total.depth) << number;
    }
    ++number;
  }
}

// Of a tip or ball on a plane face it is how far that reaches below the face.
TEST(Interference, DepthIsHowFarATipReachesBelowAFace) {
  const double depth = 0.01;
  const Vec3 half(0.3, 0.3, 0.2);
  const Box box({.half_sizes = half});
  const Mesh mesh = test::mesh_of(test::box_soup(half, 2));
  const Vec3 corner(0.1, 0.1, 0.1);
  const Mat3 R = test::turn(Vec3(1.0, 2.0, 3.0), 0.4);
  const Box tip({.half_sizes = corner});
  const double reach = tip.support_height(-R.row(2));
  const Sphere ball({.radius = 0.1});
  for (const Shape& ground : {Shape(box), Shape(mesh)}) {
    for (const Shape& other : {Shape(tip), Shape(test::mesh_of(test::box_soup(corner, 3)))}) {
      const Pose X_AB{R, Vec3(0.02, 0.03, 0.2 + reach - depth)};
      EXPECT_NEAR(evaluated(ground, other, X_AB).total.depth, depth, 1e-12);
      EXPECT_NEAR(evaluated(other, ground, X_AB.inverse()).total.depth, depth, 1e-12);
      if (test::kSanitized && std::holds_alternative<Mesh>(ground)) continue;
      EXPECT_NEAR(evaluated(ground, other, X_AB, Engine::kOctree).total.depth, depth, 0.1 * depth);
    }
    const Pose X_AB = test::shifted(0.02, 0.03, 0.3 - depth);
    EXPECT_NEAR(evaluated(ground, ball, X_AB).total.depth, depth, 0.05 * depth);
    EXPECT_NEAR(evaluated(ground, ball, X_AB, Engine::kOctree).total.depth, depth, 0.05 * depth);
  }
}

}  // namespace
}  // namespace volcontact::interference_test
