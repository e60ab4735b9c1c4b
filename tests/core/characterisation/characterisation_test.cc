// SPDX-License-Identifier: Apache-2.0
#include "core/search/characterisation.h"

#include <gtest/gtest.h>

#include "core/support/sanitized.h"

namespace volcontact::test::characterisation_test {
namespace {

constexpr Effort kEffort{
    .poses = 3, .gradient_poses = 1, .motion_steps = 5, .octree_poses = 1, .slow_octree_poses = 0};

/// What an engine promises, relative: docs/theory.md, "Engines". tests/benchmarks/characterise
/// measures it over more poses.
struct Promise {
  double volume;       // of every pose, beyond the doubt about the reference
  double usual;        // the median of V
  double moments;      // centroid by radius of gyration, inertia relative
  double area_vector;  // by A's area in the overlap, the median
  double gradient;     // finite differences of V, likewise
  double noise;        // of the increments of V
};

bool has_many_faces(const Example& e) {
  return std::holds_alternative<ConvexPolytope>(e.shape) || std::holds_alternative<Mesh>(e.shape);
}

Promise promise_of(Engine engine, const Example& a, const Example& b) {
  switch (engine) {
    case Engine::kClosedForm:
    case Engine::kClip:
      // Exact: these are the errors of the reference.
      return {1e-8, 1e-8, 1e-6, 1e-4, 5e-4, 1e-5};
    case Engine::kOctree:
      return {kEffort.octree_tolerance, kEffort.octree_tolerance, 0.05, 0.1, 0.3, 0.2};
    default:
      return {1e-3, has_many_faces(a) || has_many_faces(b) ? 1e-4 : 1e-5, 5e-3, 1e-3, 1e-2, 1e-2};
  }
}

// Both orders of some pairs and every engine that serves them, against an integral that shares
// nothing with the engines. tests/benchmarks/characterise runs all pairs.
using NamedPair = std::pair<const char*, const char*>;
class Accuracy : public ::testing::TestWithParam<NamedPair> {};

const Example& find(const std::string& name) {
  for (const Example& e : examples()) {
    if (e.name == name) return e;
  }
  return examples().front();
}

TEST_P(Accuracy, EveryEngineKeepsItsPromise) {
  const Example &a = find(GetParam().first), &b = find(GetParam().second);
  int compared = 0;
  Effort effort = kEffort;
  if (a.name == "torus" || b.name == "torus") {  // whose reference takes a second a pose
    effort.poses = test::cases(kEffort.poses, 1, 1);
  }
  for (const Characterisation& row : characterise(a, b, effort)) {
    const Promise promise = promise_of(row.engine, a, b);
    SCOPED_TRACE(row.a->name + " - " + row.b->name + ", " + to_string(row.engine));
    compared += row.poses;
    EXPECT_LE(row.volume_beyond, promise.volume);
    EXPECT_LE(row.volume.median, promise.usual + 2.0 * row.reference_error);
    EXPECT_LE(row.centroid.worst, promise.moments);
    EXPECT_LE(row.inertia.worst, promise.moments);
    EXPECT_LE(row.area_vector.median, promise.area_vector);
    EXPECT_LE(row.area_moment.median, promise.area_vector);
    EXPECT_LE(row.gradient.median, promise.gradient);
    EXPECT_LE(row.turn.median, promise.gradient);
    EXPECT_LE(row.noise.value_or(0.0), promise.noise);
    EXPECT_EQ(row.missed, 0);
    if (row.engine == Engine::kOctree) {
      EXPECT_EQ(row.bounds_held, row.poses);
    }
  }
  EXPECT_GT(compared, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Pairs, Accuracy,
    ::testing::Values(NamedPair{"half_space", "sphere"}, NamedPair{"half_space", "ellipsoid"},
                      NamedPair{"half_space", "capsule"}, NamedPair{"half_space", "cylinder"},
                      NamedPair{"half_space", "frustum"}, NamedPair{"half_space", "torus"},
                      NamedPair{"half_space", "box"}, NamedPair{"sphere", "sphere"},
                      NamedPair{"box", "box"}, NamedPair{"box", "convex_polytope"},
                      NamedPair{"sphere", "cylinder"}, NamedPair{"sphere", "bored_block"},
                      NamedPair{"ellipsoid", "box"}, NamedPair{"capsule", "cylinder"},
                      NamedPair{"cylinder", "box"}, NamedPair{"cylinder", "hollow_cylinder"},
                      NamedPair{"frustum", "ellipsoid"}, NamedPair{"capsule", "convex_polytope"},
                      NamedPair{"sphere", "torus"}, NamedPair{"torus", "box"},
                      NamedPair{"cylinder", "torus"}, NamedPair{"torus", "convex_polytope"},
                      NamedPair{"torus", "torus"}, NamedPair{"box", "mesh"},
                      NamedPair{"sphere", "mesh"}, NamedPair{"cylinder", "mesh"},
                      NamedPair{"mesh", "torus"}, NamedPair{"bored_block", "mesh"},
                      NamedPair{"bored_block", "bored_block"},
                      NamedPair{"bored_block", "hollow_cylinder"},
                      NamedPair{"hollow_cylinder", "cup"}),
    [](const auto& test) { return std::string(test.param.first) + "_" + test.param.second; });

TEST(Spread, MedianAndWorst) {
  const Spread spread = spread_of({3.0, 1.0, 2.0});
  EXPECT_EQ(spread.median, 2.0);
  EXPECT_EQ(spread.worst, 3.0);
  EXPECT_EQ(spread_of({}).worst, 0.0);
}

}  // namespace
}  // namespace volcontact::test::characterisation_test
