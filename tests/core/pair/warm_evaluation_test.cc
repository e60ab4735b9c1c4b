// SPDX-License-Identifier: Apache-2.0
// An evaluation whose workspace has seen the pair asks the heap for nothing.
#include <gtest/gtest.h>

#include <new>
#include <vector>

#include "adaptor/support/fail_allocations.h"
#include "core/support/random_shapes.h"
#include "volcontact/pair/interference.h"

namespace volcontact::warm_evaluation_test {
namespace {

using test::AllocationLimit;
using test::Random;

struct Pair {
  const char* name;
  Shape a, b;
};

Shape bored_block() {
  return Csg(Csg::Operation::kDifference, Csg(Box({.half_sizes = Vec3(0.5, 0.5, 0.4)})),
             Csg(Cylinder({.radius = 0.31, .half_length = 1.0})));
}

std::vector<Pair> pairs() {
  Random random(1);
  const Shape ground = HalfSpace();
  const Shape ball = Sphere({.radius = 0.5});
  const Shape box = Box({.half_sizes = Vec3(0.5, 0.4, 0.3)});
  const Shape gem = test::random_polytope(12, random);
  const Shape can = Cylinder({.radius = 0.3, .half_length = 0.4});
  const Shape ring = Torus({.major_radius = 0.3, .minor_radius = 0.1});
  return {{"ground and ball", ground, ball},
          {"ground and egg", ground, Ellipsoid({.semi_axes = Vec3(0.5, 0.4, 0.3)})},
          {"ground and can", ground, can},
          {"ground and pill", ground, Capsule({.radius = 0.3, .half_length = 0.2})},
          {"ground and cup", ground,
           Frustum({.bottom_radius = 0.3, .top_radius = 0.5, .half_length = 0.4})},
          {"ground and ring", ground, ring},
          {"two balls", ball, ball},
          {"ground and box", ground, box},
          {"ground and gem", ground, gem},
          {"two boxes", box, box},
          {"box and gem", box, gem},
          {"two gems", gem, gem},
          {"box and can", box, can},
          {"bored block and can", bored_block(), can},
          {"ring and can", ring, can},
          {"ring and box", ring, box}};
}

// The functions that count here throw at the first request.
void expect_no_request(const char* name, const Shape& a, const Shape& b,
                       const std::vector<Pose>& poses) {
  InterferenceWorkspace workspace;
  Interference result;
  for (const Pose& X : poses) interference(a, b, X, {}, workspace, result);
  bool asked = false;
  try {
    const AllocationLimit none(0);
    for (const Pose& X : poses) interference(a, b, X, {}, workspace, result);
  } catch (const std::bad_alloc&) {
    asked = true;
  }
  EXPECT_FALSE(asked) << name;
}

TEST(WarmEvaluation, AllocatesNothing) {
  Random random(11);
  for (const Pair& pair : pairs()) {
    std::vector<Pose> poses;
    for (int i = 0; i < 50; ++i) poses.push_back({random.rotation(), random.in_box(0.9)});
    expect_no_request(pair.name, pair.a, pair.b, poses);
    expect_no_request(pair.name, pair.b, pair.a, poses);
  }
}

// A ball that touches the wall of the bore by a nanometre.
TEST(WarmEvaluation, OfAFilmAllocatesNothing) {
  const Shape block = bored_block();
  const Shape ball = Sphere({.radius = 0.2});
  const Pose X{Mat3::Identity(), {0.31 - 0.2 + 1e-9, 0.0, 0.0}};
  InterferenceWorkspace workspace;
  Interference result;
  interference(block, ball, X, {}, workspace, result);
  EXPECT_GT(result.total.volume, 0.0);
  expect_no_request("film", block, ball, {X});
}

}  // namespace
}  // namespace volcontact::warm_evaluation_test
