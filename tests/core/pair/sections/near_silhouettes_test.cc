// SPDX-License-Identifier: Apache-2.0
// A capsule's tube in a ball that is slightly wider: beyond where the columns end, the ball's turn
// back lies near, and the rule along a half-plane converges less fast. The volume is a closed form.
#include <gtest/gtest.h>

#include <cmath>

#include "core/support/evaluated.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"

namespace volcontact::near_silhouettes_test {
namespace {

// Of both ends of the ball beyond the tube, and the tube between.
double volume(double tube, double ball) {
  const double z = std::sqrt(ball * ball - tube * tube), height = ball - z;
  const double cap = kPi * height * height * (3.0 * ball - height) / 3.0;
  return 2.0 * cap + 2.0 * kPi * tube * tube * z;
}

TEST(NearSilhouettes, AreWithinTheErrorThatIsTold) {
  for (const double wider : {1.001, 1.01, 1.02, 1.04, 1.05, 1.06, 1.061, 1.065, 1.08, 1.1, 1.2}) {
    for (const double tube : {0.05, 0.2}) {
      if (test::kSanitized && tube > 0.1) continue;
      const Capsule capsule({.radius = tube, .half_length = 2.0 * tube});
      const Sphere ball({.radius = wider * tube});
      const double expected = volume(tube, wider * tube);
      for (const double along : {0.0, 0.3}) {
        for (const double angle : {0.0, 0.4, 1.1, 2.3}) {
          if (test::kSanitized && angle > 0.4) continue;
          const Pose X{test::turn(Vec3::UnitZ(), angle) * test::turn(Vec3::UnitX(), angle),
                       Vec3(0.0, 0.0, along * tube)};
          for (const double tolerance : {1e-3, 1e-4, 3e-5, 1e-6}) {
            InterferenceOptions options;
            options.tolerance = tolerance;
            for (const Interference& found :
                 {test::evaluated(capsule, ball, X, options),
                  test::evaluated(ball, capsule, X.inverse(), options)}) {
              EXPECT_NEAR(found.total.volume, expected, found.total.volume_error)
                  << "ball " << wider << " times as wide, tolerance " << tolerance;
              if (found.total.status != Status::kOk) continue;
              EXPECT_LE(found.total.volume_error, (tolerance + 2.5e-5) * expected);
            }
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace volcontact::near_silhouettes_test
