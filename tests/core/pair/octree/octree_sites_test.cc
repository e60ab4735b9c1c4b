// SPDX-License-Identifier: Apache-2.0

// Contact sites: regions of the overlap that do not hang together.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/support/random.h"
#include "volcontact/force/hunt_crossley.h"
#include "volcontact/model/contact_model.h"
#include "volcontact/pair/interference.h"

namespace volcontact::octree_sites_test {
namespace {

Csg block(const Vec3& half, const Vec3& center) {
  return Csg(Box({.half_sizes = half}), {Mat3::Identity(), center});
}
Csg unite(const Csg& a, const Csg& b) { return Csg(Csg::Operation::kUnion, a, b); }

Interference octree(const Shape& a, const Shape& b, const Pose& X_AB, double tolerance,
                    int threads = 1) {
  static InterferenceWorkspace workspace;
  Interference out;
  interference(a, b, X_AB, {.tolerance = tolerance, .engine = Engine::kOctree, .threads = threads},
               workspace, out);
  return out;
}

// Sites in an order that does not depend on the octree.
std::vector<VolumeMetrics> by_place(std::vector<VolumeMetrics> sites) {
  std::sort(sites.begin(), sites.end(), [](const VolumeMetrics& a, const VolumeMetrics& b) {
    const Vec3 along(1.0, 0.3, 0.1);
    return along.dot(a.centroid) < along.dot(b.centroid);
  });
  return sites;
}

void expect_sum(const Interference& out) {
  VolumeMetrics sum;
  for (const VolumeMetrics& site : out.sites) sum = sum + site;
  const VolumeMetrics& total = out.total;
  EXPECT_NEAR(sum.volume, total.volume, 1e-14 * total.volume);
  EXPECT_NEAR((sum.area_vector - total.area_vector).norm(), 0.0, 1e-14 * total.area);
  EXPECT_NEAR((sum.centroid - total.centroid).norm(), 0.0, 1e-13);
  EXPECT_NEAR((sum.inertia - total.inertia).norm(), 0.0, 1e-13 * total.inertia.norm());
}

// ---- a box on four feet

constexpr double kFootHalf = 0.01, kFootHeight = 0.02, kStand = 0.1;

Csg box_on_feet() {
  Csg solid = block(Vec3(0.15, 0.12, 0.05), Vec3(0.0, 0.0, 0.05 + 0.5 * kFootHeight));
  for (const double x : {-kStand, kStand}) {
    for (const double y : {-kStand, kStand}) {
      solid = unite(solid, block(Vec3(kFootHalf, kFootHalf, 0.5 * kFootHeight), Vec3(x, y, 0.0)));
    }
  }
  return solid;
}

// Each foot overlaps in a block of its own: closed forms all through.
TEST(OctreeSites, BoxOnFourFeetHasFour) {
  constexpr double kDepth = 1e-3;
  const Pose X_AB{Mat3::Identity(), Vec3(0.0, 0.0, -0.5 * kFootHeight + kDepth)};
  const Interference out = octree(box_on_feet(), HalfSpace(), X_AB, 1e-3);
  ASSERT_EQ(out.sites.size(), 4u);
  expect_sum(out);
  const double area = 4.0 * kFootHalf * kFootHalf;
  for (const VolumeMetrics& site : out.sites) {
    EXPECT_NEAR(site.volume, area * kDepth, 1e-9 * area * kDepth);
    EXPECT_NEAR(std::abs(site.centroid.x()), kStand, 1e-12);
    EXPECT_NEAR(std::abs(site.centroid.y()), kStand, 1e-12);
    EXPECT_NEAR(site.centroid.z(), -0.5 * kFootHeight + 0.5 * kDepth, 1e-12);
    EXPECT_NEAR((site.area_vector + area * Vec3::UnitZ()).norm(), 0.0, 1e-9 * area);
    EXPECT_NEAR(site.depth, kDepth, 1e-9 * kDepth);
    EXPECT_NEAR(site.depth_moment, 0.5 * kDepth * kDepth * area, 1e-6 * kDepth * kDepth * area);
  }
}

// Tilted about a diagonal, so that two feet hang in the air.
TEST(OctreeSites, FeetInTheAirHaveNone) {
  const Mat3 tilt = test::turn(Vec3(1.0, 1.0, 0.0), -0.005);
  const Pose X_AB{tilt, Vec3(0.0, 0.0, -0.5 * kFootHeight)};
  const Interference out = octree(box_on_feet(), HalfSpace(), X_AB, 1e-3);
  EXPECT_EQ(out.sites.size(), 3u);  // one foot down, and the two on the axis half
  expect_sum(out);
}

// ---- a peg in a bore

constexpr double kBore = 0.010, kBlock = 0.010;

Csg bored_block() {
  return Csg(Csg::Operation::kDifference, Csg(Box({.half_sizes = Vec3(0.02, 0.02, kBlock)})),
             Csg(Cylinder({.radius = kBore, .half_length = 2.0 * kBlock})));
}

// What of the peg lies outside the bore at z > 0: sections of the peg are ellipses, and their polar
// area outside the bore's circle is integrated by the midpoint rule.
double upper_site(double radius, double tilt) {
  constexpr int kHeights = 400, kAngles = 2000;
  const double a = radius / std::cos(tilt), b = radius;
  double volume = 0.0;
  for (int i = 0; i < kHeights; ++i) {
    const double z = (i + 0.5) / kHeights * kBlock, shift = z * std::tan(tilt);
    for (int k = 0; k < kAngles; ++k) {
      const double c = std::cos(2.0 * kPi * (k + 0.5) / kAngles),
                   s = std::sin(2.0 * kPi * (k + 0.5) / kAngles);
      // ((rho c - shift) / a)^2 + (rho s / b)^2 = 1
      const double q = c * c / (a * a) + s * s / (b * b), half = c * shift / (a * a);
      const double rho = (half + std::sqrt(half * half + q * (1.0 - shift * shift / (a * a)))) / q;
      if (rho > kBore) volume += 0.5 * (rho * rho - kBore * kBore);
    }
  }
  return volume * kBlock / kHeights * 2.0 * kPi / kAngles;
}

struct Peg {
  double radius, tilt;
};
constexpr Peg kPegs[] = {{0.0097, 0.035}, {0.00998, 0.003}};  // clearance 3 % and 0.02 mm

TEST(OctreeSites, TiltedPegHasTwo) {
  for (const auto [radius, tilt] : kPegs) {
    const Shape peg = Cylinder({.radius = radius, .half_length = 0.03});
    const Pose X_AB{test::turn(Vec3::UnitY(), tilt), Vec3::Zero()};
    const Interference out = octree(bored_block(), peg, X_AB, 1e-2);
    ASSERT_EQ(out.sites.size(), 2u);
    expect_sum(out);
    EXPECT_LE(out.total.volume_error, 1e-2 * out.total.volume);
    const double truth = upper_site(radius, tilt);
    for (const VolumeMetrics& site : out.sites) {
      EXPECT_NEAR(site.volume, truth, site.volume_error + 1e-4 * truth);
      EXPECT_GT(site.centroid.x() * site.centroid.z(), 0.5 * kBore * 0.5 * kBlock);
      // The block is pushed the way the peg leans, nearly across.
      EXPECT_GT(site.normal().x() * site.centroid.x(), 0.9 * std::abs(site.centroid.x()));
    }
    // The two push against each other.
    EXPECT_LT(out.total.area_vector.norm(), 1e-2 * out.sites[0].area_vector.norm());
  }
}

TEST(OctreeSites, AreTheSameInBothOrdersOfThePair) {
  const Shape peg = Cylinder({.radius = 0.0097, .half_length = 0.03}), hole = bored_block();
  const Pose X_AB{test::turn(Vec3::UnitY(), 0.035), Vec3(1e-5, 2e-5, 0.0)};
  const auto forth = by_place(octree(hole, peg, X_AB, 1e-3).sites);
  auto back = octree(peg, hole, X_AB.inverse(), 1e-3).sites;
  for (VolumeMetrics& site : back) site = reversed(transformed(site, X_AB));
  back = by_place(back);
  ASSERT_EQ(forth.size(), 2u);
  ASSERT_EQ(back.size(), 2u);
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(forth[i].volume, back[i].volume, forth[i].volume_error + back[i].volume_error);
    EXPECT_NEAR((forth[i].centroid - back[i].centroid).norm(), 0.0, 1e-5);
    EXPECT_NEAR((forth[i].area_vector - back[i].area_vector).norm(), 0.0,
                1e-2 * forth[i].area_vector.norm());
  }
}

TEST(OctreeSites, GiveTheSameBitsForAnyNumberOfThreads) {
  const Shape peg = Cylinder({.radius = 0.0097, .half_length = 0.03}), hole = bored_block();
  const Pose X_AB{test::turn(Vec3(0.2, 1.0, 0.0), 0.035), Vec3(1e-5, 2e-5, 0.0)};
  const Interference one = octree(hole, peg, X_AB, 1e-2, 1);
  for (const int threads : {2, 3, 4, 8, 16}) {
    const Interference many = octree(hole, peg, X_AB, 1e-2, threads);
    ASSERT_EQ(one.sites.size(), many.sites.size());
    for (std::size_t i = 0; i < one.sites.size(); ++i) {
      const VolumeMetrics &a = one.sites[i], &b = many.sites[i];
      EXPECT_EQ(a.volume, b.volume);
      EXPECT_EQ(a.volume_error, b.volume_error);
      EXPECT_EQ(a.centroid, b.centroid);
      EXPECT_EQ(a.inertia, b.inertia);
      EXPECT_EQ(a.area_vector, b.area_vector);
      EXPECT_EQ(a.area_moment, b.area_moment);
      EXPECT_EQ(a.depth_moment, b.depth_moment);
      EXPECT_EQ(a.depth, b.depth);
    }
  }
}

// ---- regions that merge and part

constexpr double kRecess = 2e-3;
constexpr double kLeft = 0.03 * 0.04, kMiddle = 0.05 * 0.04, kRight = 0.01 * 0.04;  // areas

// A slab with a recess in its lower side: two feet of different width, 0.03 and 0.01 along x.
Csg bridge() {
  return unite(unite(block(Vec3(0.045, 0.02, 0.01), Vec3(0.045, 0.0, kRecess + 0.01)),
                     block(Vec3(0.015, 0.02, 0.5 * kRecess), Vec3(0.015, 0.0, 0.5 * kRecess))),
               block(Vec3(0.005, 0.02, 0.5 * kRecess), Vec3(0.085, 0.0, 0.5 * kRecess)));
}

// Pressed into the ground the two sites become one when the recess is full, and part again on the
// way back. Volume, force and torque are closed forms of the depth all along: no jump.
TEST(OctreeSites, WrenchIsContinuousThroughMergeAndSplit) {
  constexpr double kStiffness = 1e8;
  ContactModel model({{bridge(), HalfSpace(), {}, {}}},
                     {std::make_shared<HuntCrossley>(HuntCrossley::Params{.stiffness = kStiffness}),
                      nullptr, true},
                     {.tolerance = 1e-3, .engine = Engine::kOctree});
  ContactModel::Workspace workspace;
  ContactReport report;
  std::vector<double> depths;
  for (int k = 0; k < 40; ++k) depths.push_back(3e-5 + k * 1e-4);
  for (const double e : {1e-5, 1e-6, 1e-7, 1e-8}) {
    depths.push_back(kRecess - e);
    depths.push_back(kRecess + e);
  }
  for (const double depth : depths) {
    BodyMotion motion;
    motion.X_WA.translation.z() = -depth;
    model.evaluate(motion, {}, workspace, report);
    EXPECT_EQ(report.sites.size(), depth > kRecess ? 1u : 2u) << depth;
    const double above = std::max(0.0, depth - kRecess);
    const double left = kLeft * depth, right = kRight * depth, middle = kMiddle * above;
    const double force = kStiffness * (left + right + middle);
    EXPECT_NEAR(report.wrench_on_A().force.z(), force, 1e-6 * force) << depth;
    // About A's origin: the torque about y is - x times the force along z.
    const double torque = -kStiffness * (0.015 * left + 0.055 * middle + 0.085 * right);
    EXPECT_NEAR(report.wrench_on_A().torque.y(), torque, -1e-6 * torque) << depth;
  }
}

}  // namespace
}  // namespace volcontact::octree_sites_test
