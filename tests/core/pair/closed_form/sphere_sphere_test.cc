// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/closed_form/sphere_sphere.h"

#include <gtest/gtest.h>

#include "core/reference/disc_oracle.h"
#include "core/support/gradient.h"
#include "core/support/matchers.h"

namespace volcontact::sphere_sphere_test {
namespace {

using test::Random;

VolumeMetrics lens(double r_a, double r_b, const Vec3& p_AB) {
  return closed_form(Sphere({.radius = r_a}), Sphere({.radius = r_b}),
                     Pose{Mat3::Identity(), p_AB});
}

// The lens along z: the ball that is narrower at each height. Heights from the plane where the
// spheres meet, so that the oracle keeps its digits for thin lenses.
test::DiscSum discs(long double r_a, long double r_b, long double distance) {
  const long double overlap = r_a + r_b - distance;
  const long double above = overlap * (distance - r_a + r_b) / (2 * distance);
  const long double below = overlap - above;
  test::DiscSum sum;
  sum.add_ball(-below, 2 * r_b - below, -below, 0);
  sum.add_ball(above - 2 * r_a, above, 0, above);
  return sum;
}

TEST(SphereSphere, EqualsTheStackOfDiscs) {
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    const double r_a = random.log_uniform(0.05, 2.0), r_b = random.log_uniform(0.05, 2.0);
    const double low = std::abs(r_a - r_b), high = r_a + r_b;
    const double distance = low + (high - low) * random.uniform(0.01, 0.999);
    const Vec3 axis = random.direction();
    const VolumeMetrics m = lens(r_a, r_b, distance * axis);
    const test::DiscSum sum = discs(r_a, r_b, distance);
    const double plane = 0.5 * (distance + (r_a - r_b) * (r_a + r_b) / distance);
    VolumeMetrics expected;
    expected.volume = static_cast<double>(sum.volume);
    expected.centroid = (plane + static_cast<double>(sum.first / sum.volume)) * axis;
    expected.inertia = static_cast<double>(sum.axial_second() + sum.lateral) * Mat3::Identity() +
                       static_cast<double>(sum.lateral - sum.axial_second()) * outer(axis, axis);
    expected.area_vector = kPi * (r_a - plane) * (r_a + plane) * axis;
    expected.area = 2.0 * kPi * r_a * (r_a - plane);  // Archimedes' hat-box
    expected.counter_area = 2.0 * kPi * r_b * (r_b - (distance - plane));
    expected.depth_moment = m.depth_moment;  // tested below
    expected.depth = high - distance;
    EXPECT_TRUE(test::same(m, expected, {2e-10, high}));
    EXPECT_LE(std::abs(m.volume - expected.volume), m.volume_error + 1e-15 * expected.volume);
  }
}

TEST(SphereSphere, ThinLensKeepsItsRelativeAccuracy) {
  // Radii and distances that doubles hold exactly, so that the overlap is exact as well.
  for (int bits = 4; bits < 45; ++bits) {
    const double overlap = std::ldexp(1.0, -bits), distance = 0.75 - overlap;
    const VolumeMetrics m = lens(0.5, 0.25, distance * Vec3::UnitZ());
    const test::DiscSum sum = discs(0.5L, 0.25L, distance);
    EXPECT_NEAR(m.volume / sum.volume, 1.0, 1e-13) << bits;
    EXPECT_NEAR(m.inertia(0, 0) / (sum.axial_second() + sum.lateral), 1.0, 1e-13) << bits;
    EXPECT_NEAR(m.inertia(2, 2) / (2 * sum.lateral), 1.0, 1e-13) << bits;
    // int L^2/2 dA of a thin lens = pi R h^3 / 3, R = r_a r_b / (r_a + r_b), to first order in h.
    EXPECT_NEAR(m.depth_moment / (kPi / 18.0 * std::pow(overlap, 3)), 1.0, 10.0 * overlap);
  }
}

TEST(SphereSphere, AreaVectorAndMomentAreTheGradientOfTheVolume) {
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const double r_a = random.uniform(0.2, 1.0), r_b = random.uniform(0.2, 1.0);
    const double low = std::abs(r_a - r_b), high = r_a + r_b;
    const Pose X{random.rotation(),
                 (low + (high - low) * random.uniform(0.1, 0.9)) * random.direction()};
    const Sphere a({.radius = r_a}), b({.radius = r_b});
    const auto volume = [&](const Pose& pose) { return closed_form(a, b, pose).volume; };
    const VolumeMetrics m = closed_form(a, b, X);
    const test::Gradient gradient = test::gradient_of_A(volume, X, 1e-4);
    EXPECT_LT((m.area_vector - gradient.shift).norm(), 1e-8);
    EXPECT_LT((m.area_moment - gradient.turn).norm(), 1e-8);
  }
}

TEST(SphereSphere, DepthMomentIsThePotentialOfTheVolumeInsideAsWell) {
  // For balls the line of centres stays the normal: f = V n is conservative, down to one centre on
  // the other.
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    const double r_a = random.log_uniform(0.05, 2.0), r_b = random.log_uniform(0.05, 2.0);
    const double distance = (r_a + r_b) * random.uniform(0.01, 0.99);
    const double kink = std::abs(distance - std::abs(r_a - r_b));
    const double step = 0.2 * std::min({kink, distance, 0.02 * r_a, 0.02 * r_b});
    const auto potential = [&](double h) {
      return lens(r_a, r_b, (distance + h) * Vec3::UnitX()).depth_moment;
    };
    const double volume = lens(r_a, r_b, distance * Vec3::UnitX()).volume;
    const double rounding = 1e-15 * potential(0.0) / step;
    EXPECT_NEAR(test::derivative(potential, step), -volume, 1e-6 * volume + 10.0 * rounding);
  }
}

TEST(SphereSphere, DepthMomentIsZeroAtTouchAndContinuousAtContainment) {
  EXPECT_NEAR(lens(0.5, 0.25, Vec3(0.75 - 1e-9, 0, 0)).depth_moment, 0.0, 1e-26);
  const VolumeMetrics before = lens(0.5, 0.2, Vec3(0.3 + 1e-12, 0, 0));
  const VolumeMetrics inside = lens(0.5, 0.2, Vec3(0.3 - 1e-12, 0, 0));
  EXPECT_NEAR(before.depth_moment, inside.depth_moment, 1e-12);
  EXPECT_NEAR(before.volume, inside.volume, 1e-12);
  EXPECT_LT((before.inertia - inside.inertia).norm(), 1e-12);
  EXPECT_LT((before.centroid - inside.centroid).norm(), 1e-10);
  EXPECT_NEAR(before.depth, inside.depth, 1e-11);
  EXPECT_LT(before.area_vector.norm(), 1e-5);  // grows with the square root
  EXPECT_EQ(before.status, Status::kOk);
  EXPECT_EQ(inside.status, Status::kContained);
}

TEST(LogTail, EqualsTheLogarithmWhereThatHasDigitsLeft) {
  for (double x : {0.3, 0.45, 0.4999, 0.5001, 0.7, 0.999}) {
    const long double l = x;
    const long double tail = -std::log1p(-l) - l - l * l / 2 - l * l * l / 3;
    EXPECT_NEAR(log_tail(x) / tail, 1.0, 1e-14) << x;
  }
  // Both ends of the short series: the first terms of the sum, to the order of the next.
  EXPECT_NEAR(log_tail(1e-6), 2.5e-25 * (1.0 + 0.8e-6), 1e-36);
  EXPECT_NEAR(log_tail(0.03125 * (1 - 1e-15)) / log_tail(0.03125), 1.0, 1e-13);
}

TEST(SphereSphere, SwapIsTheMirror) {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    const double r_a = random.uniform(0.1, 1.0), r_b = random.uniform(0.1, 1.0);
    const Pose X{random.rotation(), random.uniform(0.0, 0.999) * (r_a + r_b) * random.direction()};
    const Sphere a({.radius = r_a}), b({.radius = r_b});
    const VolumeMetrics m = closed_form(a, b, X);
    const VolumeMetrics mirrored = reversed(transformed(closed_form(b, a, X.inverse()), X));
    EXPECT_TRUE(test::same(mirrored, m, {1e-12, 1.0}));
  }
}

TEST(SphereSphere, OneInsideTheOtherIsTheSmallerOne) {
  const VolumeMetrics own = Sphere({.radius = 0.2}).own_metrics();
  for (const Vec3& p : {Vec3(0.1, 0.0, 0.0), Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.3, 0.0)}) {
    const VolumeMetrics b_inside = lens(0.5, 0.2, p), a_inside = lens(0.2, 0.5, p);
    for (const VolumeMetrics& m : {a_inside, b_inside}) {
      EXPECT_DOUBLE_EQ(m.volume, own.volume);
      EXPECT_EQ(m.area_vector, Vec3(Vec3::Zero()));
      EXPECT_EQ(m.status, Status::kContained);
      EXPECT_TRUE(is_finite(m));
    }
    EXPECT_EQ(b_inside.centroid, p);
    EXPECT_EQ(a_inside.centroid, Vec3(Vec3::Zero()));
    EXPECT_EQ(b_inside.area, 0.0);
    EXPECT_NEAR(b_inside.counter_area, 4.0 * kPi * 0.04, 1e-15);
    EXPECT_EQ(a_inside.counter_area, 0.0);
  }
}

TEST(SphereSphere, EqualBallsUpToCentreOnCentre) {
  EXPECT_EQ(lens(0.5, 0.5, Vec3::Zero()).status, Status::kContained);
  // int V dD of equal balls from D = 2 R to 0 = pi R^4 (polynomial: V = pi (2R-D)^2 (D+4R)/12).
  EXPECT_NEAR(lens(0.5, 0.5, Vec3::Zero()).depth_moment, kPi / 16.0, 1e-15);
  EXPECT_NEAR(lens(0.5, 0.5, Vec3(1e-12, 0, 0)).depth_moment, kPi / 16.0, 1e-11);
  EXPECT_NEAR(lens(0.5, 0.5, Vec3(1e-12, 0, 0)).volume, kPi / 6.0, 1e-11);
  EXPECT_TRUE(is_finite(lens(0.5, 0.5 + 1e-17, Vec3::Zero())));
  EXPECT_TRUE(is_finite(lens(0.5, 0.5000000000000001, Vec3(1e-17, 0, 0))));
}

TEST(SphereSphere, TouchingAndZeroRadiusAreNothing) {
  EXPECT_FALSE(lens(0.5, 0.25, Vec3(0.75, 0, 0)).touching());
  EXPECT_FALSE(lens(0.5, 0.25, Vec3(9, 0, 0)).touching());
  EXPECT_FALSE(lens(0.0, 0.25, Vec3(0.1, 0, 0)).touching());
  EXPECT_FALSE(lens(0.0, 0.0, Vec3::Zero()).touching());
}

}  // namespace
}  // namespace volcontact::sphere_sphere_test
