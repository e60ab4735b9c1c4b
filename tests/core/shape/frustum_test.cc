// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/frustum.h"

#include <gtest/gtest.h>

#include <random>

#include "volcontact/shape/cylinder.h"

namespace volcontact::frustum_test {
namespace {

const Frustum kFrusta[] = {
    Frustum({.bottom_radius = 0.5, .top_radius = 0.2, .half_length = 0.4}),
    Frustum({.bottom_radius = 0.1, .top_radius = 0.6, .half_length = 0.3}),
    Frustum({.bottom_radius = 0.0, .top_radius = 0.4, .half_length = 0.5}),   // a cone
    Frustum({.bottom_radius = 0.3, .top_radius = 0.3, .half_length = 0.5})};  // a cylinder

Vec3 random_vector(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> number(-size, size);
  return {number(random), number(random), number(random)};
}

// Independent of signed_distance and ray: the definition of the solid.
bool inside(const Frustum& solid, const Vec3& p) {
  const auto& f = solid.params();
  const double s = 0.5 * (1.0 + p.z() / f.half_length);
  return s >= 0.0 && s <= 1.0 &&
         std::hypot(p.x(), p.y()) <= f.bottom_radius + s * (f.top_radius - f.bottom_radius);
}

TEST(Frustum, RayAndDistanceAgreeWithTheDefinition) {
  std::mt19937 random(5);
  for (const Frustum& solid : kFrusta) {
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vec3 o = random_vector(random, 0.8), d = random_vector(random, 1.0);
      EXPECT_EQ(solid.signed_distance(o) <= 0.0, inside(solid, o));
      const RayInterval span = solid.ray(o, d);
      for (int k = 0; k < 20; ++k) {
        const double t = -2.0 + 0.2 * k + 1e-3 * i / 2000.0;
        const bool on = !span.empty() && t >= span.enter && t <= span.leave;
        EXPECT_EQ(on, inside(solid, o + t * d));
      }
      hits += !span.empty();
    }
    EXPECT_GT(hits, 400);
  }
}

TEST(Frustum, RaysAlongAndParallelToTheWallAreFinite) {
  const Frustum cone({.bottom_radius = 0.0, .top_radius = 1.0, .half_length = 0.5});
  const RayInterval axis = cone.ray(Vec3::Zero(), Vec3::UnitZ());
  EXPECT_DOUBLE_EQ(axis.enter, -0.5);
  EXPECT_DOUBLE_EQ(axis.leave, 0.5);
  // x = 0.2 + t, radius = 0.5 + t: parallel to the wall, which it meets where -(0.2 + t) = 0.5 + t.
  const RayInterval parallel = cone.ray({0.2, 0.0, 0.0}, {1.0, 0.0, 1.0});
  EXPECT_NEAR(parallel.leave, 0.5, 1e-15);
  EXPECT_NEAR(parallel.enter, -0.35, 1e-15);
}

// Brute force over the profile of the solid in the (rho, z) half-plane.
TEST(Frustum, SignedDistanceIsTheDistance) {
  std::mt19937 random(6);
  for (const Frustum& solid : kFrusta) {
    const auto& f = solid.params();
    for (int i = 0; i < 300; ++i) {
      const Vec3 p = random_vector(random, 0.9);
      const double rho = std::hypot(p.x(), p.y());
      double nearest = kInfinity;  // over bottom, wall, top
      for (int k = 0; k <= 4000; ++k) {
        const double s = k / 4000.0;
        const double r = f.bottom_radius + s * (f.top_radius - f.bottom_radius);
        nearest = std::min({nearest, std::hypot(rho - s * f.bottom_radius, p.z() + f.half_length),
                            std::hypot(rho - s * f.top_radius, p.z() - f.half_length),
                            std::hypot(rho - r, p.z() - (2.0 * s - 1.0) * f.half_length)});
      }
      EXPECT_NEAR(std::abs(solid.signed_distance(p)), nearest, 1e-5);
    }
  }
}

TEST(Frustum, GradientIsTheDirectionOfGrowth) {
  std::mt19937 random(8);
  const double step = 1e-7;
  for (const Frustum& solid : kFrusta) {
    for (int i = 0; i < 300; ++i) {
      const Vec3 p = random_vector(random, 0.9);
      const Vec3 g = solid.gradient(p);
      EXPECT_NEAR(g.norm(), 1.0, 1e-12);
      const double slope =
          (solid.signed_distance(p + step * g) - solid.signed_distance(p - step * g)) /
          (2.0 * step);
      EXPECT_NEAR(slope, 1.0, 1e-5);
    }
  }
}

TEST(Frustum, SupportIsTheFarthestPoint) {
  std::mt19937 random(7);
  for (const Frustum& solid : kFrusta) {
    for (int i = 0; i < 200; ++i) {
      const Vec3 e = random_vector(random, 1.0);
      const double height = solid.support_height(e);
      EXPECT_NEAR(e.dot(solid.support(e)), height, 1e-14);
      EXPECT_LE(std::abs(solid.signed_distance(solid.support(e))), 1e-14);
      for (int k = 0; k < 50; ++k) {
        const Vec3 p = random_vector(random, 0.7);
        if (inside(solid, p)) {
          EXPECT_LE(e.dot(p), height + 1e-14);
        }
      }
    }
  }
}

// Slices of discs, midpoint rule: independent of the polynomial integrals.
TEST(Frustum, OwnMetricsEqualTheSumOfDiscs) {
  for (const Frustum& solid : kFrusta) {
    const auto& f = solid.params();
    const int count = 20000;
    double volume = 0.0, first = 0.0, second = 0.0, polar = 0.0;
    for (int k = 0; k < count; ++k) {
      const double s = (k + 0.5) / count, z = (2.0 * s - 1.0) * f.half_length;
      const double r = f.bottom_radius + s * (f.top_radius - f.bottom_radius);
      const double disc = kPi * r * r * 2.0 * f.half_length / count;
      volume += disc;
      first += disc * z;
      second += disc * z * z;
      polar += disc * r * r / 2.0;
    }
    const VolumeMetrics m = solid.own_metrics();
    EXPECT_NEAR(m.volume / volume, 1.0, 1e-8);
    EXPECT_NEAR(m.centroid.z(), first / volume, 1e-8);
    EXPECT_NEAR(m.inertia(2, 2) / polar, 1.0, 1e-8);
    EXPECT_NEAR(m.inertia(0, 0) / (polar / 2.0 + second - first * first / volume), 1.0, 1e-7);
  }
}

TEST(Frustum, WithEqualRadiiIsTheCylinder) {
  const Frustum frustum({.bottom_radius = 0.3, .top_radius = 0.3, .half_length = 0.5});
  const Cylinder cylinder({.radius = 0.3, .half_length = 0.5});
  EXPECT_NEAR(frustum.own_metrics().volume, cylinder.own_metrics().volume, 1e-15);
  EXPECT_NEAR((frustum.own_metrics().inertia - cylinder.own_metrics().inertia).norm(), 0.0, 1e-15);
  const Vec3 p(0.2, 0.5, 0.9);
  EXPECT_NEAR(frustum.signed_distance(p), cylinder.signed_distance(p), 1e-15);
}

}  // namespace
}  // namespace volcontact::frustum_test
