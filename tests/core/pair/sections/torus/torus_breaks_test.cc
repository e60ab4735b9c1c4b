// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/torus/torus_breaks.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "core/support/random.h"

namespace volcontact::torus_breaks_test {
namespace {

constexpr double kMajor = 0.3, kMinor = 0.1;

std::vector<double> breaks(const FaceSet& faces) {
  std::vector<double> angles;
  find_torus_breaks(faces, kMajor, kMinor, angles);
  std::sort(angles.begin(), angles.end());
  return angles;
}

// The plane y = d is a line rho = d / sin in a half-plane, which touches the disc where that is
// R - r or R + r.
TEST(TorusBreaks, APlaneAlongTheAxisTouchesWhereItMeetsTheEquators) {
  const double d = 0.15;
  FaceSet faces;
  faces.planes.push_back({Vec3::UnitY(), d, Owner::kB});
  const double inner = std::asin(d / (kMajor - kMinor)), outer = std::asin(d / (kMajor + kMinor));
  const std::vector<double> expected{outer, inner, kPi - inner, kPi - outer};
  const std::vector<double> found = breaks(faces);
  ASSERT_EQ(found.size(), 4u);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(found[i], expected[i], 1e-12);
}

TEST(TorusBreaks, ThePlaneUnderTheRingHasNone) {
  FaceSet faces;
  faces.planes.push_back({Vec3::UnitZ(), -0.05, Owner::kB});
  EXPECT_TRUE(breaks(faces).empty());
}

// A corner in the tube, and the three edges from it, of which two run along the x and y axes.
TEST(TorusBreaks, CornersAndPiercedEdgesAreFound) {
  const Pose X{Mat3::Identity(), {0.3 + 1.0, 1.0, 1.0}};  // a corner at (0.3, 0, 0)
  FaceSet faces;
  FaceWriter(faces, X, Owner::kB).write(Box({.half_sizes = {1.0, 1.0, 1.0}}));
  const std::vector<double> found = breaks(faces);
  const auto has = [&](double angle) {
    return std::any_of(found.begin(), found.end(),
                       [&](double a) { return std::abs(a - angle) < 1e-9; });
  };
  EXPECT_TRUE(has(0.0));  // the corner, and the edges along x and z
  // The edge (0.3, y, 0) leaves the outer equator.
  EXPECT_TRUE(has(std::acos(0.3 / (kMajor + kMinor))));
}

TEST(TorusBreaks, TheRimOfATubeIsFollowed) {
  // A tube along x with its end at x = 0.3: its rim, of radius 0.05, lies in the ring all round.
  const Pose X{Eigen::AngleAxisd(0.5 * kPi, Vec3::UnitY()).toRotationMatrix(), {0.8, 0.0, 0.0}};
  FaceSet faces;
  FaceWriter(faces, X, Owner::kB).write(Cylinder({.radius = 0.05, .half_length = 0.5}));
  const std::vector<double> found = breaks(faces);
  const double touch = std::atan2(0.05, 0.3);
  EXPECT_TRUE(std::any_of(found.begin(), found.end(),
                          [&](double a) { return std::abs(a - touch) < 1e-6; }));
  EXPECT_TRUE(std::any_of(found.begin(), found.end(),
                          [&](double a) { return std::abs(a + touch) < 1e-6; }));
}

}  // namespace
}  // namespace volcontact::torus_breaks_test
