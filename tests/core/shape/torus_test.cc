// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/torus.h"

#include <gtest/gtest.h>

#include "core/support/random.h"

namespace volcontact::torus_test {
namespace {

using test::Random;

const Torus kTori[] = {Torus({.major_radius = 0.5, .minor_radius = 0.15}),
                       Torus({.major_radius = 0.3, .minor_radius = 0.3}),   // no hole left
                       Torus({.major_radius = 0.4, .minor_radius = 0.0})};  // a circle

// Independent of signed_distance: the quartic equation of the surface.
bool inside(const Torus& solid, const Vec3& p) {
  const double R = solid.major_radius(), r = solid.minor_radius();
  const double sum = p.squaredNorm() + R * R - r * r;
  return sum * sum <= 4.0 * R * R * (p.x() * p.x() + p.y() * p.y());
}

TEST(Torus, SignedDistanceHasTheSignOfTheQuartic) {
  Random random(1);
  for (const Torus& solid : kTori) {
    for (int i = 0; i < 2000; ++i) {
      const Vec3 p = random.in_box(0.8);
      EXPECT_EQ(solid.signed_distance(p) <= 0.0, inside(solid, p)) << p;
    }
  }
}

// Brute force over points of the surface.
TEST(Torus, SignedDistanceIsTheDistance) {
  Random random(2);
  const Torus& solid = kTori[0];
  for (int i = 0; i < 50; ++i) {
    const Vec3 p = random.in_box(0.8);
    double nearest = kInfinity;
    for (int j = 0; j < 200; ++j) {
      for (int k = 0; k < 200; ++k) {
        const double a = 2.0 * kPi * j / 200, b = 2.0 * kPi * k / 200;
        const double rho = 0.5 + 0.15 * std::cos(b);
        const Vec3 q(rho * std::cos(a), rho * std::sin(a), 0.15 * std::sin(b));
        nearest = std::min(nearest, (p - q).norm());
      }
    }
    EXPECT_NEAR(std::abs(solid.signed_distance(p)), nearest, 2e-3);
    EXPECT_LE(std::abs(solid.signed_distance(p)), nearest + 1e-12);
  }
}

TEST(Torus, GradientIsTheDirectionOfGrowth) {
  Random random(3);
  const double step = 1e-7;
  for (const Torus& solid : kTori) {
    for (int i = 0; i < 200; ++i) {
      const Vec3 p = random.in_box(0.8), g = solid.gradient(p);
      EXPECT_NEAR(g.norm(), 1.0, 1e-12);
      const double rise = solid.signed_distance(p + step * g) - solid.signed_distance(p);
      EXPECT_NEAR(rise / step, 1.0, 1e-5);
    }
  }
}

// The first-order prediction may be off by half the bound times the square of the way.
TEST(Torus, CurvatureBoundHolds) {
  Random random(4);
  for (const Torus& solid : kTori) {
    for (int i = 0; i < 5000; ++i) {
      const Vec3 p = random.in_box(0.8), way = random.log_uniform(1e-3, 0.3) * random.direction();
      const double bound = solid.curvature_bound(p, way.norm());
      const double error =
          solid.signed_distance(p + way) - solid.signed_distance(p) - solid.gradient(p).dot(way);
      EXPECT_LE(std::abs(error), 0.5 * bound * way.squaredNorm() + 1e-14);
    }
    // Around the tube, and on its inner side around the axis: known curvatures of the surface.
    const double R = solid.major_radius(), r = solid.minor_radius();
    if (r > 0.0 && r < R) {
      EXPECT_NEAR(solid.curvature_bound({R + r, 0.0, 0.0}, 0.0), 1.0 / r, 1e-12);
      EXPECT_NEAR(solid.curvature_bound({R - r, 0.0, 0.0}, 0.0), std::max(1.0 / r, 1.0 / (R - r)),
                  1e-12);
    }
  }
}

TEST(Torus, SupportIsTheFarthestPoint) {
  Random random(5);
  for (const Torus& solid : kTori) {
    for (int i = 0; i < 200; ++i) {
      const Vec3 e = random.uniform(0.1, 3.0) * random.direction();
      const double height = solid.support_height(e);
      EXPECT_NEAR(e.dot(solid.support(e)), height, 1e-14);
      EXPECT_LE(std::abs(solid.signed_distance(solid.support(e))), 1e-14);
      const Vec3 p = random.in_box(0.8);
      if (inside(solid, p)) {
        EXPECT_LE(e.dot(p), height + 1e-14);
      }
    }
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(solid.bounds().max[i], solid.support_height(Vec3::Unit(i)), 1e-15);
      EXPECT_NEAR(solid.bounds().min[i], -solid.support_height(-Vec3::Unit(i)), 1e-15);
    }
  }
}

// Slices z = constant are rings between two circles; their moments, summed by the midpoint rule.
TEST(Torus, OwnMetricsEqualTheSumOfRings) {
  for (const Torus& solid : {kTori[0], kTori[1]}) {
    const double R = solid.major_radius(), r = solid.minor_radius();
    const int count = 200000;
    double volume = 0.0, polar = 0.0, along = 0.0;
    for (int i = 0; i < count; ++i) {
      const double z = r * (2.0 * (i + 0.5) / count - 1.0), half = std::sqrt(r * r - z * z);
      const double outer = (R + half) * (R + half), inner = (R - half) * (R - half);
      const double slice = kPi * (outer - inner) * 2.0 * r / count;
      volume += slice;
      polar += slice * 0.5 * (outer + inner);
      along += slice * z * z;
    }
    const VolumeMetrics m = solid.own_metrics();
    EXPECT_NEAR(m.volume / volume, 1.0, 1e-6);
    EXPECT_NEAR(m.inertia(2, 2) / polar, 1.0, 1e-6);
    EXPECT_NEAR(m.inertia(0, 0) / (polar / 2.0 + along), 1.0, 1e-6);
    EXPECT_EQ(m.centroid, Vec3(0.0, 0.0, 0.0));
  }
}

TEST(Torus, RefusesATubeThatReachesOverTheAxis) {
  EXPECT_THROW(Torus({.major_radius = 0.1, .minor_radius = 0.2}), std::invalid_argument);
  EXPECT_THROW(Torus({.major_radius = -0.1, .minor_radius = 0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace volcontact::torus_test
