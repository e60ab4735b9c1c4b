// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/closed_form/half_space_ellipsoid.h"

#include <gtest/gtest.h>

#include "core/support/gradient.h"
#include "core/support/matchers.h"
#include "volcontact/pair/closed_form/half_space_sphere.h"

namespace volcontact::half_space_ellipsoid_test {
namespace {

using test::Random;

Ellipsoid random_ellipsoid(Random& random) {
  return Ellipsoid({.semi_axes = Vec3(random.uniform(0.1, 1.0), random.uniform(0.1, 1.0),
                                      random.uniform(0.1, 1.0))});
}

// A pose with the given share of the height of the solid below the plane.
Pose pose_at(const Ellipsoid& solid, double share, Random& random) {
  const Mat3 r = random.rotation();
  const double reach = solid.support_height(r.row(2));
  return {r, Vec3(random.uniform(-1, 1), random.uniform(-1, 1), reach * (1.0 - 2.0 * share))};
}

// Slices z = const of the ellipsoid are ellipses, found by completing the square (Schur complement)
// in the quadric: an oracle that knows nothing of the map to the ball. A five-point Gauss rule is
// exact for the polynomials in z.
VolumeMetrics slices(const Ellipsoid& solid, const Pose& X) {
  const Mat3 quadric = X.rotation *
                       Mat3(solid.semi_axes().cwiseAbs2().cwiseInverse().asDiagonal()) *
                       X.rotation.transpose();
  const Mat2 level_part = quadric.block<2, 2>(0, 0);
  const Mat2 inverse =
      Mat2(level_part(1, 1), -level_part(0, 1), -level_part(1, 0), level_part(0, 0)) /
      level_part.determinant();
  const Vec2 lean = -(inverse * quadric.col(2).head<2>());  // of the centres
  const double full = kPi * std::sqrt(inverse.determinant());
  const double top = solid.support_height(X.rotation.row(2));
  const double z_0 = X.translation.z(), to = std::min(-z_0, top);  // from the centre
  constexpr double kNodes[] = {0.0, 0.538469310105683091, 0.906179845938663993};
  constexpr double kWeights[] = {0.568888888888888889, 0.478628670499366468, 0.236926885056189088};
  MomentSum sum;
  double depth_moment = 0.0;
  for (int i = -2; i <= 2; ++i) {
    const int k = std::abs(i);
    const double z = -top + 0.5 * (to + top) * (1.0 + (i < 0 ? -kNodes[k] : kNodes[k]));
    const double level = 1.0 - z * z / (top * top);
    const double dv = 0.5 * (to + top) * kWeights[k] * full * level;
    Vec3 p(lean.x() * z, lean.y() * z, z);
    p += X.translation;
    Mat3 spread = Mat3::Zero();
    spread.set_block(0, 0, 0.25 * level * inverse);
    sum.volume += dv;
    sum.first += dv * p;
    sum.second += dv * (outer(p, p) + spread);
    depth_moment -= dv * p.z();
  }
  const double cut = full * (1.0 - z_0 * z_0 / (top * top));
  if (to < top) {
    sum.area = cut;
    sum.area_vector = Vec3(0, 0, cut);
    sum.area_moment =
        cut * Vec3(X.translation.x() - lean.x() * z_0, X.translation.y() - lean.y() * z_0, 0.0)
                  .cross(Vec3::UnitZ());
  }
  VolumeMetrics m = sum.metrics();
  m.depth_moment = depth_moment;
  m.depth = to + top;
  m.status = to < top ? Status::kOk : Status::kContained;
  return m;
}

TEST(HalfSpaceEllipsoid, EqualsTheStackOfEllipses) {
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    const Ellipsoid solid = random_ellipsoid(random);
    const Pose X = pose_at(solid, i % 10 == 0 ? 1.2 : random.uniform(0.001, 0.999), random);
    const VolumeMetrics m = closed_form(HalfSpace(), solid, X);
    VolumeMetrics expected = slices(solid, X);
    expected.counter_area = m.counter_area;  // a bound only, see below
    EXPECT_TRUE(test::same(m, expected, {1e-10, 1.0}));
    EXPECT_LE(std::abs(m.volume - expected.volume), m.volume_error + 1e-12 * expected.volume);
  }
}

TEST(HalfSpaceEllipsoid, ShallowCapKeepsItsRelativeAccuracy) {
  // Axes parallel to the plane's: V = pi a b h^2 / c (1 - h / 3c), exactly representable depths.
  const Ellipsoid solid({.semi_axes = Vec3(0.75, 0.5, 0.25)});
  for (int bits = 10; bits < 45; ++bits) {
    const double h = std::ldexp(1.0, -bits);
    const VolumeMetrics m =
        closed_form(HalfSpace(), solid, Pose{Mat3::Identity(), Vec3(0, 0, 0.25 - h)});
    const double volume = kPi * 0.375 * h * h / 0.25 * (1.0 - h / 0.75);
    EXPECT_NEAR(m.volume / volume, 1.0, 1e-13);
    EXPECT_NEAR(m.centroid.z() / (-h * (1.0 - h) / (3.0 - 4.0 * h)), 1.0, 1e-13);
    // Along z the spread falls with h^2: it must not drown in that of x and y.
    const double axial = volume * h * h / 18.0;
    EXPECT_NEAR(
        (closed_form(HalfSpace(), solid, Pose{test::turn(Vec3::UnitX(), kPi), Vec3(0, 0, 0.25 - h)})
             .inertia -
         m.inertia)
            .norm(),
        0.0, 1e-13 * m.inertia.norm());
    EXPECT_GT(axial, 0.0);
  }
}

TEST(HalfSpaceEllipsoid, EqualsTheBallWhenRound) {
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const double r = random.uniform(0.1, 1.0);
    const Pose X{random.rotation(), Vec3(0.3, -0.4, r * random.uniform(-1.2, 0.999))};
    const VolumeMetrics m =
        closed_form(HalfSpace(), Ellipsoid({.semi_axes = Vec3::Constant(r)}), X);
    EXPECT_TRUE(test::same(m, closed_form(HalfSpace(), Sphere({.radius = r}), X), {1e-11, r}));
  }
}

TEST(HalfSpaceEllipsoid, AreaVectorAndMomentAreTheGradientOfTheVolume) {
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const Ellipsoid solid = random_ellipsoid(random);
    const Pose X = pose_at(solid, random.uniform(0.05, 0.95), random);
    const auto volume = [&](const Pose& pose) {
      return closed_form(HalfSpace(), solid, pose).volume;
    };
    const VolumeMetrics m = closed_form(HalfSpace(), solid, X);
    const test::Gradient gradient = test::gradient_of_A(volume, X, 1e-3);
    EXPECT_LT((m.area_vector - gradient.shift).norm(), 1e-8);
    EXPECT_LT((m.area_moment - gradient.turn).norm(), 1e-8);
  }
}

TEST(HalfSpaceEllipsoid, BuoyancyAtTheCentroidIsTheGradientOfTheDepthMoment) {
  // f = V along z through the centroid of the volume is conservative (Archimedes).
  Random random(4);
  for (int i = 0; i < 50; ++i) {
    const Ellipsoid solid = random_ellipsoid(random);
    const Pose X = pose_at(solid, random.uniform(0.05, 1.1), random);
    const auto potential = [&](const Pose& pose) {
      return closed_form(HalfSpace(), solid, pose).depth_moment;
    };
    const VolumeMetrics m = closed_form(HalfSpace(), solid, X);
    const test::Gradient gradient = test::gradient_of_A(potential, X, 1e-3);
    const Vec3 force_on_A = -m.volume * Vec3::UnitZ();
    EXPECT_LT((gradient.shift + force_on_A).norm(), 1e-8);
    EXPECT_LT((gradient.turn + m.centroid.cross(force_on_A)).norm(), 1e-8);
  }
}

// Area of the curved side, by a fine grid on the unit ball.
double curved_area(const Ellipsoid& solid, const Pose& X) {
  const Vec3 a = solid.semi_axes();
  const Vec3 cofactors(a.y() * a.z(), a.z() * a.x(), a.x() * a.y());
  constexpr int kRings = 400;
  double area = 0.0;
  for (int i = 0; i < kRings; ++i) {
    const double z = -1.0 + (i + 0.5) * 2.0 / kRings, r = std::sqrt(1.0 - z * z);
    for (int j = 0; j < 2 * kRings; ++j) {
      const double angle = kPi * (j + 0.5) / kRings;
      const Vec3 u(r * std::cos(angle), r * std::sin(angle), z);
      if ((X * Vec3(a.cwiseProduct(u))).z() > 0.0) continue;
      area += cofactors.cwiseProduct(u).norm() * 2.0 * kPi / (kRings * kRings);
    }
  }
  return area;
}

TEST(HalfSpaceEllipsoid, CurvedAreaIsABoundNotFarFromTheTruth) {
  Random random(5);
  double worst = 1.0;
  for (int i = 0; i < 40; ++i) {
    const Ellipsoid solid = random_ellipsoid(random);
    const Pose X = pose_at(solid, random.uniform(0.1, 1.0), random);
    const VolumeMetrics m = closed_form(HalfSpace(), solid, X);
    const double truth = curved_area(solid, X);
    EXPECT_GE(m.counter_area, truth * (1.0 - 5e-3));  // the grid is that coarse
    EXPECT_GE(m.counter_area, m.area);
    EXPECT_NEAR(m.flatness(), m.status == Status::kOk ? 1.0 : 0.0, 1e-14);
    worst = std::max(worst, m.counter_area / truth);
  }
  EXPECT_LT(worst, 1.25);  // aspect ratios to 10
}

TEST(HalfSpaceEllipsoid, FlatAndTouchingAreNothing) {
  Random random(6);
  const Ellipsoid plate({.semi_axes = Vec3(1, 1, 0)});
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(closed_form(HalfSpace(), plate, random.pose(1.0)).touching());
  }
  const Pose flat_down{Mat3::Identity(), Vec3(0, 0, -0.1)};
  EXPECT_FALSE(closed_form(HalfSpace(), plate, flat_down).touching());
  const Ellipsoid solid({.semi_axes = Vec3(1, 2, 3)});
  EXPECT_FALSE(closed_form(HalfSpace(), solid, Pose{Mat3::Identity(), Vec3(0, 0, 3)}).touching());
}

TEST(HalfSpaceEllipsoid, InItsOwnFrameIsTheMirrorImage) {
  Random random(21);
  for (int i = 0; i < 200; ++i) {
    const Ellipsoid solid = random_ellipsoid(random);
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
  EXPECT_FALSE(closed_form(Ellipsoid({.semi_axes = Vec3(1, 2, 3)}), HalfSpace(), apart).touching());
}

}  // namespace
}  // namespace volcontact::half_space_ellipsoid_test
