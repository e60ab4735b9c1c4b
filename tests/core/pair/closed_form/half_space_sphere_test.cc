// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/closed_form/half_space_sphere.h"

#include <gtest/gtest.h>

#include "core/reference/disc_oracle.h"
#include "core/support/gradient.h"
#include "core/support/matchers.h"

namespace volcontact::half_space_sphere_test {
namespace {

using test::Random;

constexpr double kRelative = 1e-13;  // rounding of a few products, at every depth

VolumeMetrics cap(double radius, const Vec3& center) {
  return closed_form(HalfSpace(), Sphere({.radius = radius}), Pose{Mat3::Identity(), center});
}

TEST(HalfSpaceSphere, EqualsTheStackOfDiscsAtEveryDepth) {
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    const double radius = random.log_uniform(1e-3, 10.0);
    const double z = radius * (1.0 - random.log_uniform(1e-12, 1.9999));
    const VolumeMetrics m = cap(radius, Vec3(0.3, -0.2, z));
    const long double h = static_cast<long double>(radius) - z;
    test::DiscSum discs;  // measured from the deepest point, so that the oracle does not cancel
    discs.add_ball(0, 2.0L * radius, 0, h);
    const long double depth = h - discs.first / discs.volume;
    EXPECT_NEAR(m.volume / discs.volume, 1.0, kRelative);
    EXPECT_NEAR(-m.centroid.z() / depth, 1.0, kRelative);
    EXPECT_NEAR(m.depth_moment / (discs.volume * depth), 1.0, kRelative);
    EXPECT_NEAR(m.inertia(0, 0) / (discs.axial_second() + discs.lateral), 1.0, kRelative);
    EXPECT_NEAR(m.inertia(2, 2) / (2 * discs.lateral), 1.0, kRelative);
    EXPECT_NEAR(m.area / (kPi * h * (2 * radius - h)), 1.0, kRelative);
    EXPECT_NEAR(m.counter_area / (2 * kPi * radius * h), 1.0, kRelative);
    EXPECT_NEAR(m.depth / h, 1.0, kRelative);
    EXPECT_LE(std::abs(m.volume - discs.volume), m.volume_error);
    EXPECT_EQ(m.status, Status::kOk);
  }
}

TEST(HalfSpaceSphere, AreaVectorAndMomentAreTheGradientOfTheVolume) {
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    const double radius = random.uniform(0.1, 1.0);
    const Sphere ball({.radius = radius});
    const Pose X{random.rotation(), Vec3(random.uniform(-1, 1), random.uniform(-1, 1),
                                         random.uniform(-0.95, 0.95) * radius)};
    const auto volume = [&](const Pose& pose) {
      return closed_form(HalfSpace(), ball, pose).volume;
    };
    const VolumeMetrics m = closed_form(HalfSpace(), ball, X);
    const test::Gradient gradient = test::gradient_of_A(volume, X, 1e-3 * radius);
    EXPECT_LT((m.area_vector - gradient.shift).norm(), 1e-9);
    EXPECT_LT((m.area_moment - gradient.turn).norm(), 1e-9);
  }
}

TEST(HalfSpaceSphere, DepthMomentIsThePotentialOfTheVolumeAlsoWhenImmersed) {
  for (double z : {0.9, 0.3, 0.0, -0.5, -0.9, -1.5, -3.0}) {
    const auto potential = [](double height) { return cap(1.0, Vec3(0, 0, height)).depth_moment; };
    const double slope = test::derivative([&](double h) { return potential(z + h); }, 1e-3);
    EXPECT_NEAR(slope, -cap(1.0, Vec3(0, 0, z)).volume, 1e-10) << z;
  }
}

TEST(HalfSpaceSphere, HalfImmersedIsAHemisphere) {
  const VolumeMetrics m = cap(0.5, Vec3(1, 2, 0));
  EXPECT_NEAR(m.volume, 2.0 / 3.0 * kPi * 0.125, 1e-16);
  EXPECT_LT((m.centroid - Vec3(1, 2, -3.0 / 8.0 * 0.5)).norm(), 1e-15);
  EXPECT_EQ(m.normal(), Vec3(0, 0, -1));
  EXPECT_DOUBLE_EQ(m.flatness(), 1.0);
}

TEST(HalfSpaceSphere, WhollyImmersedIsTheBallWithoutDirection) {
  for (double z : {-0.5, -0.7, -10.0}) {
    const VolumeMetrics m = cap(0.5, Vec3(1, 2, z));
    const VolumeMetrics own = Sphere({.radius = 0.5}).own_metrics();
    EXPECT_NEAR(m.volume, own.volume, 1e-15);
    EXPECT_LT((m.inertia - own.inertia).norm(), 1e-15);
    EXPECT_EQ(m.centroid, Vec3(1, 2, z));
    EXPECT_EQ(m.area_vector, Vec3(Vec3::Zero()));
    EXPECT_EQ(m.area_moment, Vec3(Vec3::Zero()));
    EXPECT_DOUBLE_EQ(m.depth, 1.0);
    EXPECT_NEAR(m.depth_moment, -z * own.volume, 1e-14);
    EXPECT_EQ(m.status, Status::kContained);
  }
}

TEST(HalfSpaceSphere, IsContinuousAtFullImmersion) {
  const double step = 1e-9;
  const VolumeMetrics before = cap(0.5, Vec3(0, 0, -0.5 + step)), at = cap(0.5, Vec3(0, 0, -0.5));
  EXPECT_NEAR(before.volume, at.volume, 1e-15);
  EXPECT_NEAR(before.depth_moment, at.depth_moment, 2.0 * step * at.volume);
  EXPECT_LT((before.inertia - at.inertia).norm(), 1e-9);
  EXPECT_LT((before.centroid - at.centroid).norm(), 2.0 * step);
  EXPECT_LT(before.area_vector.norm(), 4.0 * step);
}

TEST(HalfSpaceSphere, TouchingAndZeroRadiusAreNothing) {
  EXPECT_FALSE(cap(0.5, Vec3(0, 0, 0.5)).touching());
  EXPECT_FALSE(cap(0.5, Vec3(0, 0, 7.0)).touching());
  EXPECT_FALSE(cap(0.0, Vec3(0, 0, 0.0)).touching());
  EXPECT_FALSE(cap(0.0, Vec3(0, 0, -1.0)).touching());
  EXPECT_TRUE(cap(0.5, Vec3(0, 0, 0.5 - 1e-15)).touching());
}

TEST(HalfSpaceSphere, RestingDepthOfTheStaticCheck) {
  // m g = k V for 1 kg, R = 0.05 m, k = 1e8 N/m^3 (acceptance of the static scene).
  EXPECT_NEAR(1e8 * cap(0.05, Vec3(0, 0, 0.05 - 0.792364e-3)).volume, 9.81, 1e-5);
}

TEST(HalfSpaceSphere, InItsOwnFrameIsTheMirrorImage) {
  Random random(21);
  for (int i = 0; i < 200; ++i) {
    const Sphere solid = Sphere({.radius = random.uniform(0.1, 1.0)});
    const Mat3 r = random.rotation();
    const double reach = solid.support_height(r.row(2));
    const double share = i % 10 == 0 ? 1.2 : random.log_uniform(1e-6, 0.999);
    const Pose X{r,
                 Vec3(random.uniform(-1, 1), random.uniform(-1, 1), reach * (1.0 - 2.0 * share))};
    const VolumeMetrics mirrored =
        reversed(transformed(closed_form(HalfSpace(), solid, X), X.inverse()));
    EXPECT_TRUE(test::same(closed_form(solid, HalfSpace(), X.inverse()), mirrored, {2e-9, 1.0}));
  }
  const Pose apart{Mat3::Identity(), Vec3(0.0, 0.0, -3.0)};
  EXPECT_FALSE(closed_form(Sphere({.radius = 1.0}), HalfSpace(), apart).touching());
}

}  // namespace
}  // namespace volcontact::half_space_sphere_test
