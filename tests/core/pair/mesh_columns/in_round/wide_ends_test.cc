// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/support/evaluated.h"
#include "core/support/meshes.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"

namespace volcontact::wide_ends_test {
namespace {

using test::box_soup;
using test::evaluated;
using test::mesh_of;

const Vec3 kHalf(0.4, 0.3, 0.2);

// A frustum on the top of a box, with its wide end down.
struct WideEnd {
  Frustum frustum;
  double wide, half_length;
};
WideEnd wide_end(test::Random& random) {
  const double wide = random.uniform(0.02, 0.15), narrow = wide * random.uniform(0.1, 0.95);
  const double half = random.uniform(0.03, 0.25);
  return {Frustum({.bottom_radius = wide, .top_radius = narrow, .half_length = half}), wide, half};
}

// The wall leans out over the face all round: no straight columns see the layer whole, and seen
// from behind it is what all of the frustum leaves. V is that with a half-space, a closed form.
TEST(WideEnds, LieOnAFaceAsOnAHalfSpace) {
  const Mesh box = mesh_of(box_soup(kHalf, 2));
  test::Random random(12);
  for (int i = 0; i < test::cases(150, 30); ++i) {
    const WideEnd end = wide_end(random);
    const double depth = random.log_uniform(1e-13, 1e-3);
    const double lean = i % 2 == 0 ? 0.0 : random.uniform(0.0, 0.2) * depth / end.wide;
    const Mat3 turned =
        test::turn(Vec3::UnitZ(), random.uniform(0.0, 2.0 * kPi)) * test::turn(Vec3::UnitX(), lean);
    Pose X{turned, random.in_box(0.1)};
    X.translation.z() = end.half_length - depth;
    const VolumeMetrics expected = evaluated(HalfSpace(), end.frustum, X).total;
    X.translation.z() += kHalf.z();
    const VolumeMetrics m = evaluated(box, end.frustum, X).total;
    // The face is where 0.2 m and the half length add up to.
    const double rounding = 1e-16 * kPi * end.wide * end.wide;
    EXPECT_NEAR(m.volume, expected.volume, m.volume_error + rounding) << "depth " << depth;
    EXPECT_LE(m.volume_error, 3e-3 * expected.volume + rounding) << "depth " << depth;
    EXPECT_LT((m.area_vector - expected.area_vector).norm(), 2e-3 * expected.area);
    EXPECT_NEAR(m.depth, expected.depth, 0.02 * expected.depth + 1e-16);
    EXPECT_NEAR(m.depth_moment, expected.depth_moment,
                0.02 * expected.depth_moment + 1e-16 * m.volume);
  }
}

// Over an edge of the face a part of the outline has no wall, and what slivers at the wall hold is
// a layer as thick as all the rest. V is that with the box itself, by lines.
TEST(WideEnds, LieOverAnEdgeAsOnABox) {
  const Mesh mesh = mesh_of(box_soup(kHalf, 2));
  const Box box({.half_sizes = kHalf});
  test::Random random(13);
  for (int i = 0; i < test::cases(100, 20); ++i) {
    const WideEnd end = wide_end(random);
    const double depth = random.log_uniform(1e-8, 1e-3);
    const Pose X{test::turn(Vec3::UnitZ(), random.uniform(0.0, 2.0 * kPi)),
                 Vec3(kHalf.x() + random.uniform(-0.9, 0.9) * end.wide, random.uniform(-0.1, 0.1),
                      kHalf.z() + end.half_length - depth)};
    const VolumeMetrics expected = evaluated(box, end.frustum, X, {.tolerance = 1e-6}).total;
    const VolumeMetrics m = evaluated(mesh, end.frustum, X).total;
    EXPECT_NEAR(m.volume, expected.volume,
                m.volume_error + expected.volume_error + 1e-6 * expected.volume)
        << "depth " << depth << " of " << end.wide;
  }
}

// The end of a slender capsule at an edge of a box, seen from a point far back in the capsule: what
// is behind a triangle bends where the ball meets the tube. V is that with the box itself.
TEST(WideEnds, OfSlenderCapsulesMeetEdgesAsThoseOfABox) {
  const Mesh mesh = mesh_of(box_soup(kHalf, 1));
  const Box box({.half_sizes = kHalf});
  test::Random random(14);
  for (int i = 0; i < test::cases(400, 60); ++i) {
    const Capsule capsule({.radius = random.log_uniform(2e-3, 2e-2), .half_length = 0.2});
    const Mat3 turned = random.rotation();
    const Vec3 tip = turned * Vec3(0.0, 0.0, capsule.half_length());
    const Vec3 at = kHalf + random.in_box(2.0 * capsule.radius()) - random.uniform(0.0, 0.3) * tip;
    const Pose X{turned, at - tip};
    const VolumeMetrics expected = evaluated(box, capsule, X, {.tolerance = 1e-6}).total;
    const VolumeMetrics m = evaluated(mesh, capsule, X).total;
    EXPECT_NEAR(m.volume, expected.volume,
                m.volume_error + expected.volume_error + 1e-6 * expected.volume)
        << "case " << i;
  }
}

}  // namespace
}  // namespace volcontact::wide_ends_test
