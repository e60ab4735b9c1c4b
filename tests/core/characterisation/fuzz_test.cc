// SPDX-License-Identifier: Apache-2.0
#include "core/search/fuzz.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/support/sanitized.h"

namespace volcontact::test::fuzz_test {
namespace {

// A sample of what tests/benchmarks/fuzz_pairs searches, half of it aligned, flush or barely
// touching. Pairs that the octree serves, or may have to (composed solids with cones), are too slow
// for it.
TEST(Fuzz, NoPairFails) {
  for (const char* pair :
       {"half_space-capsule", "sphere-sphere", "box-box", "ellipsoid-box", "cylinder-sphere",
        "box-capsule", "box-cylinder", "frustum-box", "cylinder-frustum"}) {
    const int poses = test::cases(40, 10, 10);
    const FuzzReport report =
        fuzz({.random_poses = poses, .degenerate_poses = poses, .seed = 7, .only = pair});
    int overlapping = 0;
    for (const FuzzCount& count : report.counts) overlapping += count.overlapping;
    EXPECT_GT(overlapping, 0) << pair;
    for (const FuzzFailure& f : report.failures) {
      ADD_FAILURE() << to_string(f.engine) << ", " << f.a << " - " << f.b << ": " << f.what
                    << ", V = " << f.volume << ", expected " << f.expected
                    << "; X_AB = " << literal(f.X_AB);
    }
  }
}

TEST(Fuzz, EveryAnswerCountsForTheEngineThatGaveIt) {
  const FuzzReport report =
      fuzz({.random_poses = 6, .degenerate_poses = 0, .seed = 7, .only = "box-mesh"});
  for (const FuzzCount& count : report.counts) {
    const bool is_it = count.engine == Engine::kColumns && !count.degenerate;
    EXPECT_EQ(count.poses, is_it ? 6 : 0) << to_string(count.engine);
  }
}

// Solids without volume overlap nothing; the answer is finite and says so.
TEST(Fuzz, SolidsOfZeroSize) {
  Random random(8);
  InterferenceWorkspace workspace;
  Interference out;
  for (const Shape& a : flat_solids()) {
    for (const Example& b : examples()) {
      for (int i = 0; i < 4; ++i) {
        const Pose X_AB = i == 0 ? Pose{} : random.pose(0.2);
        for (const bool swap : {false, true}) {
          interference(swap ? b.shape : a, swap ? a : b.shape, X_AB, {.tolerance = 0.1}, workspace,
                       out);
          EXPECT_TRUE(is_finite(out.total)) << name_of(a) << " - " << b.name;
          EXPECT_LE(out.total.volume, 1e-9) << name_of(a) << " - " << b.name;
        }
      }
    }
  }
}

TEST(Fuzz, NumbersThatAreNone) {
  InterferenceWorkspace workspace;
  Interference out;
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity}) {
    for (int i = 0; i < 12; ++i) {
      Pose X_AB;
      if (i < 9) X_AB.rotation(i / 3, i % 3) = bad;
      if (i >= 9) X_AB.translation[i - 9] = bad;
      for (const Example& a : examples()) {
        for (const Example& b : examples()) {
          interference(a.shape, b.shape, X_AB, {}, workspace, out);
          EXPECT_EQ(out.total.status, Status::kInvalid) << a.name << " - " << b.name;
          EXPECT_EQ(out.total.volume, 0.0);
          EXPECT_TRUE(out.sites.empty());
        }
      }
    }
  }
}

TEST(Fuzz, PosesAreWrittenSoThatTheyCanBeReadBack) {
  EXPECT_EQ(literal(Pose{}), "Pose{Mat3(1, 0, 0, 0, 1, 0, 0, 0, 1), Vec3(0, 0, 0)}");
}

}  // namespace
}  // namespace volcontact::test::fuzz_test
