// SPDX-License-Identifier: Apache-2.0
#include "core/support/reference_integral.h"

#include <gtest/gtest.h>

#include "core/support/contact_poses.h"

namespace volcontact::test {
namespace {

Reference integral(const Shape& a, const Shape& b, const Pose& X_AB, const Vec3& inside,
                   double range) {
  Random random(4);
  return reference_integral(reference_solid(a), reference_solid(b), X_AB,
                            {{random.rotation(), inside}, range});
}

// Closed form of a spherical cap of height h: V = pi h^2 (R - h/3), flat area pi h (2 R - h).
TEST(ReferenceIntegral, CapOfABall) {
  constexpr double kRadius = 0.5, kHeight = 0.2;
  const Pose X_AB{Mat3::Identity(), Vec3(0.0, 0.0, kRadius - kHeight)};
  const Reference r =
      integral(HalfSpace(), Sphere({.radius = kRadius}), X_AB, Vec3(0.0, 0.0, -kHeight / 2.0), 1.0);
  const double volume = kPi * kHeight * kHeight * (kRadius - kHeight / 3.0);
  const double disc = kPi * kHeight * (2.0 * kRadius - kHeight);
  EXPECT_NEAR(r.metrics.volume, volume, 1e-7 * volume);
  EXPECT_LT(r.volume_error, 1e-7 * volume);
  EXPECT_NEAR(r.metrics.area, disc, 1e-4 * disc);
  EXPECT_NEAR(r.metrics.counter_area, 2.0 * kPi * kRadius * kHeight, 1e-4 * disc);
  EXPECT_LT((r.metrics.area_vector - disc * Vec3::UnitZ()).norm(), 1e-4 * disc);
  EXPECT_LT(r.metrics.area_moment.norm(), 1e-4 * disc * kRadius);
}

// The corner of a cube below a plane at distance d from it is a tetrahedron: V = (sqrt(3) d)^3 / 6,
// its centroid 3/4 d below the corner's distance.
TEST(ReferenceIntegral, CornerOfACube) {
  constexpr double kDepth = 0.1;
  const Mat3 on_corner =
      basis_with_z(Vec3::UnitZ()) *
      Eigen::Quaterniond::FromTwoVectors(Vec3::Ones(), -Vec3::UnitZ()).toRotationMatrix();
  const Pose X_AB{on_corner, Vec3(0.0, 0.0, 0.3 * std::sqrt(3.0) - kDepth)};
  const Reference r = integral(HalfSpace(), Box({.half_sizes = Vec3::Constant(0.3)}), X_AB,
                               Vec3(0.0, 0.0, -0.5 * kDepth), 0.6);
  const double edge = std::sqrt(3.0) * kDepth, volume = edge * edge * edge / 6.0;
  const double area = std::sqrt(3.0) / 2.0 * edge * edge;
  // The search for the ends of the sections stops a little short of a corner.
  EXPECT_NEAR(r.metrics.volume, volume, 1e-6 * volume);
  EXPECT_LT((r.metrics.centroid - Vec3(0.0, 0.0, -0.25 * kDepth)).norm(), 1e-6 * kDepth);
  EXPECT_NEAR(r.metrics.area_vector.z(), area, 2e-3 * area);
}

// A whole body inside: the textbook volume, centroid and inertia of each kind, no area of A.
TEST(ReferenceIntegral, WholeBodies) {
  const Shape room = Box({.half_sizes = Vec3::Constant(2.0)});
  for (const Example& e : examples()) {
    // The many edges of a hull, and the many faces of a cup, cost seconds.
    if (std::isinf(e.own_volume) || e.name == "convex_polytope" ||
        std::holds_alternative<Csg>(e.shape) || std::holds_alternative<Mesh>(e.shape)) {
      continue;
    }
    const Pose X_AB{turn(Vec3(1.0, 2.0, 3.0), 0.7), Vec3(0.2, -0.1, 0.3)};
    const Reference r = integral(room, e.shape, X_AB, X_AB * e.bounds.center(), 2.0 * e.size);
    const VolumeMetrics own = transformed(own_metrics_of(e.shape), X_AB);
    EXPECT_NEAR(r.metrics.volume, own.volume, 1e-6 * own.volume) << e.name;
    EXPECT_LT((r.metrics.centroid - own.centroid).norm(), 1e-6 * e.size) << e.name;
    EXPECT_LT((r.metrics.inertia - own.inertia).norm(), 1e-5 * own.inertia.norm()) << e.name;
    EXPECT_EQ(r.metrics.area, 0.0) << e.name;
  }
}

// Steinmetz: two cylinders of one radius that cross at right angles share 16/3 r^3.
TEST(ReferenceIntegral, CrossedCylinders) {
  const Shape rod = Cylinder({.radius = 0.3, .half_length = 1.0});
  const Reference r =
      integral(rod, rod, {turn(Vec3::UnitX(), kPi / 2.0), Vec3::Zero()}, Vec3::Zero(), 0.7);
  EXPECT_NEAR(r.metrics.volume, 16.0 / 3.0 * 0.027, 1e-7);
}

// Coordinates of a bored block: the difference is the block without the bore.
TEST(ReferenceIntegral, BoredBlock) {
  const ReferenceSolid block = reference_solid(Box({.half_sizes = Vec3(0.5, 0.4, 0.3)}));
  const ReferenceSolid bore = reference_solid(Cylinder({.radius = 0.2, .half_length = 1.0}));
  Random random(9);
  const Reference r = reference_integral(block - bore, reference_solid(HalfSpace()),
                                         Pose{Mat3::Identity(), Vec3(0.0, 0.0, 1.0)},
                                         {{random.rotation(), Vec3::Zero()}, 1.0});
  const double volume = 8.0 * 0.06 - kPi * 0.04 * 0.6;
  EXPECT_NEAR(r.metrics.volume, volume, 1e-6 * volume);
}

TEST(ContactPoses, ShallowPosesOverlapAndTheSurfaceNormalsAreOpposed) {
  Random random(6);
  const Example &ball = examples()[1], &box = examples()[6];
  for (int i = 0; i < 10; ++i) {
    // A ball under a face: a cap of the wanted depth, unless an edge cuts it.
    const ContactPose pose = shallow_overlap(box, ball, 1e-3, 0.0, random);
    const Reference r = reference_integral(box.reference, ball.reference, pose.X_AB, pose.lookout);
    const double cap = kPi * 1e-6 * (0.35 - 1e-3 / 3.0);
    EXPECT_GT(r.metrics.volume, 0.0);
    EXPECT_LT(r.metrics.volume, cap * (1.0 + 1e-6));
  }
}

}  // namespace
}  // namespace volcontact::test
