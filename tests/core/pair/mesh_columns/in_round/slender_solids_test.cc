// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/support/evaluated.h"
#include "core/support/meshes.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"

namespace volcontact::slender_solids_test {
namespace {

using test::box_soup;
using test::evaluated;
using test::mesh_of;

// A rod that lies in a face of a large box or leans out of it meets that face alone: V is that with
// a half-space, a closed form. The face has two triangles, of which a few points see little of it.
TEST(SlenderSolids, LieInAFaceAsInAHalfSpace) {
  constexpr double kRadius = 0.02, kHalf = 0.3;
  const Mesh box = mesh_of(box_soup({0.8, 0.8, 0.8}, 1));
  const Shape rods[] = {
      Capsule({.radius = kRadius, .half_length = kHalf}),
      Cylinder({.radius = kRadius, .half_length = kHalf}),
      Ellipsoid({.semi_axes = {kRadius, kRadius, kHalf}}),
      Frustum({.bottom_radius = kRadius, .top_radius = 0.9 * kRadius, .half_length = kHalf})};
  test::Random random(4);
  for (const Shape& rod : rods) {
    for (const double most : {0.0, 0.01, 0.1}) {
      for (int i = 0; i < test::cases(40, 3); ++i) {
        const Mat3 lying = test::turn(Vec3::UnitY(), 0.5 * kPi + most * random.uniform(-1.0, 1.0));
        Pose X{test::turn(Vec3::UnitZ(), random.uniform(0.0, 2.0 * kPi)) * lying,
               random.in_box(0.1)};
        X.translation.z() = 0.9 * kRadius * random.uniform(-1.0, 1.0);
        const VolumeMetrics expected = evaluated(HalfSpace(), rod, X).total;
        X.translation.z() += 0.8;
        const VolumeMetrics m = evaluated(box, rod, X).total;
        EXPECT_NEAR(m.volume, expected.volume,
                    m.volume_error + expected.volume_error + 1e-9 * expected.volume)
            << rod.index() << " leans by " << most;
      }
    }
  }
}

}  // namespace
}  // namespace volcontact::slender_solids_test
