// SPDX-License-Identifier: Apache-2.0
// A corner of what lies in a bore may stick out of its wall between two places that were looked at.
// Volumes are those with the block less those with what is cut out, each of two convex solids.
#include <gtest/gtest.h>

#include <cmath>

#include "core/support/evaluated.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"
#include "volcontact/shape/csg/csg.h"

namespace volcontact::corner_lobes_test {
namespace {

using test::evaluated;

Csg without(const SimpleShape& block, const SimpleShape& bore) {
  return {Csg::Operation::kDifference, Csg(block), Csg(bore)};
}

// Of a block with a bore and a solid, where the bore reaches through the block.
void expect_the_difference(const Box& block, const Cylinder& bore, const Shape& solid,
                           const Pose& X) {
  const VolumeMetrics m = evaluated(without(block, bore), solid, X, Engine::kLines).total;
  const Cylinder within({.radius = bore.radius(), .half_length = block.half_sizes().z()});
  const VolumeMetrics all = evaluated(block, solid, X, Engine::kAuto, 1e-6).total;
  const VolumeMetrics cut = evaluated(within, solid, X, Engine::kAuto, 1e-6).total;
  const double doubt = m.volume_error + all.volume_error + cut.volume_error;
  EXPECT_NEAR(m.volume, all.volume - cut.volume, doubt + 1e-6 * all.volume) << X.translation;
}

// As the random search found them: both orders alike wrong, and one of them.
TEST(CornerLobes, ABarAcrossACounterboreHasTwo) {
  Pose X;
  X.rotation =
      Mat3(-0.73887609130601584, -0.67384131789045421, 0, 0.47647776532402025, -0.52246429461909449,
           -0.70710678118654746, 0.4764777653240202, -0.52246429461909438, 0.70710678118654757);
  X.translation = Vec3(0.0, 0.0, -0.3999999999145139 + 0.0592595676864);
  const double half = 0.5 * (0.15 + 0.03148086462718191);
  expect_the_difference(Box({.half_sizes = Vec3(0.31494049679878333, 0.46494049679878335, half)}),
                        Cylinder({.radius = 0.15, .half_length = 0.3}),
                        Box({.half_sizes = Vec3(0.25, 0.15, 0.4)}), X);
}

// Two corners between two places: the curve bends at both of them.
TEST(CornerLobes, ARimThatLeavesAFaceHasOne) {
  Pose X;
  X.rotation = Mat3(-0.7175692032051646, 0.1339598876377063, 0.6834831286254236,
                    -0.43765016337304852, 0.67666790137017174, -0.5921004017519591,
                    -0.54180879755781775, -0.72399951640825044, -0.42692848011062745);
  X.translation = Vec3(-0.23511808110027529, 0.553045070529929, -0.32827318856586341);
  expect_the_difference(
      Box({.half_sizes = Vec3(0.66878710616658532, 0.7687871061665853, 0.38953901186701345)}),
      Cylinder({.radius = 0.37545033015380308, .half_length = 0.48953901186701343}),
      Cylinder({.radius = 0.66878710678988817, .half_length = 0.66878710616972725}), X.inverse());
}

TEST(CornerLobes, RandomBarsAndCansHaveAllOfThem) {
  test::Random random(11);
  const Box block({.half_sizes = Vec3(0.4, 0.45, 0.1)});
  for (int i = 0; i < test::cases(400, 40); ++i) {
    const Cylinder bore({.radius = random.uniform(0.1, 0.35), .half_length = 0.2});
    const Vec3 half = Vec3(0.2, 0.2, 0.2) + random.in_box(0.12);
    const Pose X = random.pose(0.2);
    if (i % 2 == 0) {
      expect_the_difference(block, bore, Box({.half_sizes = half}), X);
    } else {
      expect_the_difference(block, bore, Cylinder({.radius = half.x(), .half_length = half.y()}),
                            X);
    }
  }
}

}  // namespace
}  // namespace volcontact::corner_lobes_test
