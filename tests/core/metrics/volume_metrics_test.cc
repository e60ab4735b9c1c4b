// SPDX-License-Identifier: Apache-2.0
#include "volcontact/metrics/volume_metrics.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/support/matchers.h"
#include "core/support/random.h"
#include "volcontact/shape/box.h"

namespace volcontact::volume_metrics_test {
namespace {

using test::Random;
using test::same;
using test::Tolerance;

constexpr Tolerance kRounding{1e-13, 1.0};

// Metrics of a box with half sizes h centred at c, all fields filled with something plausible.
VolumeMetrics box_at(const Vec3& h, const Vec3& c) {
  VolumeMetrics m = Box({.half_sizes = h}).own_metrics();
  m.centroid = c;
  m.area = 0.3;
  m.counter_area = 0.2;
  m.area_vector = Vec3(0.1, -0.05, 0.15);
  m.area_moment = c.cross(m.area_vector);
  m.depth = 2.0 * h.z();
  m.depth_moment = m.volume * h.z();
  m.volume_error = 1e-16;
  return m;
}

TEST(VolumeMetrics, HalvesOfABoxAddToTheBox) {
  const Vec3 half(0.1, 0.2, 0.3), quarter(0.1, 0.2, 0.15);
  const VolumeMetrics sum = box_at(quarter, Vec3(1, 2, 2.85)) + box_at(quarter, Vec3(1, 2, 3.15));
  const VolumeMetrics whole = box_at(half, Vec3(1, 2, 3));
  EXPECT_NEAR(sum.volume, whole.volume, 1e-16);
  EXPECT_LT((sum.centroid - whole.centroid).norm(), 1e-14);
  EXPECT_LT((sum.inertia - whole.inertia).norm(), 1e-14);
  // What adds, what takes the larger one.
  EXPECT_DOUBLE_EQ(sum.area, 0.6);
  EXPECT_DOUBLE_EQ(sum.volume_error, 2e-16);
  EXPECT_DOUBLE_EQ(sum.depth, 0.3);
  EXPECT_DOUBLE_EQ(sum.depth_moment, 2.0 * 0.15 * 0.15 * 8.0 * 0.1 * 0.2);
}

TEST(VolumeMetrics, NothingIsNeutralInASum) {
  const VolumeMetrics m = box_at(Vec3(0.1, 0.2, 0.3), Vec3(1, 2, 3));
  EXPECT_TRUE(same(m + VolumeMetrics{}, m, kRounding));
  EXPECT_TRUE(same(VolumeMetrics{} + m, m, kRounding));
  EXPECT_FALSE((VolumeMetrics{} + VolumeMetrics{}).touching());
}

TEST(VolumeMetrics, SumTakesTheWorseStatus) {
  VolumeMetrics a = box_at(Vec3::Ones(), Vec3::Zero()), b = a;
  b.status = Status::kApproximate;
  EXPECT_EQ((a + b).status, Status::kApproximate);
  EXPECT_EQ((b + a).status, Status::kApproximate);
}

TEST(VolumeMetrics, TransformedThereAndBackIsTheSame) {
  Random random(1);
  const Pose X = random.pose(1.0);
  const VolumeMetrics m = box_at(Vec3(0.1, 0.2, 0.3), Vec3(0.5, -0.2, 0.3));
  EXPECT_TRUE(same(transformed(transformed(m, X), X.inverse()), m, kRounding));
}

TEST(VolumeMetrics, TransformedMovesTheMomentLikeAForce) {
  Random random(2);
  const Pose X = random.pose(1.0);
  const VolumeMetrics m = box_at(Vec3(0.1, 0.2, 0.3), Vec3(0.5, -0.2, 0.3));
  // T = c x S by construction; it must stay so about the new origin.
  const VolumeMetrics moved = transformed(m, X);
  VolumeMetrics in_place = m;
  transform(X, in_place);
  EXPECT_EQ(in_place, moved);
  EXPECT_LT((moved.area_moment - moved.centroid.cross(moved.area_vector)).norm(), 1e-14);
}

TEST(VolumeMetrics, ReversedTwiceIsTheSame) {
  const VolumeMetrics m = box_at(Vec3(0.1, 0.2, 0.3), Vec3(0.5, -0.2, 0.3));
  EXPECT_TRUE(same(reversed(reversed(m)), m, Tolerance{0.0, 1.0}));
  EXPECT_EQ(reversed(m).normal(), -m.normal());
  EXPECT_EQ(reversed(m).area, m.counter_area);
  VolumeMetrics in_place = m;
  reverse(in_place);
  EXPECT_EQ(in_place, reversed(m));
}

TEST(VolumeMetrics, NormalIsAgainstTheAreaVectorAndZeroWithoutOne) {
  VolumeMetrics m;
  EXPECT_EQ(m.normal(), Vec3(Vec3::Zero()));
  m.area_vector = Vec3(0, 0, 2);
  EXPECT_EQ(m.normal(), Vec3(0, 0, -1));
}

// A body inside another, whose surface sums to rounding: no direction to be pushed in.
TEST(VolumeMetrics, RoundingIsNoDirection) {
  VolumeMetrics metrics;
  metrics.volume = 1e-3;
  metrics.area_vector = {3e-18, -4e-18, 0.0};
  EXPECT_TRUE(metrics.normal().isZero(0.0));
  metrics.area_vector = {0.0, 0.0, -3e-13};  // a ball that comes out by a picometre
  EXPECT_EQ(metrics.normal(), Vec3::UnitZ());
}

TEST(VolumeMetrics, FlatnessComparesWithTheSmallerSurface) {
  VolumeMetrics m;
  EXPECT_EQ(m.flatness(), 0.0);
  m.area_vector = Vec3(0, 0, 0.5);
  m.area = 0.5;
  m.counter_area = 3.0;
  EXPECT_EQ(m.flatness(), 1.0);
  m.area = 2.0;
  EXPECT_EQ(m.flatness(), 0.25);
}

TEST(VolumeMetrics, SecondMomentUndoesTheInertia) {
  const VolumeMetrics m = box_at(Vec3(0.1, 0.2, 0.3), Vec3::Zero());
  // int x^2 dV of a box = V h^2 / 3.
  const Vec3 expected = m.volume / 3.0 * Vec3(0.01, 0.04, 0.09);
  EXPECT_LT((m.second_moment() - Mat3(expected.asDiagonal())).norm(), 1e-17);
}

TEST(MomentSum, GivesTheMetricsOfTheSums) {
  // A box from its sums about a far origin.
  const Vec3 h(0.1, 0.2, 0.3), c(1, -2, 0.5);
  const VolumeMetrics expected = Box({.half_sizes = h}).own_metrics();
  MomentSum sum;
  sum.volume = expected.volume;
  sum.first = sum.volume * c;
  sum.second = expected.second_moment() + sum.volume * outer(c, c);
  const VolumeMetrics m = sum.metrics();
  EXPECT_LT((m.centroid - c).norm(), 1e-15);
  EXPECT_LT((m.inertia - expected.inertia).norm(), 1e-15);
}

TEST(MomentSum, AddsAndHasNoMetricsWithoutVolume) {
  MomentSum a, b;
  a.volume = b.volume = 1.0;
  a.first = Vec3(1, 0, 0);
  b.first = Vec3(0, 1, 0);
  a += b;
  EXPECT_EQ(a.metrics().centroid, Vec3(0.5, 0.5, 0.0));
  MomentSum nothing;
  nothing.area = 1.0;
  EXPECT_FALSE(nothing.metrics().touching());
  EXPECT_EQ(nothing.metrics().area, 0.0);
}

TEST(VolumeMetrics, IsFiniteLooksAtEveryField) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const VolumeMetrics good = box_at(Vec3::Ones(), Vec3::Zero());
  EXPECT_TRUE(is_finite(good));
  for (int field = 0; field < 10; ++field) {
    VolumeMetrics m = good;
    double* const fields[] = {
        &m.volume, &m.centroid.y(), &m.inertia(1, 2), &m.area_vector.z(), &m.area_moment.x(),
        &m.area,   &m.counter_area, &m.depth_moment,  &m.depth,           &m.volume_error};
    *fields[field] = nan;
    EXPECT_FALSE(is_finite(m)) << "field " << field;
  }
}

TEST(Status, HasAWordForEachAndIsOrderedByBadness) {
  EXPECT_STREQ(to_string(Status::kOk), "ok");
  EXPECT_STREQ(to_string(Status::kContained), "contained");
  EXPECT_STREQ(to_string(Status::kApproximate), "approximate");
  EXPECT_STREQ(to_string(Status::kUnbounded), "unbounded");
  EXPECT_STREQ(to_string(Status::kInvalid), "invalid");
  EXPECT_LT(Status::kOk, Status::kContained);
  EXPECT_LT(Status::kUnbounded, Status::kInvalid);
}

}  // namespace
}  // namespace volcontact::volume_metrics_test
