// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/torus_pair/torus_pair.h"

#include <gtest/gtest.h>

#include "core/support/evaluated.h"
#include "core/support/gradient.h"
#include "core/support/matchers.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"

namespace volcontact::torus_pair_test {
namespace {

using test::evaluated;

constexpr double kMajor = 0.3, kMinor = 0.1;
const Shape kRing = Torus({.major_radius = kMajor, .minor_radius = kMinor});

Shape ring(double major, double minor) {
  return Torus({.major_radius = major, .minor_radius = minor});
}
Pose at(const Vec3& p) { return {Mat3::Identity(), p}; }

// Moves B along d until V is about `volume`.
Pose pushed_together(const Shape& a, const Shape& b, const Mat3& R, const Vec3& d, double volume) {
  double in = 0.0, out = 2.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (in + out);
    (evaluated(a, b, {R, middle * d}).total.volume > volume ? in : out) = middle;
  }
  return {R, in * d};
}

TEST(TorusPair, IsServedByLinesInBothOrders) {
  test::Random random(1);
  const Shape other = ring(0.25, 0.06);
  EXPECT_EQ(engine_for(kRing, other), Engine::kLines);
  for (int i = 0; i < 50; ++i) {
    const Pose X{random.rotation(), random.in_box(0.4)};
    const Interference out = evaluated(kRing, other, X),
                       swapped = evaluated(other, kRing, X.inverse());
    EXPECT_EQ(out.engine, Engine::kLines);
    ASSERT_EQ(out.sites.size(), swapped.sites.size());
    if (!out.total.touching()) continue;
    EXPECT_TRUE(test::same(reversed(transformed(swapped.total, X)), out.total, {1e-4, kMajor}));
  }
}

// By Pappus, from the lens of two circles: half of it on either side of the chord.
TEST(TorusPair, CoaxialRingsOverlapInALensThatGoesRound) {
  for (double depth : {1e-6, 1e-4, 0.01, 0.07}) {
    const double r = kMinor, d = 2.0 * r - depth;  // between the middles of the tubes
    const double half_angle = std::acos(0.5 * d / r);
    const double area = r * r * (2.0 * half_angle - std::sin(2.0 * half_angle));
    const double outward = kMajor + 0.5 * d, up = kMajor;
    const Interference beside = evaluated(kRing, ring(kMajor + d, r), at(Vec3::Zero())),
                       above = evaluated(kRing, kRing, at({0.0, 0.0, d}));
    for (const Interference* out : {&beside, &above}) {
      const double radius = out == &beside ? outward : up;
      ASSERT_EQ(out->sites.size(), 1u);
      // The closed form loses digits of thin lenses itself.
      EXPECT_NEAR(out->total.volume, 2.0 * kPi * radius * area,
                  1e-5 * out->total.volume + 1e-15 * kMajor);
      EXPECT_NEAR(out->total.depth, depth, 1e-12);
      EXPECT_EQ(out->engine, Engine::kLines);
    }
    EXPECT_NEAR(above.total.centroid.z(), 0.5 * d, 1e-9);
    // The shadow of the lens, seen along the axis, is a ring as wide as its chord.
    const double chord = 2.0 * r * std::sin(half_angle);
    EXPECT_NEAR(above.total.area_vector.z(), 2.0 * kPi * up * chord, 1e-6 * above.total.area);
  }
}

TEST(TorusPair, RingsAreContainedInThickerOnes) {
  test::Random random(3);
  const Shape thin = ring(kMajor, 0.03);
  const double volume = 2.0 * kPi * kMajor * kPi * 0.03 * 0.03;  // Pappus
  for (int i = 0; i < 20; ++i) {
    const Pose X{test::turn(random.direction(), 0.05), random.in_box(0.01)};
    const VolumeMetrics m = evaluated(kRing, thin, X).total,
                        swapped = evaluated(thin, kRing, X.inverse()).total;
    for (const VolumeMetrics* one : {&m, &swapped}) {
      EXPECT_EQ(one->status, Status::kContained);
      EXPECT_NEAR(one->volume, volume, 1e-15);
    }
    EXPECT_LE((m.centroid - X.translation).norm(), 1e-15);
  }
}

// They have no surface in one another; a hair's breadth apart they have half of it.
TEST(TorusPair, IdenticalRingsAreAllInOneAnother) {
  const double volume = 2.0 * kPi * kMajor * kPi * kMinor * kMinor;
  test::Random random(4);
  for (double off : {0.0, 1e-16, 1e-14, 1e-12, 1e-10, 1e-8, 1e-6}) {
    for (int i = 0; i < 3; ++i) {
      const Pose X{test::turn(Vec3::UnitZ(), random.uniform(-3.0, 3.0)) *
                       test::turn(random.direction(), off),
                   off * random.direction()};
      const VolumeMetrics m = evaluated(kRing, kRing, X).total;
      EXPECT_NEAR(m.volume, volume, (2e-4 + 20.0 * off) * volume + m.volume_error) << off;
      EXPECT_LE(m.centroid.norm(), 1e-3 * kMajor + 10.0 * off);
    }
  }
}

TEST(TorusPair, LinkedRingsNeedNotTouch) {
  const Mat3 upright = test::turn(Vec3::UnitX(), 0.5 * kPi);
  EXPECT_FALSE(evaluated(kRing, kRing, {upright, {kMajor, 0.0, 0.0}}).total.touching());
  // Pulled apart they touch at the one place in the hole of both.
  const double touching = 2.0 * (kMajor - kMinor);
  EXPECT_FALSE(evaluated(kRing, kRing, {upright, {touching - 1e-9, 0, 0}}).total.touching());
  const Interference out = evaluated(kRing, kRing, {upright, {touching + 1e-6, 0.0, 0.0}});
  ASSERT_EQ(out.sites.size(), 1u);
  EXPECT_NEAR(out.total.depth, 1e-6, 1e-12);
  EXPECT_LE((out.total.centroid - Vec3(kMajor - kMinor, 0.0, 0.0)).norm(), 1e-5);
  EXPECT_LE((out.total.normal() - Vec3::UnitX()).norm(), 1e-6);
  // Two equal saddles: gap d - k x^2 / 2 - k y^2 / 2 with k of each direction the sum of
  // 1 / (R - r), of the hole, taken negative, and 1 / r.
  const double k = 1.0 / kMinor - 1.0 / (kMajor - kMinor);
  EXPECT_NEAR(out.total.volume, kPi * 1e-12 / k, 1e-4 * out.total.volume);
}

TEST(TorusPair, RingsThatTouchFromOutsideHaveALensOfKnownSize) {
  for (double depth : {1e-10, 1e-7, 1e-5}) {
    const Mat3 upright = test::turn(Vec3::UnitX(), 0.5 * kPi);
    const double touching = 2.0 * (kMajor + kMinor);
    EXPECT_FALSE(evaluated(kRing, kRing, {upright, {touching + depth, 0, 0}}).total.touching());
    const VolumeMetrics m = evaluated(kRing, kRing, {upright, {touching - depth, 0, 0}}).total;
    const double k = 1.0 / kMinor + 1.0 / (kMajor + kMinor);  // of the gap, in every direction
    EXPECT_NEAR(m.volume, kPi * depth * depth / k, (1e-4 + 10.0 * depth) * m.volume) << depth;
    EXPECT_NEAR(m.depth, depth, 1e-6 * depth);
    EXPECT_NEAR(m.depth_moment, m.volume * depth / 3.0, (1e-3 + 10.0 * depth) * m.depth_moment);
    EXPECT_LE((m.normal() + Vec3::UnitX()).norm(), 1e-6);
  }
}

TEST(TorusPair, RingsOfOnePlaneThatCrossTouchInTwoSites) {
  const Interference out = evaluated(kRing, kRing, at({0.3, 0.0, 0.0}));
  ASSERT_EQ(out.sites.size(), 2u);
  EXPECT_NEAR(out.sites[0].volume, out.sites[1].volume, 1e-4 * out.total.volume);
  EXPECT_NEAR(out.sites[0].centroid.y(), -out.sites[1].centroid.y(), 1e-4);
  EXPECT_NEAR(out.total.centroid.x(), 0.15, 1e-5);
  EXPECT_EQ(out.engine, Engine::kLines);
}

// A ring about an ellipse of the other one's tube: a thin ring stands across a flat one and goes
// through it four times.
TEST(TorusPair, ACircleMayPassThroughAnotherFourTimes) {
  const double r = 0.004;
  const Shape thick = ring(0.3, 0.1), thin = ring(0.1, r);
  // Around the tube, tilted: its circle leaves the tube at two places and comes back at two.
  const Mat3 R = test::turn(Vec3::UnitX(), 0.5 * kPi) * test::turn(Vec3::UnitY(), 0.0);
  const Pose X{test::turn(Vec3::UnitZ(), 0.35) * R, {0.3, 0.0, 0.0}};
  const Interference out = evaluated(thick, thin, X);
  EXPECT_EQ(out.engine, Engine::kLines);
  const Interference octree = evaluated(thick, thin, X, Engine::kOctree, 1e-2);
  EXPECT_NEAR(out.total.volume, octree.total.volume, octree.total.volume_error);
  EXPECT_EQ(out.sites.size(), octree.sites.size());
}

TEST(TorusPair, OctreeBoundsHoldTheVolume) {
  test::Random random(5);
  for (int i = 0; i < test::cases(6, 2); ++i) {
    const Shape a = ring(random.uniform(0.2, 0.5), random.uniform(0.05, 0.15)),
                b = ring(random.uniform(0.2, 0.5), random.uniform(0.05, 0.15));
    const Pose X{random.rotation(), random.in_box(0.4)};
    const Interference out = evaluated(a, b, X), octree = evaluated(a, b, X, Engine::kOctree, 2e-2);
    EXPECT_NEAR(out.total.volume, octree.total.volume,
                octree.total.volume_error + 1e-4 * out.total.volume);
    EXPECT_EQ(out.sites.size(), octree.sites.size());
  }
}

TEST(TorusPair, AreaVectorAndMomentAreTheGradientOfVolume) {
  test::Random random(6);
  const Shape other = ring(0.25, 0.06);
  for (int i = 0; i < 20; ++i) {
    const Pose X{random.rotation(), random.in_box(0.4)};
    const InterferenceOptions options{.tolerance = 1e-6};
    const VolumeMetrics m = evaluated(kRing, other, X, options).total;
    if (m.volume < 1e-6) continue;
    const auto volume = [&](const Pose& X_AB) {
      return evaluated(kRing, other, X_AB, options).total.volume;
    };
    const test::Gradient g = test::gradient_of_A(volume, X, 1e-4);
    EXPECT_LE((g.shift - m.area_vector).norm(), 1e-3 * m.area);
    EXPECT_LE((g.turn - m.area_moment).norm(), 1e-3 * m.area * kMajor);
  }
}

// Where a push along the normal deepens a small overlap, its depth moment is the potential of V.
TEST(TorusPair, DepthMomentIsThePotentialOfVolume) {
  test::Random random(7);
  for (int i = 0; i < 5; ++i) {
    const Vec3 d = random.direction();
    const Pose X = pushed_together(kRing, kRing, random.rotation(), d, 1e-6);
    const VolumeMetrics m = evaluated(kRing, kRing, X).total;
    const double step = 1e-3 * m.depth;
    const auto depth_moment = [&](double way) {
      return evaluated(kRing, kRing, {X.rotation, X.translation + way * m.normal()})
          .total.depth_moment;
    };
    EXPECT_NEAR((depth_moment(step) - depth_moment(-step)) / (2.0 * step), m.volume,
                0.05 * m.volume);
  }
}

// Across places where arcs appear, part and merge.
TEST(TorusPair, VolumeIsContinuousAlongAMotion) {
  const Mat3 R = test::turn(Vec3(1.0, 2.0, 0.5).normalized(), 1.1);
  double before = 0.0;
  constexpr int kSteps = 300;
  const double step = 1.0 / kSteps;
  for (int i = 0; i <= kSteps; ++i) {
    const Interference out = evaluated(kRing, kRing, {R, {-0.5 + i * step, 0.05, 0.02}});
    EXPECT_EQ(out.engine, Engine::kLines);
    // A step sweeps no more than the shadow of a ring.
    if (i > 0) {
      EXPECT_LE(std::abs(out.total.volume - before),
                step * std::max(out.total.area, 4.0 * step * kMajor) + 1e-6);
    }
    before = out.total.volume;
  }
}

// A thin ring that lies along the outer equator of a thick one, its own radius off it: on both
// sides of the circle at which the two only touch it leaves the thick one. V is smooth, and near to
// a sum over slices of the thin tube.
TEST(TorusPair, AThinRingThatLeavesAThickOneBesideATouch) {
  constexpr double kThin = 7e-5, kWide = 0.15, kThick = 0.0577;
  constexpr double kOff[] = {-1.0, -0.97, -1e-3, 0.0, 1e-7, 1e-3, 1.0};
  for (std::size_t i = 0; i < std::size(kOff); i += test::cases(1, 3)) {
    const double off = kOff[i];
    // The circles of the two in one plane but for `lower`; the thin tube ends `off` of itself off.
    const double major = 0.1154, lower = -kThin, out = major + kThick + kThin * (1.0 + 1e-6 * off);
    const Pose X{test::turn(Vec3::UnitX(), 1e-8), Vec3(0.0, out - kWide, lower)};
    // Columns of the thin tube, slice by slice.
    constexpr int kAngles = 1500, kPoints = 40;
    double expected = 0.0;
    for (int slice = 0; slice < kAngles; ++slice) {
      const double t = kPi * (slice + 0.5) / kAngles;
      for (int k = 0; k < kPoints; ++k) {
        const double r = kThin * std::sqrt((k + 0.5) / kPoints);
        for (int j = 0; j < kPoints; ++j) {
          const double a = 2.0 * kPi * (j + 0.5) / kPoints, rho = kWide + r * std::cos(a);
          const Vec3 x = X * Vec3(rho * std::sin(t), rho * std::cos(t), r * std::sin(a));
          const double across = std::hypot(x.x(), x.y()) - major;
          if (across * across + x.z() * x.z() < kThick * kThick) expected += rho;
        }
      }
    }
    expected *= 2.0 * kPi / kAngles * kPi * kThin * kThin / (kPoints * kPoints);
    const Shape thick = ring(major, kThick), thin = ring(kWide, kThin);
    for (const VolumeMetrics& m :
         {evaluated(thick, thin, X).total, reversed(evaluated(thin, thick, X.inverse()).total)}) {
      EXPECT_NEAR(m.volume, expected, m.volume_error + 1e-4 * expected) << off;
      EXPECT_EQ(m.status, Status::kOk) << off;
    }
  }
}

TEST(TorusPair, RingsOfNoThicknessOverlapInNothing) {
  EXPECT_FALSE(evaluated(kRing, ring(0.3, 0.0), at(Vec3::Zero())).total.touching());
  EXPECT_FALSE(evaluated(ring(0.0, 0.0), kRing, at({0.3, 0.0, 0.0})).total.touching());
}

}  // namespace
}  // namespace volcontact::torus_pair_test
