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

// Without a hole a line along the axis touches the disc at the outer equator alone.
TEST(TorusBreaks, APlaneTouchesARingWithoutAHoleOnce) {
  const double d = 0.15;
  FaceSet faces;
  faces.planes.push_back({Vec3::UnitY(), d, Owner::kB});
  for (const double hole : {0.0, 1e-16, 1e-9}) {
    std::vector<double> found;
    find_torus_breaks(faces, kMajor + hole, kMajor, found);
    std::sort(found.begin(), found.end());
    ASSERT_EQ(found.size(), 2u) << hole;
    EXPECT_NEAR(found[0], std::asin(d / (2.0 * kMajor)), 1e-8);
    EXPECT_NEAR(found[1], kPi - found[0], 1e-8);
  }
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

// A rim about the middle of the ring, in a plane through its axis, a little smaller than the outer
// equator: it leaves the tube and comes back on a short arc. At the angle a from the equator it is
// inside where (rho cos a - R)^2 + (rho sin a)^2 < r^2.
TEST(TorusBreaks, ARimThatIsInTheTubeForAShortWhileIsSeen) {
  for (const double radius : {0.3999, 0.399, 0.39, 0.37}) {
    for (const double spin : {0.0, 0.1, 0.25, 0.4}) {
      const double x = (radius * radius + kMajor * kMajor - kMinor * kMinor) / (2.0 * kMajor);
      if (!(x < radius)) continue;
      // A hair beside the axis, so that places on the rim have different angles.
      const double beside = 0.01;
      FaceSet faces;
      const Vec3 u(std::cos(spin), 0.0, std::sin(spin)), v(-std::sin(spin), 0.0, std::cos(spin));
      faces.rims.push_back({{0.0, beside, 0.0}, radius * u, radius * v, Owner::kB});
      // There rho^2 = x^2 + beside^2 and x^2 + z^2 = radius^2.
      const double square = radius * radius + beside * beside;
      const double rho = (square + kMajor * kMajor - kMinor * kMinor) / (2.0 * kMajor);
      if (!(rho * rho < square)) continue;
      const double expected = std::asin(beside / rho);
      const std::vector<double> found = breaks(faces);
      const auto count = std::count_if(found.begin(), found.end(), [&](double a) {
        return std::min(std::abs(a - expected), std::abs(a - (kPi - expected))) < 2e-5;
      });
      EXPECT_GE(count, 4) << radius << " " << spin;
    }
  }
}

TEST(TorusBreaks, TheRimOfATubeIsFollowed) {
  // A tube along x with its end at x = 0.3: its rim, of radius 0.05, lies in the ring all round.
  const Pose X{rotation_about(Vec3::UnitY(), 0.5 * kPi), {0.8, 0.0, 0.0}};
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
