// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/closed_form/half_space_capsule.h"

#include "core/reference/section_oracle.h"
#include "core/support/half_space_checks.h"
#include "volcontact/pair/closed_form/half_space_sphere.h"

namespace volcontact::half_space_capsule_test {
namespace {

using test::immersed_by;
using test::Random;
using test::tilted_by;

VolumeMetrics expected_metrics(const Capsule& b, const Pose& X) {
  const long double r = b.radius(), h = b.half_length();
  const auto radius = [=](long double q) {
    const long double z = std::max(0.0L, std::abs(q) - h);
    return std::sqrt(std::max(0.0L, (r - z) * (r + z)));
  };
  const auto none = [](long double) { return 0.0L; };
  const auto wall = [=](long double q) { return std::abs(q) > h ? r / radius(q) : 1.0L; };
  // Breaks towards the poles: a chord close by turns fast there.
  std::vector<long double> breaks{-h, h};
  for (long double rest = r; rest > 1e-7L * r; rest /= 4) {
    breaks.insert(breaks.end(), {h + r - rest, -(h + r - rest)});
  }
  breaks.insert(breaks.end(), {h + r, -(h + r)});
  std::sort(breaks.begin(), breaks.end());
  VolumeMetrics m = test::sections_below(test::Revolution{breaks, radius, none, wall, none}, X);
  m.depth = b.support_height(-X.rotation.row(2)) - X.translation.z();
  return m;
}

Capsule random_capsule(Random& random) {
  const double r = random.uniform(0.1, 1.0);
  return Capsule({.radius = r, .half_length = random.uniform(0.1, 1.0)});
}

TEST(HalfSpaceCapsule, EqualsItsSections) {
  Random random(1);
  for (int i = 0; i < 60; ++i) {
    const Capsule b = random_capsule(random);
    const Mat3 R = tilted_by(random.uniform(0.02, kPi - 0.02), random);
    const double share = i % 3 ? random.uniform() : random.log_uniform(1e-3, 1.0);
    const Pose X = immersed_by(b, R, share, random);
    const VolumeMetrics m = closed_form(HalfSpace(), b, X);
    EXPECT_TRUE(test::same(m, expected_metrics(b, X), {1e-9, 1.0})) << i;
  }
}

TEST(HalfSpaceCapsule, LyingNearlyFlatEqualsItsSections) {
  Random random(2);
  for (int i = 0; i < 60; ++i) {
    const Capsule b = random_capsule(random);
    const double tilt = (i % 2 ? 1.0 : -1.0) * random.log_uniform(1e-9, 0.3);
    const Pose X =
        immersed_by(b, tilted_by(kPi / 2 + tilt, random), random.log_uniform(1e-4, 0.9), random);
    const VolumeMetrics m = closed_form(HalfSpace(), b, X);
    EXPECT_TRUE(test::same(m, expected_metrics(b, X), {1e-9, 1.0})) << i;
  }
}

TEST(HalfSpaceCapsule, StandingItsTipIsTheCapOfABall) {
  Random random(3);
  const Capsule b({.radius = 0.3, .half_length = 0.5});
  const Sphere ball({.radius = 0.3});
  for (double tilt : {0.0, 1e-12, 1e-9, 0.2, kPi - 0.3, kPi}) {
    for (double h : {1e-9, 1e-4, 0.01, 0.1}) {
      const Mat3 R = tilted_by(tilt, random);
      const Vec3 low_end = (R(2, 2) > 0.0 ? -0.5 : 0.5) * R.col(2);
      const Vec3 ball_center(0.1, 0.2, 0.3 - h);
      const VolumeMetrics m = closed_form(HalfSpace(), b, Pose{R, ball_center - low_end});
      const VolumeMetrics expected =
          closed_form(HalfSpace(), ball, Pose{Mat3::Identity(), ball_center});
      // Where the plane meets the ball only, metrics are those of the ball.
      EXPECT_TRUE(test::same(m, expected, {1e-12 + 1e-15 / h, 1.0})) << tilt << " " << h;
    }
  }
}

TEST(HalfSpaceCapsule, WithoutACylinderIsABall) {
  Random random(4);
  const Capsule b({.radius = 0.3, .half_length = 0.0});
  const Sphere ball({.radius = 0.3});
  for (int i = 0; i < 100; ++i) {
    const Pose X = immersed_by(b, random.rotation(), random.log_uniform(1e-4, 1.2), random);
    EXPECT_TRUE(test::same(closed_form(HalfSpace(), b, X), closed_form(HalfSpace(), ball, X),
                           {2e-10, 1.0}));
  }
}

TEST(HalfSpaceCapsule, HalfImmersedAtAnyTiltIsHalfTheSolid) {
  Random random(5);
  for (int i = 0; i < 50; ++i) {
    const Capsule b = random_capsule(random);
    const Pose X{random.rotation(), Vec3(0.3, 0.2, 0.0)};
    const VolumeMetrics m = closed_form(HalfSpace(), b, X), own = b.own_metrics();
    EXPECT_NEAR(m.volume / own.volume, 0.5, 1e-13);
    EXPECT_NEAR(m.counter_area, 2.0 * kPi * b.radius() * (b.radius() + b.half_length()), 1e-12);
  }
}

TEST(HalfSpaceCapsule, GradientsAreTheForces) {
  Random random(6);
  for (int i = 0; i < 60; ++i) {
    const Capsule b = random_capsule(random);
    const Pose X = immersed_by(b, random.rotation(), random.uniform(0.02, 0.98), random);
    test::expect_gradients(b, X, 1e-5, 2e-8);
  }
}

TEST(HalfSpaceCapsule, WhollyBelowIsContained) {
  Random random(7);
  for (int i = 0; i < 30; ++i) {
    const Capsule b = random_capsule(random);
    const double surface = 4.0 * kPi * b.radius() * (b.radius() + b.half_length());
    const Mat3 R = random.rotation();
    test::expect_contained(b, immersed_by(b, R, random.uniform(1.001, 1.5), random), surface);
    test::expect_continuous_into_containment(b, R, random);
  }
}

TEST(HalfSpaceCapsule, ApartAndThinAreNothing) {
  Random random(8);
  const Capsule wire({.radius = 0.0, .half_length = 1.0});
  for (int i = 0; i < 50; ++i) {
    EXPECT_FALSE(closed_form(HalfSpace(), wire, random.pose(1.0)).touching());
    const Capsule b = random_capsule(random);
    EXPECT_FALSE(
        closed_form(HalfSpace(), b, immersed_by(b, random.rotation(), -1e-9, random)).touching());
  }
}

}  // namespace
}  // namespace volcontact::half_space_capsule_test
