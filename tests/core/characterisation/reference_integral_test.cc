// SPDX-License-Identifier: Apache-2.0
#include "core/reference/reference_integral.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/reference/common_point.h"
#include "core/search/contact_poses.h"
#include "core/support/csg_solids.h"
#include "core/support/evaluated.h"

namespace volcontact::test::reference_integral_test {
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
// its centroid 3/4 d below the corner's distance. However it is turned: a section near a tip, which
// looks empty as long as nothing has been seen next to it, is found from beside.
TEST(ReferenceIntegral, CornerOfACube) {
  constexpr double kDepth = 0.1;
  const double edge = std::sqrt(3.0) * kDepth, volume = edge * edge * edge / 6.0;
  const double area = std::sqrt(3.0) / 2.0 * edge * edge;
  const Mat3 corner_down = basis_with_z(-Vec3::Ones().normalized()).transpose();
  for (int turn = 0; turn < 12; ++turn) {
    const Mat3 about_z = rotation_about(Vec3::UnitZ(), 0.5 * turn);
    const Pose X_AB{about_z * corner_down, Vec3(0.0, 0.0, 0.3 * std::sqrt(3.0) - kDepth)};
    const Reference r = integral(HalfSpace(), Box({.half_sizes = Vec3::Constant(0.3)}), X_AB,
                                 Vec3(0.0, 0.0, -0.5 * kDepth), 0.6);
    EXPECT_NEAR(r.metrics.volume, volume, 1e-12 * volume) << turn;
    EXPECT_LT(r.worst_error, 1e-12 * volume) << turn;
    EXPECT_LT((r.metrics.centroid - Vec3(0.0, 0.0, -0.25 * kDepth)).norm(), 1e-12 * kDepth);
    EXPECT_LT((r.metrics.area_vector - area * Vec3::UnitZ()).norm(), 1e-9 * area) << turn;
  }
}

// A whole body inside: the textbook volume, centroid and inertia of each kind, no area of A.
TEST(ReferenceIntegral, WholeBodies) {
  const Shape room = Box({.half_sizes = Vec3::Constant(2.0)});
  for (const Example& e : examples()) {
    // The many edges of a hull cost seconds.
    if (std::isinf(e.own_volume) || e.name == "convex_polytope" ||
        std::holds_alternative<Mesh>(e.shape)) {
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

// Two solids in the shape of an L, each of two boxes that lie flush: the overlaps of the boxes are
// clipped exactly, and add up.
TEST(ReferenceIntegral, TwoLs) {
  const Box foot({.half_sizes = Vec3(0.3, 0.2, 0.1)}), leg({.half_sizes = Vec3(0.1, 0.2, 0.2)});
  const std::pair<Box, Pose> boxes[] = {{foot, testing::at(0.0, 0.0, -0.15)},
                                        {leg, testing::at(-0.2, 0.0, 0.15)}};
  const Csg solid = Csg(foot, boxes[0].second) + Csg(leg, boxes[1].second);
  Random random(7);
  for (int i = 0; i < 6; ++i) {
    const Pose X_AB{i < 2 ? Mat3(Mat3::Identity()) : random.rotation(), random.in_box(0.15)};
    VolumeMetrics exact;
    for (const auto& [a, X_a] : boxes) {
      for (const auto& [b, X_b] : boxes) {
        exact = exact + transformed(evaluated(a, b, X_a.inverse() * X_AB * X_b).total, X_a);
      }
    }
    const Reference r = integral(solid, solid, X_AB, X_AB.translation, 1.0);
    EXPECT_LE(std::abs(r.metrics.volume - exact.volume),
              2.0 * r.volume_error + 1e-8 * exact.volume);
    EXPECT_LE(r.volume_error, 1e-5 * exact.volume);
    EXPECT_LE((r.metrics.centroid - exact.centroid).norm(), 1e-5);
    EXPECT_LE((r.metrics.inertia - exact.inertia).norm(), 1e-5 * exact.inertia.norm());
    // Over all four pairs the flush faces, which look opposite ways, cancel.
    if (i >= 2) {
      EXPECT_LE((r.metrics.area_vector - exact.area_vector).norm(), 1e-4 * r.metrics.area);
    }
  }
}

// The corner of a block dips a little into the bore of another, far from where the integral is told
// to look: 1e-5 of the overlap.
TEST(ReferenceIntegral, OverlooksNoSmallRegion) {
  const Csg ring = testing::tube(0.3, 0.2) - testing::tube(0.2, 0.3);
  const double tip = 5e-3;
  // A bar across the ring's upper edge, and a ball that just comes through the wall elsewhere.
  const Csg both = testing::box(0.02, 0.3, 0.02, testing::at(0.3, 0.0, 0.2)) +
                   testing::ball(0.1, testing::at(-0.4 + tip, 0.0, 0.0));
  const Reference r = integral(ring, both, Pose{}, Vec3(0.29, 0.0, 0.19), 1.0);
  const double bar = evaluated(ring, Box({.half_sizes = Vec3(0.02, 0.3, 0.02)}),
                               testing::at(0.3, 0.0, 0.2), Engine::kOctree, 1e-3)
                         .total.volume;
  const double lens = evaluated(Cylinder({.radius = 0.3, .half_length = 0.2}),
                                Sphere({.radius = 0.1}), testing::at(-0.4 + tip, 0.0, 0.0))
                          .total.volume;
  EXPECT_GT(lens, 0.0);
  EXPECT_NEAR(r.metrics.volume, bar + lens, 2e-3 * bar);
  const Reference without =
      integral(ring, testing::box(0.02, 0.3, 0.02, testing::at(0.3, 0.0, 0.2)), Pose{},
               Vec3(0.29, 0.0, 0.19), 1.0);
  EXPECT_NEAR(r.metrics.volume - without.metrics.volume, lens, 1e-3 * lens);
}

// The place of a solid farthest against a direction.
template <typename S>
Vec3 lowest(const S& solid, const Vec3& up) {
  if constexpr (ConvexSolid<S>) return solid.support(-up);
  return Vec3::Zero();
}

TEST(ReferenceSolid, FindsAPointOfThinOverlaps) {
  Random random(5);
  const ReferenceSolid box = reference_solid(Box({.half_sizes = Vec3(0.4, 0.3, 0.2)}));
  const Shape bodies[] = {Sphere({.radius = 0.3}), Capsule({.radius = 0.2, .half_length = 0.3}),
                          Frustum({.bottom_radius = 0.3, .top_radius = 0.1, .half_length = 0.3}),
                          Ellipsoid({.semi_axes = Vec3(0.4, 0.3, 0.1)})};
  for (const Shape& body : bodies) {
    const ReferenceSolid solid = reference_solid(body);
    for (const double depth : {1e-1, 1e-3, 1e-6}) {
      const Mat3 r = random.rotation();
      // The lowest place of the body lies over the box's upper face.
      const Vec3 low = std::visit(
          [&](const auto& alternative) -> Vec3 {
            return r * lowest(alternative, r.transpose() * Vec3::UnitZ());
          },
          body);
      const Vec3 over(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), 0.2);
      for (const double side : {1.0, -1.0}) {  // in by so much, and apart by so much
        const Pose X{r, over - side * depth * Vec3::UnitZ() - low};
        Vec3 x;
        ASSERT_EQ(find_common_point(box, solid.posed(X), 1.0, x), side > 0.0) << name_of(body);
        if (side < 0.0) continue;
        const auto distance = [&x, &X](const auto& s) {
          return s.signed_distance(X.inverse() * x);
        };
        EXPECT_LT(std::visit(distance, body), 0.0);
        EXPECT_LT(x.z(), 0.2);
      }
    }
  }
}

// The search begins at the origin; in a face of both no chord goes through it.
TEST(CommonPoint, IsFoundFromAPlaceInAFace) {
  const ReferenceSolid ball = reference_solid(Sphere({.radius = 0.2}));
  const ReferenceSolid box = reference_solid(Box({.half_sizes = Vec3(0.5, 0.5, 0.5)}));
  Vec3 x;
  ASSERT_TRUE(find_common_point(box, ball.posed({Mat3::Identity(), Vec3(0.0, 0.2, 0.0)}), 1.0, x));
  EXPECT_LT((x - Vec3(0.0, 0.2, 0.0)).norm(), 0.2);
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
}  // namespace volcontact::test::reference_integral_test
