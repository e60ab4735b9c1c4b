// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/torus/torus_exits.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/support/evaluated.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"

namespace volcontact::torus_exits_test {
namespace {

constexpr double kMajor = 0.1;

// What of a ring stands out of a cylinder of this radius about x: rho > sqrt(c^2 - z^2) / |sin
// phi|, by midpoints, in the quarter in which phi is counted from y.
double volume_outside(double major, double minor, double wall) {
  const double widest = std::acos(std::max(0.0, (wall - minor) / (major + minor)));
  constexpr int kAngles = 2000, kHeights = 200;
  double sum = 0.0;
  for (int i = 0; i < kAngles; ++i) {
    const double cosine = std::cos(widest * (i + 0.5) / kAngles);
    for (int k = 0; k < kHeights; ++k) {
      const double z = minor * (2.0 * (k + 0.5) / kHeights - 1.0);
      const double half = std::sqrt(minor * minor - z * z), from = std::sqrt(wall * wall - z * z);
      const double out = major + half, in = std::max(from / cosine, major - half);
      if (out > in) sum += 0.5 * (out - in) * (out + in);
    }
  }
  return 4.0 * sum * widest / kAngles * 2.0 * minor / kHeights;
}

Pose across(double turn) {
  const Mat3 about_z = rotation_about(Vec3::UnitZ(), turn);
  const Mat3 to_x = rotation_about(Vec3::UnitY(), 0.5 * kPi);
  return {about_z * to_x, Vec3::Zero()};
}

// It stands out of both sides, in a small part of its turn: half-planes all round it miss that, and
// all of the ring seemed inside.
TEST(TorusExits, AThinRingInATubeStandsOutOfItsWall) {
  test::Random random(1);
  for (const Engine engine : {Engine::kAuto, Engine::kSurfaceSweep}) {
    for (int i = 0; i < test::cases(100, 10); ++i) {
      const double minor = random.log_uniform(1e-4, 1e-2) * 0.5;
      const double height = minor * random.log_uniform(0.1, 1.8);
      const double wall = kMajor + minor - height;
      const Torus ring({.major_radius = kMajor, .minor_radius = minor});
      const Cylinder tube({.radius = wall, .half_length = 1.0});
      const Pose X = across(random.uniform(0.0, 6.0));
      const Interference out = test::evaluated(ring, tube, X, engine);
      const double whole = ring.own_metrics().volume;
      const double expected = whole - volume_outside(kMajor, minor, wall);
      EXPECT_NEAR(out.total.volume, expected, 1e-4 * whole + out.total.volume_error)
          << "r " << minor << ", stands out by " << height / minor << " r";
    }
  }
}

TEST(TorusExits, WhereAllOfItIsOutsideTheRestIsTwoSites) {
  for (const double minor : {1e-4, 3e-4, 1e-3}) {
    for (const double beyond : {2.1, 2.5, 3.0}) {
      for (const double turn : {0.0, 0.3, 1.0, 2.0}) {
        const double wall = kMajor + minor * (1.0 - beyond);
        const Torus ring({.major_radius = kMajor, .minor_radius = minor});
        const Shape bodies[] = {Cylinder({.radius = wall, .half_length = 1.0}),
                                Box({.half_sizes = {0.3, wall, 0.3}})};
        for (const Shape& body : bodies) {
          const Interference out = test::evaluated(ring, body, across(turn));
          EXPECT_EQ(out.sites.size(), 2u) << "r " << minor << ", beyond by " << beyond << " r";
        }
      }
    }
  }
}

std::vector<TorusExit> exits_of(const FaceSet& faces, double minor) {
  std::vector<TorusExit> exits;
  find_torus_exits(faces, kMajor, minor, exits);
  return exits;
}

TEST(TorusExits, OfAPlaneAreWhereTheDiscLiesBeyondItsLine) {
  const double minor = 1e-3, gap = 1e-4;
  FaceSet faces;
  faces.planes.push_back({Vec3::UnitY(), kMajor - minor - gap, Owner::kB});
  const std::vector<TorusExit> exits = exits_of(faces, minor);
  ASSERT_EQ(exits.size(), 1u);
  EXPECT_TRUE(exits[0].all);
  EXPECT_NEAR(exits[0].middle(), 0.5 * kPi, 1e-15);
  EXPECT_NEAR(kMajor * std::cos(0.5 * exits[0].width()), kMajor - gap, 1e-15);
}

TEST(TorusExits, OfAWallEndWhereItTouchesTheRing) {
  // A sphere beside the middle of the ring: at the ends, the outermost place of the disc is on it.
  const double minor = 1e-3, radius = 0.15, shift = 0.05 - 0.5 * minor;
  FaceSet faces;
  const Pose X{Mat3::Identity(), {-shift, 0.0, 0.0}};
  FaceWriter writer(faces, X, Owner::kB);
  writer.write(Sphere({.radius = radius}));
  const std::vector<TorusExit> exits = exits_of(faces, minor);
  ASSERT_EQ(exits.size(), 1u);
  EXPECT_FALSE(exits[0].all);
  for (const double end : {exits[0].low, exits[0].high}) {
    const double reach = kMajor + shift * std::cos(end) + minor;
    const double aside = shift * std::sin(end);
    EXPECT_NEAR(std::hypot(reach, aside), radius, 1e-11);
  }
}

}  // namespace
}  // namespace volcontact::torus_exits_test
