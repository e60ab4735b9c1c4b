// SPDX-License-Identifier: Apache-2.0
// The judge of the random search, by formulas that are in books.
#include "core/reference/line_oracle.h"

#include <gtest/gtest.h>

#include "core/support/sanitized.h"

namespace volcontact::test::line_oracle_test {
namespace {

Pose at(double x, double y, double z) { return {Mat3::Identity(), Vec3(x, y, z)}; }

ImplicitSolid ball(double radius) { return ImplicitSolid::ellipsoid(Vec3::Constant(radius)); }
ImplicitSolid room() { return ImplicitSolid::box(Vec3(2.0, 2.1, 2.2)); }

// The volume lies within the doubt, and the doubt is small.
void expect_volume(const ImplicitSolid& a, const ImplicitSolid& b, double volume, const char* what,
                   int level = 2, double doubt = 1e-3) {
  LineOracle oracle(a, b, 5);
  const LineEstimate lines = oracle.estimate(level);
  EXPECT_NEAR(lines.volume, volume, lines.volume_error + 1e-13) << what;
  EXPECT_LE(lines.volume_error, doubt * volume) << what;
  EXPECT_LE(oracle.least_volume(), volume) << what;
  EXPECT_GE(oracle.most_volume(), volume) << what;
}

TEST(LineOracle, KnowsTheVolumesOfSolids) {
  const double r = 0.3, h = 0.5;
  expect_volume(room(), ball(r), 4.0 / 3.0 * kPi * r * r * r, "ball");
  expect_volume(room(), ImplicitSolid::ellipsoid(Vec3(0.5, 0.3, 0.1)), 4.0 / 3.0 * kPi * 0.015,
                "ellipsoid");
  expect_volume(room(), ImplicitSolid::capsule(r, h), kPi * r * r * (2.0 * h + 4.0 / 3.0 * r),
                "capsule");
  expect_volume(room(), ImplicitSolid::frustum(r, r, h), 2.0 * kPi * r * r * h, "cylinder");
  expect_volume(room(), ImplicitSolid::frustum(0.0, r, h), 2.0 / 3.0 * kPi * r * r * h, "cone");
  expect_volume(room(), ImplicitSolid::frustum(r, 0.1, 1e-3), 2e-3 / 3.0 * kPi * 0.13, "disc");
  expect_volume(room(), ImplicitSolid::torus(0.4, 0.15), 2.0 * kPi * kPi * 0.4 * 0.0225, "torus");
  expect_volume(room(), ImplicitSolid::box(Vec3(0.3, 0.2, 1e-3)), 8.0 * 6e-5, "plate", 2, 1e-2);
  const std::vector<Vec3> corner = {Vec3::Zero(), 0.5 * Vec3::UnitX(), 0.5 * Vec3::UnitY(),
                                    0.5 * Vec3::UnitZ()};
  expect_volume(room(), ImplicitSolid::polytope(corner), 0.125 / 6.0, "corner");
}

TEST(LineOracle, KnowsTheVolumesOfOverlaps) {
  // Two balls of equal radii: pi (4 r + d) (2 r - d)^2 / 12, shallow ones, too.
  const double r = 0.3;
  for (const double depth : {0.2, 1e-2, 1e-4, 1e-6}) {
    const double d = 2.0 * r - depth;
    expect_volume(ball(r), ball(r).posed(at(0.0, 0.0, d)),
                  kPi * (4.0 * r + d) * depth * depth / 12.0, "balls", 3);
  }
  // Two tubes that cross: 16 r^3 / 3.
  const ImplicitSolid tube = ImplicitSolid::frustum(r, r, 1.0);
  const Pose across{turn(Vec3::UnitX(), 0.5 * kPi), Vec3::Zero()};
  expect_volume(tube, tube.posed(across), 16.0 / 3.0 * r * r * r, "crossing tubes");
  // A cap of a ball below a plane.
  const double cap = 0.02;
  expect_volume(ImplicitSolid::half_space(), ball(r).posed(at(0.0, 0.0, r - cap)),
                kPi * cap * cap * (r - cap / 3.0), "cap");
}

// Few lines meet a needle at first: what they saw of it is not all there is.
TEST(LineOracle, KnowsNeedles) {
  Random random(4);
  for (int i = 0; i < test::cases(60, 24, 24); ++i) {
    const double r = random.log_uniform(2e-5, 1e-2), h = random.uniform(0.05, 0.3);
    const bool is_cone = i % 2 == 1;
    const ImplicitSolid needle =
        is_cone ? ImplicitSolid::frustum(r, 0.0, h) : ImplicitSolid::capsule(r, h);
    const double volume = kPi * r * r * (is_cone ? 2.0 / 3.0 * h : 2.0 * h + 4.0 / 3.0 * r);
    LineOracle oracle(ImplicitSolid::box(Vec3(0.4, 0.5, 0.6)), needle,
                      static_cast<std::uint64_t>(i));
    LineEstimate lines;
    for (int level = i % 3; level <= 3; ++level) lines = oracle.estimate(level);
    EXPECT_NEAR(lines.volume, volume, 2.0 * lines.volume_error + 0.05 * volume)
        << i << ": radius " << r << ", half length " << h;
    EXPECT_LE(lines.volume_error, 1.5 * volume) << i;
  }
}

TEST(LineOracle, KnowsComposedSolids) {
  const double R = 0.3, r = 0.2, h = 0.25;
  const ImplicitSolid pipe =
      ImplicitSolid::frustum(R, R, h) - ImplicitSolid::frustum(r, r, 2.0 * h);
  expect_volume(room(), pipe, 2.0 * kPi * h * (R * R - r * r), "pipe");
  const ImplicitSolid pair = ball(r).posed(at(-0.5, 0.0, 0.0)) | ball(r).posed(at(0.5, 0.0, 0.0));
  expect_volume(room(), pair, 8.0 / 3.0 * kPi * r * r * r, "two balls");
  expect_volume(room(), pipe & ImplicitSolid::half_space(), kPi * h * (R * R - r * r), "half");
}

TEST(LineOracle, ProvesThatSolidsAreApart) {
  for (const double gap : {0.1, 1e-3, 1e-6, 1e-9}) {
    const LineOracle oracle(ball(0.3), ball(0.2).posed(at(0.0, 0.5 + gap, 0.0)), 3);
    EXPECT_TRUE(oracle.is_apart()) << gap;
  }
  const LineOracle touching(ball(0.3), ball(0.2).posed(at(0.0, 0.5 - 1e-9, 0.0)), 3);
  EXPECT_FALSE(touching.is_apart());
}

TEST(LineOracle, KnowsCentroidAndAreaVector) {
  const double r = 0.3;
  LineOracle oracle(ImplicitSolid::half_space(), ball(r), 3);
  const LineEstimate lines = oracle.estimate(3);
  EXPECT_LE((lines.centroid - Vec3(0.0, 0.0, -3.0 / 8.0 * r)).norm(), lines.centroid_error + 1e-12);
  EXPECT_LE(lines.centroid_error, 1e-4);
  EXPECT_LE((lines.area_vector - kPi * r * r * Vec3::UnitZ()).norm(), 1e-3);
}

// What lines have in a torus agrees with the sign of its function at places along them.
TEST(ImplicitSolid, PartsOfLinesAreWhereTheFunctionIsNegative) {
  Random random(9);
  const std::vector<ImplicitSolid> solids = {
      ball(0.3),
      ImplicitSolid::ellipsoid(Vec3(0.3, 0.1, 0.02)),
      ImplicitSolid::capsule(0.1, 0.2),
      ImplicitSolid::frustum(0.3, 0.0, 0.2),
      ImplicitSolid::frustum(0.3, 0.1, 1e-3),
      ImplicitSolid::box(Vec3(0.3, 0.2, 0.1)),
      ImplicitSolid::torus(0.3, 0.1),
      ImplicitSolid::torus(0.2, 0.2),
      ImplicitSolid::half_space(),
  };
  LineParts parts;
  for (const ImplicitSolid& solid : solids) {
    const ImplicitSolid moved = solid.posed(random.pose(0.1));
    const ImplicitMember& member = moved.members()[0];
    int inside = 0;
    for (int line = 0; line < 2000; ++line) {
      const Vec3 o = random.in_box(0.3), d = random.direction();
      parts.count = 0;
      MemberLines(member, d).add_parts(o, 1.0, parts);
      for (int i = 0; i < 20; ++i) {
        const double t = random.uniform(-1.0, 1.0);
        bool within = false;
        for (const auto& part : parts) within = within || (t > part.enter && t < part.leave);
        const double value = moved.value(o + t * d);
        if (std::abs(value) > 1e-12) {
          EXPECT_EQ(within, value < 0.0) << line << " at " << t;
        }
        inside += within;
      }
    }
    EXPECT_GT(inside, 10);
  }
}

}  // namespace
}  // namespace volcontact::test::line_oracle_test
