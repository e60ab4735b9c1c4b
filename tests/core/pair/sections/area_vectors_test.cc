// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/support/evaluated.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"

namespace volcontact::area_vectors_test {
namespace {

using test::evaluated;

// S of lines beside that of the surface sweep, which sums over surfaces where lines sum over
// columns: no farther off than a few times the tolerance asked, and the finer the finer that is.
TEST(AreaVectors, OfCylindersAndFrustaFollowTheTolerance) {
  constexpr double kShare = 5.0;  // of the tolerance, per area; 4 in 100,000 poses
  test::Random random(77);
  int judged = 0;
  for (int i = 0; i < test::cases(800, 120); ++i) {
    const Cylinder cylinder(
        {.radius = random.uniform(0.05, 0.4), .half_length = random.uniform(0.05, 0.4)});
    const double wide = random.uniform(0.05, 0.4);
    const Frustum frustum({.bottom_radius = wide,
                           .top_radius = wide * random.uniform(0.05, 1.0),
                           .half_length = random.uniform(0.05, 0.4)});
    const Pose X{random.rotation(), random.in_box(0.3)};
    const Interference sweep = evaluated(cylinder, frustum, X, Engine::kSurfaceSweep, 1e-4);
    if (sweep.engine != Engine::kSurfaceSweep || !sweep.total.touching()) continue;
    if (sweep.total.status != Status::kOk) continue;
    ++judged;
    const double area = std::max(sweep.total.area, sweep.total.counter_area);
    for (const double tolerance : {1e-3, 1e-4}) {
      const Interference lines = evaluated(cylinder, frustum, X, Engine::kLines, tolerance);
      if (lines.engine != Engine::kLines || lines.total.status != Status::kOk) continue;
      EXPECT_LT((lines.total.area_vector - sweep.total.area_vector).norm(),
                kShare * tolerance * area)
          << i << " at " << tolerance;
    }
  }
  EXPECT_GT(judged, test::cases(300, 40));
}

}  // namespace
}  // namespace volcontact::area_vectors_test
