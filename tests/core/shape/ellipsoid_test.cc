// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/ellipsoid.h"

#include <gtest/gtest.h>

#include "core/support/random.h"
#include "volcontact/shape/sphere.h"

namespace volcontact::ellipsoid_test {
namespace {

using test::Random;

Ellipsoid random_ellipsoid(Random& random) {
  return Ellipsoid({.semi_axes = Vec3(random.log_uniform(0.05, 2.0), random.log_uniform(0.05, 2.0),
                                      random.log_uniform(0.05, 2.0))});
}

Vec3 surface_point(const Ellipsoid& solid, const Vec3& direction) {
  return solid.semi_axes().cwiseProduct(direction);
}

TEST(Ellipsoid, SignedDistanceNeverExceedsTheDistanceToTheSurface) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Ellipsoid solid = random_ellipsoid(random);
    const Vec3 p = random.in_box(2.0);
    const double bound = std::abs(solid.signed_distance(p));
    for (int k = 0; k < 200; ++k) {
      EXPECT_GE((surface_point(solid, random.direction()) - p).norm(), bound * (1.0 - 1e-12));
    }
  }
}

TEST(Ellipsoid, SignedDistanceHasTheSignOfTheSide) {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const Ellipsoid solid = random_ellipsoid(random);
    const Vec3 p = surface_point(solid, random.direction());
    EXPECT_LT(solid.signed_distance(0.999 * p), 0.0);
    EXPECT_GT(solid.signed_distance(1.001 * p), 0.0);
    EXPECT_NEAR(solid.signed_distance(p), 0.0, 1e-14);
  }
}

TEST(Ellipsoid, SignedDistanceIsExactForABall) {
  Random random(3);
  const Ellipsoid ball({.semi_axes = Vec3::Constant(0.7)});
  for (int i = 0; i < 100; ++i) {
    const Vec3 p = random.in_box(1.0);
    EXPECT_NEAR(ball.signed_distance(p), p.norm() - 0.7, 1e-14);
  }
}

TEST(Ellipsoid, SignedDistanceIsExactToFirstOrderAtTheSurface) {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    const Ellipsoid solid = random_ellipsoid(random);
    const Vec3 p = surface_point(solid, random.direction()), n = solid.gradient(p);
    constexpr double kStep = 1e-8;
    EXPECT_NEAR(solid.signed_distance(p + kStep * n), kStep, 1e-4 * kStep);
    EXPECT_NEAR(solid.signed_distance(p - kStep * n), -kStep, 1e-4 * kStep);
  }
}

TEST(Ellipsoid, SupportIsTheFarthestPoint) {
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const Ellipsoid solid = random_ellipsoid(random);
    const Vec3 e = random.uniform(0.1, 10.0) * random.direction();
    const double height = solid.support_height(e);
    EXPECT_NEAR(solid.support(e).dot(e), height, 1e-13 * height);
    EXPECT_NEAR(solid.signed_distance(solid.support(e)), 0.0, 1e-13);
    for (int k = 0; k < 50; ++k) {
      EXPECT_LE(surface_point(solid, random.direction()).dot(e), height * (1.0 + 1e-14));
    }
  }
}

TEST(Ellipsoid, RayEndsLieOnTheSurface) {
  Random random(6);
  int hits = 0;
  for (int i = 0; i < 200; ++i) {
    const Ellipsoid solid = random_ellipsoid(random);
    const Vec3 d = random.uniform(0.1, 3.0) * random.direction();
    const Vec3 o = random.in_box(0.5) - 100.0 * d;  // from far away
    const RayInterval span = solid.ray(o, d);
    if (span.empty()) continue;
    ++hits;
    for (double t : {span.enter, span.leave}) {
      const Vec3 p = o + t * d;
      EXPECT_NEAR(p.cwiseQuotient(solid.semi_axes()).norm(), 1.0, 1e-9);
    }
  }
  EXPECT_GT(hits, 50);
}

TEST(Ellipsoid, RayMissesWhatItMisses) {
  const Ellipsoid solid({.semi_axes = Vec3(1.0, 2.0, 3.0)});
  EXPECT_TRUE(solid.ray(Vec3(1.0001, 0, 0), Vec3::UnitY()).empty());
  EXPECT_FALSE(solid.ray(Vec3(0.9999, 0, 0), Vec3::UnitY()).empty());
}

TEST(Ellipsoid, OwnMetricsEqualThoseOfABallStretched) {
  const VolumeMetrics m = Ellipsoid({.semi_axes = Vec3(0.1, 0.2, 0.3)}).own_metrics();
  const double volume = 4.0 / 3.0 * kPi * 0.006;
  EXPECT_NEAR(m.volume, volume, 1e-16);
  // int x^2 dV = V a^2 / 5.
  EXPECT_NEAR(m.inertia(0, 0), volume / 5.0 * (0.04 + 0.09), 1e-17);
  EXPECT_NEAR(m.inertia(2, 2), volume / 5.0 * (0.01 + 0.04), 1e-17);
}

TEST(Ellipsoid, FlatOneIsEmptyAndFinite) {
  const Ellipsoid plate({.semi_axes = Vec3(1.0, 1.0, 0.0)});
  EXPECT_EQ(plate.own_metrics().volume, 0.0);
  EXPECT_DOUBLE_EQ(plate.signed_distance(Vec3(0.2, 0.1, 0.5)), 0.5);
  EXPECT_DOUBLE_EQ(plate.signed_distance(Vec3(4.0, 0.0, 4.0)), 5.0);
  EXPECT_EQ(plate.gradient(Vec3(0.2, 0.1, -0.5)), Vec3(0, 0, -1));
  EXPECT_TRUE(plate.ray(Vec3(0, 0, -1), Vec3::UnitZ()).empty());
  const Ellipsoid point({.semi_axes = Vec3::Zero()});
  EXPECT_DOUBLE_EQ(point.signed_distance(Vec3(0, 3, 4)), 5.0);
  EXPECT_EQ(point.support(Vec3::UnitX()), Vec3(Vec3::Zero()));
}

TEST(Ellipsoid, RejectsNegativeSemiAxes) {
  EXPECT_THROW(Ellipsoid({.semi_axes = Vec3(1.0, -1.0, 1.0)}), std::invalid_argument);
}

}  // namespace
}  // namespace volcontact::ellipsoid_test
