// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/closed_form/half_space_frustum.h"

#include "core/reference/section_oracle.h"
#include "core/support/half_space_checks.h"

namespace volcontact::half_space_frustum_test {
namespace {

using test::immersed_by;
using test::Random;
using test::tilted_by;

Frustum random_frustum(Random& random) {
  const double top = random.uniform(0.1, 1.0);
  return Frustum({.bottom_radius = random.uniform(0.1, 1.0),
                  .top_radius = top,
                  .half_length = random.uniform(0.1, 1.0)});
}

// The sections' metrics, with the ends of the frustum and the fields they leave out.
VolumeMetrics expected_metrics(const Frustum& b, const Pose& X) {
  const auto& [bottom, top, half] = b.params();
  const long double r_0 = bottom, r_1 = top, h = half;
  const auto radius = [=](long double q) { return r_0 + (r_1 - r_0) * (q + h) / (2 * h); };
  const auto none = [](long double) { return 0.0L; };
  const long double slant = std::hypot(1.0L, (r_1 - r_0) / (2 * h));
  const auto wall = [=](long double) { return slant; };
  VolumeMetrics m = test::sections_below(test::Revolution{{-h, h}, radius, none, wall, none}, X);
  const Vec3 axis = X.rotation.col(2);
  for (double end : {-1.0, 1.0}) {
    const double r = end < 0.0 ? bottom : top, height = X.translation.z() + end * half * axis.z();
    const double reach = r * std::hypot(axis.x(), axis.y());
    const double c = reach > 0.0 ? std::clamp(height / reach, -1.0, 1.0) : 1.0;
    m.counter_area += r * r * (std::acos(c) - c * std::sqrt(1.0 - c * c));
  }
  m.depth = b.support_height(-X.rotation.row(2)) - X.translation.z();
  return m;
}

Frustum as_frustum(const Cylinder& c) {
  return Frustum(
      {.bottom_radius = c.radius(), .top_radius = c.radius(), .half_length = c.half_length()});
}

constexpr test::Tolerance kTight{1e-9, 1.0};

TEST(HalfSpaceFrustum, EqualsItsSections) {
  Random random(1);
  for (int i = 0; i < 120; ++i) {
    const Frustum b = random_frustum(random);
    const Mat3 R = tilted_by(random.uniform(0.02, kPi - 0.02), random);
    const double share = i % 3 ? random.uniform() : random.log_uniform(1e-3, 1.0);
    const Pose X = immersed_by(b, R, share, random);
    const VolumeMetrics m = closed_form(HalfSpace(), b, X);
    EXPECT_TRUE(test::same(m, expected_metrics(b, X), kTight)) << i;
  }
}

TEST(HalfSpaceFrustum, AConeEqualsItsSections) {
  Random random(2);
  for (int i = 0; i < 120; ++i) {
    const double r = random.uniform(0.1, 1.0), tip = i % 2 ? 0.0 : random.uniform(0.0, 0.05);
    const bool up = i % 4 < 2;
    const Frustum b({.bottom_radius = up ? r : tip,
                     .top_radius = up ? tip : r,
                     .half_length = random.uniform(0.1, 1.0)});
    const Mat3 R = tilted_by(random.uniform(0.02, kPi - 0.02), random);
    const Pose X = immersed_by(b, R, random.uniform(0.01, 0.99), random);
    const VolumeMetrics m = closed_form(HalfSpace(), b, X);
    EXPECT_TRUE(test::same(m, expected_metrics(b, X), kTight)) << i;
  }
}

TEST(HalfSpaceFrustum, AConeCutThroughItsTipIsHalfACone) {
  for (double tilt : {0.3, 0.7, 1.2, kPi / 2}) {
    // The plane holds the tip; by symmetry that halves the cone when it holds the axis as well.
    const Frustum b({.bottom_radius = 0.5, .top_radius = 0.0, .half_length = 0.4});
    const Mat3 R = test::turn(Vec3::UnitX(), tilt);
    const Pose X{R, -R * Vec3(0, 0, 0.4)};
    const Pose opposite{test::turn(Vec3::UnitX(), kPi + tilt), Vec3::Zero()};
    const Pose X_opposite{opposite.rotation, -opposite.rotation * Vec3(0, 0, 0.4)};
    const double whole = b.own_metrics().volume;
    const double parts =
        closed_form(HalfSpace(), b, X).volume + closed_form(HalfSpace(), b, X_opposite).volume;
    EXPECT_NEAR(parts / whole, 1.0, 1e-12);
    if (tilt == kPi / 2) {
      EXPECT_NEAR(closed_form(HalfSpace(), b, X).volume / whole, 0.5, 1e-12);
    }
  }
}

TEST(HalfSpaceCylinder, EqualsItsSections) {
  Random random(3);
  for (int i = 0; i < 120; ++i) {
    const Cylinder b({.radius = random.uniform(0.1, 1.0), .half_length = random.uniform(0.1, 1.0)});
    const Mat3 R = tilted_by(random.uniform(0.02, kPi - 0.02), random);
    const double share = i % 3 ? random.uniform() : random.log_uniform(1e-3, 1.0);
    const Pose X = immersed_by(b, R, share, random);
    const VolumeMetrics m = closed_form(HalfSpace(), b, X);
    EXPECT_TRUE(test::same(m, expected_metrics(as_frustum(b), X), {1e-10, 1.0})) << i;
  }
}

TEST(HalfSpaceCylinder, OfAHoofIsTheTextbookUngula) {
  // A plane through a diameter of the bottom, at the angle a: V = 2/3 r^3 tan(a), wall 2 r^2
  // tan(a), the cut half an ellipse, the centroid at 3 pi/16 r across and 3 pi/32 r tan(a) up.
  const double r = 0.7, angle = 0.4, rise = std::tan(angle);
  const Cylinder b({.radius = r, .half_length = 1.0});
  // Body B upright in its own frame, the plane through B's (0, 0, -1), normal (-sin, 0, cos).
  const Mat3 R = test::turn(Vec3::UnitY(), angle);  // takes that normal to z
  const Pose X{R, -R * Vec3(0, 0, -1)};
  const VolumeMetrics m = closed_form(HalfSpace(), b, X);
  EXPECT_NEAR(m.volume / (2.0 / 3.0 * r * r * r * rise), 1.0, 1e-13);
  EXPECT_NEAR(m.counter_area / (2.0 * r * r * rise + kPi * r * r / 2.0), 1.0, 1e-13);
  EXPECT_NEAR(m.area / (kPi * r * r / 2.0 / std::cos(angle)), 1.0, 1e-13);
  const Vec3 centroid_B = X.inverse() * m.centroid;
  EXPECT_NEAR(centroid_B.x(), 3.0 * kPi / 16.0 * r, 1e-13);
  EXPECT_NEAR(centroid_B.z(), -1.0 + 3.0 * kPi / 32.0 * r * rise, 1e-13);
}

TEST(HalfSpaceCylinder, UprightAndNearlySoIsADisc) {
  Random random(4);
  const double r = 0.4, half = 0.5, h = 0.3;
  const Cylinder b({.radius = r, .half_length = half});
  for (double tilt : {0.0, 1e-15, 1e-12, 1e-9, kPi - 1e-9, kPi}) {
    const Pose X{tilted_by(tilt, random), Vec3(0.2, 0.3, half - h)};
    const VolumeMetrics m = closed_form(HalfSpace(), b, X);
    VolumeMetrics expected;
    expected.volume = kPi * r * r * h;
    expected.centroid = Vec3(0.2, 0.3, -h / 2);
    const double across = expected.volume * (r * r / 4 + h * h / 12);
    expected.inertia = Vec3(across, across, expected.volume * r * r / 2).asDiagonal();
    expected.area = kPi * r * r;
    expected.area_vector = Vec3(0, 0, expected.area);
    expected.area_moment = Vec3(0.3, -0.2, 0.0) * expected.area;
    expected.counter_area = kPi * r * r + 2 * kPi * r * h;
    expected.depth_moment = expected.volume * h / 2;
    expected.depth = h;
    const double change = 4.0 * std::min(tilt, kPi - tilt);
    EXPECT_TRUE(test::same(m, expected, {1e-13 + change, 1.0})) << tilt;
    const VolumeMetrics exact = closed_form(HalfSpace(), b, Pose{Mat3::Identity(), X.translation});
    EXPECT_NEAR(m.volume, exact.volume, 1e-14 + change * change);  // even in the tilt
  }
}

TEST(HalfSpaceCylinder, LyingAndNearlySoIsASegment) {
  Random random(5);
  const double r = 0.4, half = 0.5;
  const Cylinder b({.radius = r, .half_length = half});
  for (double h : {1e-6, 1e-3, 0.1, 0.4, 0.7}) {
    for (double tilt : {0.0, 1e-15, 1e-12, 1e-9}) {
      const Pose X{tilted_by(kPi / 2 + tilt, random), Vec3(0.2, 0.3, r - h)};
      const VolumeMetrics m = closed_form(HalfSpace(), b, X);
      // The segment of the disc, in extended precision against cancellation.
      const long double w = std::sqrt(h * (2.0L * r - h)), c = static_cast<long double>(r) - h;
      const double area = static_cast<double>(r * (r * std::atan2(w, c)) - c * w);
      const double first =
          static_cast<double>(w * w * w * 2 / 3 - c * (r * (r * std::atan2(w, c)) - c * w));
      const double allowed = 1e-9 + 4.0 * tilt / h;
      EXPECT_NEAR(m.volume / (2 * half * area), 1.0, allowed);
      EXPECT_NEAR(m.depth_moment / (2 * half * first), 1.0, allowed + 1e-14 / h);
      EXPECT_NEAR(m.area / (2 * half * 2 * std::sqrt(h * (2 * r - h))), 1.0, allowed);
      EXPECT_NEAR(m.centroid.x(), 0.2, 1e-10 + 10.0 * tilt / h);
      EXPECT_NEAR(m.depth, h, 1e-15 + tilt);
    }
  }
}

TEST(HalfSpaceFrustum, GradientsAreTheForces) {
  Random random(6);
  for (int i = 0; i < 60; ++i) {
    const Frustum b = random_frustum(random);
    const Pose X = immersed_by(b, random.rotation(), random.uniform(0.1, 0.9), random);
    test::expect_gradients(b, X, 1e-5, 2e-8);
    const Cylinder c({.radius = random.uniform(0.1, 1.0), .half_length = random.uniform(0.1, 1.0)});
    test::expect_gradients(c, immersed_by(c, random.rotation(), random.uniform(0.1, 0.9), random),
                           1e-5, 2e-8);
  }
}

TEST(HalfSpaceFrustum, WhollyBelowIsContained) {
  Random random(7);
  for (int i = 0; i < 30; ++i) {
    const Frustum b = random_frustum(random);
    const auto& [bottom, top, half] = b.params();
    const double surface = kPi * (bottom * bottom + top * top) +
                           kPi * (bottom + top) * std::hypot(2 * half, top - bottom);
    const Mat3 R = random.rotation();
    test::expect_contained(b, immersed_by(b, R, random.uniform(1.001, 1.5), random), surface);
    test::expect_continuous_into_containment(b, R, random);
  }
}

TEST(HalfSpaceFrustum, ApartAndFlatAreNothing) {
  Random random(8);
  const Cylinder disc({.radius = 1.0, .half_length = 0.0}),
      wire({.radius = 0.0, .half_length = 1.0});
  const Frustum flat({.bottom_radius = 1.0, .top_radius = 0.5, .half_length = 0.0});
  for (int i = 0; i < 50; ++i) {
    const Pose X = random.pose(1.0);
    EXPECT_FALSE(closed_form(HalfSpace(), disc, X).touching());
    EXPECT_FALSE(closed_form(HalfSpace(), wire, X).touching());
    EXPECT_FALSE(closed_form(HalfSpace(), flat, X).touching());
    const Frustum b = random_frustum(random);
    EXPECT_FALSE(closed_form(HalfSpace(), b, immersed_by(b, X.rotation, -1e-9, random)).touching());
  }
}

}  // namespace
}  // namespace volcontact::half_space_frustum_test
