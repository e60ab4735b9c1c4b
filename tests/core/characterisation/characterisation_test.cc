// SPDX-License-Identifier: Apache-2.0
#include "core/support/characterisation.h"

#include <gtest/gtest.h>

namespace volcontact::test {
namespace {

// The sanitizers make every pose a hundred times slower and look for other faults: fewer will do.
#if defined(__SANITIZE_ADDRESS__)
constexpr Effort kEffort{.poses = 1, .gradient_poses = 0, .motion_steps = 0, .octree_poses = 0};
#else
constexpr Effort kEffort{.poses = 3, .gradient_poses = 1, .motion_steps = 5, .octree_poses = 1};
#endif

/// What an engine promises. tests/benchmarks/characterise measures it over more poses.
struct Promise {
  double volume;       // relative, of every pose
  double moments;      // centroid by radius of gyration, inertia relative
  double area_vector;  // by A's area in the overlap, the median
  double gradient;     // finite differences of V, likewise
  double noise;        // of the increments of V
};

Promise promise_of(Engine engine) {
  switch (engine) {
    case Engine::kClosedForm:
    case Engine::kClip:
      // Exact: this is the error of the reference, whose areas are less good than its volumes.
      return {1e-6, 1e-5, 1e-3, 1e-4, 1e-4};
    case Engine::kOctree:
      return {kEffort.octree_tolerance, 0.05, 0.1, 0.3, 0.2};
    default:
      return {1e-2, 0.05, 0.02, 0.05, 0.05};
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
  for (const Characterisation& row : characterise(a, b, kEffort)) {
    const Promise promise = promise_of(row.engine);
    SCOPED_TRACE(row.a->name + " - " + row.b->name + ", " + to_string(row.engine));
    compared += row.poses;
    EXPECT_LE(row.volume.worst, promise.volume);
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
                      NamedPair{"sphere", "sphere"}, NamedPair{"half_space", "box"},
                      NamedPair{"box", "box"}, NamedPair{"ellipsoid", "box"},
                      NamedPair{"sphere", "cylinder"}),
    [](const auto& test) { return std::string(test.param.first) + "_" + test.param.second; });

TEST(Spread, MedianAndWorst) {
  const Spread spread = spread_of({3.0, 1.0, 2.0});
  EXPECT_EQ(spread.median, 2.0);
  EXPECT_EQ(spread.worst, 3.0);
  EXPECT_EQ(spread_of({}).worst, 0.0);
}

}  // namespace
}  // namespace volcontact::test
