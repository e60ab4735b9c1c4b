// SPDX-License-Identifier: Apache-2.0
#include "volcontact/model/site_memory.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>

namespace volcontact::site_memory_test {
namespace {

constexpr double kRounding = 1e-14;
// A vector, an amount, a value: one of each kind.
constexpr std::array kStates{StateField{"z", "m", Keeping::kVector, ""},
                             StateField{"twist", "m", Keeping::kAmount, ""},
                             StateField{"dwell", "-", Keeping::kValue, ""}};
constexpr int kRow = kSiteHead + 5;

Mat3 turn(const Vec3& axis, double angle) { return rotation_about(axis.normalized(), angle); }

// A site of a given place, normal and volume; its size is that of a ball of 2 cm.
VolumeMetrics site(const Vec3& centroid, double volume = 1e-6, const Vec3& normal = Vec3::UnitZ()) {
  VolumeMetrics m;
  m.volume = volume;
  m.centroid = centroid;
  m.area_vector = -1e-3 * normal;
  m.inertia = 0.4 * 0.02 * 0.02 * volume * Mat3::Identity();
  return m;
}

std::vector<double> row(const VolumeMetrics& metrics, const BodyMotion& motion,
                        const std::array<double, 5>& states, int pair = 0) {
  std::vector<double> numbers(kRow);
  const SiteHead head = site_head(pair, metrics, motion);
  std::memcpy(numbers.data(), &head, sizeof head);
  std::copy(states.begin(), states.end(), numbers.begin() + kSiteHead);
  return numbers;
}

std::vector<double> operator+(std::vector<double> a, const std::vector<double>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

SiteMemory memory_of(const std::vector<double>& rows, double elapsed = 1e-3) {
  return {rows.data(), static_cast<int>(rows.size()) / kRow, kRow, elapsed};
}

Vec3 vector_at(const SiteCarrier& carrier, std::size_t i) { return Vec3::from(carrier.states(i)); }

TEST(SiteCarrier, BodiesAtRestChangeNoBit) {
  BodyMotion motion;
  motion.X_WA = {turn({1, 2, 3}, 0.7), {0.3, 0.2, 0.1}};
  motion.X_WB = {turn({3, -2, 1}, 1.7), {-0.3, 0.5, 0.9}};
  const Vec3 n = Vec3(1, 2, -2) / 3.0, z = n.cross(Vec3(0.3, 0.1, 0.2)) * 1e-5;
  const std::vector<VolumeMetrics> sites{site({0.1, 0.2, 0.3}, 1e-6, n)};
  std::array<double, 5> states{z.x(), z.y(), z.z(), 3e-5, 0.25};
  SiteCarrier carrier;
  // The first time may round off what z has across the plane; from then on nothing changes.
  for (int i = 0; i < 5; ++i) {
    carrier.carry(memory_of(row(sites[0], motion, states)), 0, sites, motion, kStates);
    EXPECT_EQ(carrier.site(0).travel.norm(), 0.0);
    EXPECT_EQ(carrier.site(0).rotation.norm(), 0.0);
    EXPECT_EQ(carrier.states(0)[3], states[3]);
    EXPECT_EQ(carrier.states(0)[4], states[4]);
    if (i > 1) {
      EXPECT_EQ(vector_at(carrier, 0), Vec3(Vec3::from(states.data())));
    }
    std::copy_n(carrier.states(0), 5, states.begin());
  }
  EXPECT_NEAR((Vec3(Vec3::from(states.data())) - z).norm(), 0.0, 1e-15 * z.norm());
}

TEST(SiteCarrier, TravelIsTheWayOfAAgainstB) {
  BodyMotion before, now;
  now.X_WA.translation = {2e-3, 0.0, 0.0};
  now.X_WB.translation = {0.0, 1e-3, 0.0};
  SiteCarrier carrier;
  const std::vector<VolumeMetrics> sites{site({0.101, 0.2, 0.3})};
  carrier.carry(memory_of(row(site({0.1, 0.2, 0.3}), before, {})), 0, sites, now, kStates);
  EXPECT_NEAR((carrier.site(0).travel - Vec3(2e-3, -1e-3, 0.0)).norm(), 0.0, kRounding);
}

// Rigid motion of both bodies together: no way, and the deflection turns along.
TEST(SiteCarrier, MovesWithBodiesThatMoveTogether) {
  BodyMotion before, now;
  before.X_WA = {turn({1, 2, 3}, 0.7), {0.3, 0.2, 0.1}};
  before.X_WB = {turn({3, -2, 1}, 1.7), {-0.3, 0.5, 0.9}};
  const double elapsed = 1e-3, speed = 20.0;
  const Vec3 axis = Vec3(2, -1, 2) / 3.0;
  const Pose moved{turn(axis, speed * elapsed), {0.1, 7.0, -3.0}};
  now.X_WA = moved * before.X_WA;
  now.X_WB = moved * before.X_WB;
  now.V_WA.angular = now.V_WB.angular = speed * axis;
  const Vec3 n = Vec3(1, 2, -2) / 3.0, z = n.cross(Vec3(0.3, 0.1, 0.2)) * 1e-5;
  const Vec3 c(0.1, 0.2, 0.3);
  const std::vector<VolumeMetrics> sites{site(moved * c, 1e-6, moved.rotation * n)};
  SiteCarrier carrier;
  carrier.carry(memory_of(row(site(c, 1e-6, n), before, {z.x(), z.y(), z.z(), 0, 0}), elapsed), 0,
                sites, now, kStates);
  EXPECT_NEAR(carrier.site(0).travel.norm(), 0.0, 1e-12);
  // Least turn plus spin is the common turn up to the third order of its angle.
  EXPECT_NEAR((vector_at(carrier, 0) - moved.rotation * z).norm(), 0.0, 1e-5 * z.norm());
}

TEST(SiteCarrier, SpinIsTheTurnAboutTheNormal) {
  BodyMotion before, now;
  const double angle = 1e-3;
  now.X_WA.rotation = turn(Vec3::UnitZ(), angle);
  SiteCarrier carrier;
  const std::vector<VolumeMetrics> sites{site({0.0, 0.0, 0.0})};
  carrier.carry(memory_of(row(sites[0], before, {})), 0, sites, now, kStates);
  EXPECT_NEAR((carrier.site(0).rotation - Vec3(0.0, 0.0, angle)).norm(), 0.0, angle * angle);
}

// A ball rolls without slipping: the deflection keeps its direction in the plane, to the last bit.
TEST(SiteCarrier, RollingLeavesTheDeflectionAlone) {
  const double R = 0.05, angle = 0.02;
  BodyMotion before, now;
  before.X_WA.translation = {0.0, 0.0, R};
  now.X_WA = {turn(Vec3::UnitY(), angle), {R * angle, 0.0, R}};
  now.V_WA = {{0.0, angle / 1e-3, 0.0}, {R * angle / 1e-3, 0.0, 0.0}};
  const std::array<double, 5> states{1e-5, 2e-5, 0.0, 0.0, 0.0};
  SiteCarrier carrier;
  const std::vector<VolumeMetrics> sites{site({R * angle, 0.0, 0.0})};
  carrier.carry(memory_of(row(site({0, 0, 0}), before, states)), 0, sites, now, kStates);
  EXPECT_EQ(vector_at(carrier, 0), Vec3(1e-5, 2e-5, 0.0));
  EXPECT_NEAR(carrier.site(0).travel.head<2>().norm(), 0.0, R * angle * angle * angle);
}

TEST(SiteCarrier, SplitSharesAmountsAndCopiesValues) {
  const BodyMotion still;
  const std::vector<VolumeMetrics> sites{site({-0.01, 0, 0}, 1e-6), site({0.02, 0, 0}, 3e-6)};
  SiteCarrier carrier;
  carrier.carry(memory_of(row(site({0, 0, 0}, 4e-6), still, {4e-5, 0.0, 0.0, 8e-5, 0.5})), 0, sites,
                still, kStates);
  EXPECT_NEAR(vector_at(carrier, 0).x(), 1e-5, 1e-19);
  EXPECT_NEAR(vector_at(carrier, 1).x(), 3e-5, 1e-19);
  EXPECT_NEAR(carrier.states(0)[3], 2e-5, 1e-19);
  EXPECT_NEAR(carrier.states(1)[3], 6e-5, 1e-19);
  EXPECT_EQ(carrier.states(0)[4], 0.5);
  EXPECT_EQ(carrier.states(1)[4], 0.5);
}

TEST(SiteCarrier, MergeSumsAmountsAndAveragesValues) {
  const BodyMotion still;
  const std::vector<double> rows =
      row(site({-0.01, 0, 0}, 1e-6), still, {1e-5, 0.0, 0.0, 1e-5, 0.2}) +
      row(site({0.02, 0, 0}, 3e-6), still, {0.0, 2e-5, 0.0, 5e-5, 1.0});
  const std::vector<VolumeMetrics> sites{site({0, 0, 0}, 4e-6)};
  SiteCarrier carrier;
  carrier.carry(memory_of(rows), 0, sites, still, kStates);
  EXPECT_NEAR((vector_at(carrier, 0) - Vec3(1e-5, 2e-5, 0.0)).norm(), 0.0, 1e-19);
  EXPECT_NEAR(carrier.states(0)[3], 6e-5, 1e-19);
  EXPECT_NEAR(carrier.states(0)[4], 0.8, kRounding);
}

TEST(SiteCarrier, EverySiteGoesOnInItsOwn) {
  const BodyMotion still;
  const std::vector<double> rows =
      row(site({0.0, 0, 0}), still, {1e-5, 0, 0, 0, 0.1}) +
      row(site({0.3, 0, 0}), still, {2e-5, 0, 0, 0, 0.2}) +
      row(site({0.6, 0, 0}), still, {3e-5, 0, 0, 0, 0.3}, 1);  // of another pair
  const std::vector<VolumeMetrics> sites{site({0.301, 0, 0}), site({0.9, 0, 0}), site({0, 0, 0})};
  SiteCarrier carrier;
  carrier.carry(memory_of(rows), 0, sites, still, kStates);
  EXPECT_EQ(carrier.states(0)[4], 0.2);
  EXPECT_EQ(carrier.states(1)[4], 0.0);  // new: nothing was near
  EXPECT_EQ(vector_at(carrier, 1).norm(), 0.0);
  EXPECT_EQ(carrier.states(2)[4], 0.1);
}

TEST(SiteCarrier, FindsASiteThatSlidFarInOneStep) {
  BodyMotion before, now;
  now.X_WA.translation = {0.5, 0.0, 0.0};  // ten times the size of the site
  now.V_WA.linear = {500.0, 0.0, 0.0};
  const std::vector<VolumeMetrics> sites{site({0.5, 0, 0})};
  SiteCarrier carrier;
  carrier.carry(memory_of(row(site({0, 0, 0}), before, {0, 0, 0, 0, 0.7})), 0, sites, now, kStates);
  EXPECT_EQ(carrier.states(0)[4], 0.7);
}

TEST(SiteCarrier, PlaneThatTurnsTakesTheDeflectionAlong) {
  const BodyMotion still;
  const Vec3 n = turn(Vec3::UnitY(), 0.3) * Vec3::UnitZ();
  const std::vector<VolumeMetrics> sites{site({0, 0, 0}, 1e-6, n)};
  SiteCarrier carrier;
  carrier.carry(memory_of(row(site({0, 0, 0}), still, {1e-5, 2e-5, 0, 0, 0})), 0, sites, still,
                kStates);
  const Vec3 expected = turn(Vec3::UnitY(), 0.3) * Vec3(1e-5, 2e-5, 0.0);
  EXPECT_NEAR((vector_at(carrier, 0) - expected).norm(), 0.0, 1e-19);
}

}  // namespace
}  // namespace volcontact::site_memory_test
