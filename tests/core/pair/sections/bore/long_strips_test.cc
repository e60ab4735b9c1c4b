// SPDX-License-Identifier: Apache-2.0
// A capsule across the chamfer of a pipe: without the bore the overlap were a strip nine times as
// long as wide, whose outline is not round from any frame about the axis. The octree is the oracle.
#include <gtest/gtest.h>

#include "core/support/csg_solids.h"
#include "core/support/evaluated.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"
#include "volcontact/shape/csg/csg.h"

namespace volcontact::long_strips_test {
namespace {

using test::evaluated;

TEST(LongStrips, ACapsuleAcrossAChamferTouchesOnBothSides) {
  using namespace testing;
  constexpr double kBore = 0.1279, kChamfer = 0.02, kRadius = 0.4213, kHalf = 0.05;
  const Pose at_the_end{Mat3::Identity(), Vec3(0.0, 0.0, kHalf - 0.5 * kChamfer)};
  const Csg pipe = tube(kRadius, kHalf) - tube(kBore, 0.2) -
                   cone(kBore, kBore + kChamfer, 0.5 * kChamfer, at_the_end);
  const Capsule capsule({.radius = 0.32462, .half_length = kRadius});
  test::Random random(39);
  double expected = 0.0, bound = 0.0;
  for (int i = 0; i < test::cases(300, 30); ++i) {
    const Mat3 turned = test::turn(random.direction(), random.log_uniform(1e-9, 1e-4)) *
                        test::turn(Vec3::UnitX(), -0.5 * kPi);
    const Pose X{turned, Vec3(0.09036, 0.0904, 0.37128) + 1e-7 * random.direction()};
    if (i == 0) {
      const VolumeMetrics m = evaluated(pipe, capsule, X, Engine::kOctree, 1e-3).total;
      expected = m.volume;
      bound = m.volume_error;
    }
    const Interference found = evaluated(pipe, capsule, X);
    // A turn by 1e-4 and a shift by 1e-7 change V by less than 1 %.
    EXPECT_NEAR(found.total.volume, expected, found.total.volume_error + bound + 0.01 * expected)
        << i << " " << to_string(found.engine);
  }
}

}  // namespace
}  // namespace volcontact::long_strips_test
