// SPDX-License-Identifier: Apache-2.0

// Holes with a cone for a wall: cups and chamfers.
#include <gtest/gtest.h>

#include "core/support/csg_solids.h"
#include "core/support/evaluated.h"
#include "core/support/gradient.h"
#include "core/support/sanitized.h"
#include "volcontact/pair/interference.h"
#include "volcontact/shape/csg/csg_metrics.h"

namespace volcontact::cone_bores_test {
namespace {

using test::evaluated;

constexpr double kHalf = 0.02;                   // half height of the block [m]
constexpr double kBottom = 0.004, kTop = 0.014;  // radii of the cup
constexpr double kDepth = 0.02;                  // of the cup
constexpr double kSlope = (kTop - kBottom) / kDepth;

Csg block() { return Csg(Box({.half_sizes = {0.03, 0.03, kHalf}})); }
Csg cone(double bottom_radius, double top_radius, double bottom, double top) {
  return Csg(Frustum({.bottom_radius = bottom_radius,
                      .top_radius = top_radius,
                      .half_length = 0.5 * (top - bottom)}),
             Pose{Mat3::Identity(), {0.0, 0.0, 0.5 * (top + bottom)}});
}
Csg without(const Csg& a, const Csg& b) { return Csg(Csg::Operation::kDifference, a, b); }

// Flush with the top of the block.
Csg cup() { return without(block(), cone(kBottom, kTop, kHalf - kDepth, kHalf)); }
double cup_radius(double z) { return kTop - kSlope * (kHalf - z); }

// A bore of 10 mm radius, widened to 13 mm over its last 3 mm.
Csg bore() { return Csg(Cylinder({.radius = 0.010, .half_length = 0.03})); }
Csg chamfered() { return without(without(block(), bore()), cone(0.010, 0.013, 0.017, kHalf)); }

// Volume between two solids of revolution about z: pi int (r_b^2 - r_a^2) where that is positive,
// by Simpson's rule, which is exact for what is quadratic in z.
template <typename Excess>
double ring(Excess&& excess, double low, double high) {
  return kPi * (high - low) / 6.0 * (excess(low) + 4.0 * excess(0.5 * (low + high)) + excess(high));
}

TEST(ConeBores, ABallInACupIsARing) {
  const double r = 0.012, cosine = 1.0 / std::sqrt(1.0 + kSlope * kSlope);
  // Where the ball touches the wall all round, with its middle over the apex.
  const double apex = kHalf - kTop / kSlope, touching = apex + r / (kSlope * cosine);
  for (double depth : {1e-6, 1e-4, 5e-4}) {
    const double z = touching - depth / (kSlope * cosine);
    const auto excess = [&](double h) {
      return r * r - (h - z) * (h - z) - cup_radius(h) * cup_radius(h);
    };
    // The roots of the quadratic.
    const double a = 1.0 + kSlope * kSlope, b = kSlope * cup_radius(0.0) - z;
    const double root = std::sqrt(b * b - a * (z * z + std::pow(cup_radius(0.0), 2) - r * r));
    const double low = (-b - root) / a, high = std::min(kHalf, (-b + root) / a);
    ASSERT_GT(low, kHalf - kDepth);
    const double expected = ring(excess, low, high);
    const Interference out = evaluated(cup(), Sphere({.radius = r}), {Mat3::Identity(), {0, 0, z}});
    EXPECT_EQ(out.engine, Engine::kLines);
    ASSERT_EQ(out.sites.size(), 1u);
    EXPECT_NEAR(out.total.volume, expected, 1e-7 * expected + 1e-20) << "depth " << depth;
    EXPECT_LE(std::abs(out.total.centroid.x()) + std::abs(out.total.centroid.y()), 1e-12);
    EXPECT_NEAR(out.total.depth, depth, 1e-3 * depth);  // across the wall
  }
}

// A pin that fits the cup: the two cones have one apex when it is seated, and no line through it
// pierces the pin's wall anywhere but there.
TEST(ConeBores, APinPressedIntoACupOfItsOwnTaper) {
  const double bottom = 0.005, length = 0.015;
  const Shape pin = Frustum({.bottom_radius = bottom,
                             .top_radius = bottom + kSlope * length,
                             .half_length = 0.5 * length});
  const double seated = kHalf - (kTop - bottom) / kSlope + 0.5 * length;  // height of its middle
  for (double depth : {1e-9, 1e-6, 1e-4}) {
    const double z = seated - depth;
    const auto excess = [&](double h) {
      const double pin_radius = bottom + kSlope * (h - (z - 0.5 * length));
      return pin_radius * pin_radius - cup_radius(h) * cup_radius(h);
    };
    const double expected = ring(excess, z - 0.5 * length, std::min(kHalf, z + 0.5 * length));
    const Interference out = evaluated(cup(), pin, {Mat3::Identity(), {0.0, 0.0, z}});
    EXPECT_EQ(out.engine, Engine::kLines);
    ASSERT_EQ(out.sites.size(), 1u);
    EXPECT_NEAR(out.total.volume, expected, 2e-5 * expected) << "depth " << depth;
    // The wall up to the ends of the pin pushes it up, by the ring that is seen along z.
    const double ring_area = kPi * (std::pow(cup_radius(z + 0.5 * length), 2) -
                                    std::pow(cup_radius(z - 0.5 * length), 2));
    EXPECT_NEAR(out.total.area_vector.z(), ring_area, 1e-3 * ring_area);
  }
  EXPECT_EQ(evaluated(cup(), pin, {Mat3::Identity(), {0.0, 0.0, seated + 1e-9}}).total.volume, 0.0);
}

struct Case {
  const char* name;
  Shape a, b;
  Pose X_AB;
  std::size_t sites;
};

std::vector<Case> cases() {
  const auto at = [](double angle, const Vec3& x) {
    return Pose{test::turn({1.0, 0.2, 0.0}, angle), x};
  };
  return {
      {"ball off the axis", cup(), Sphere({.radius = 0.010}), at(0.0, {0.001, 5e-4, 0.0165}), 1},
      {"egg", cup(), Ellipsoid({.semi_axes = {0.010, 0.008, 0.013}}), at(0.4, {2e-4, 0, 0.016}), 1},
      {"pill", cup(), Capsule({.radius = 0.009, .half_length = 0.02}), at(0.3, {0, 0, 0.0345}), 1},
      // The apex of the chamfer lies in the pill.
      {"pill through a chamfer", chamfered(), Capsule({.radius = 0.010, .half_length = 0.015}),
       at(0.5, {0.002, -5e-4, -0.005}), 1},
      {"box", cup(), Box({.half_sizes = {0.008, 0.006, 0.01}}), at(0.1, {0.0, 0.001, 0.0195}), 4},
      {"tilted pin", cup(),
       Frustum({.bottom_radius = 0.005, .top_radius = 0.0125, .half_length = 0.0075}),
       at(0.004, {1e-5, 0.0, 0.00945}), 1},
      {"peg on a chamfer", chamfered(), Cylinder({.radius = 0.0097, .half_length = 0.03}),
       at(0.02, {0.0015, 0.0, 0.048}), 1},
      {"peg tilted in a chamfered bore", chamfered(),
       Cylinder({.radius = 0.0097, .half_length = 0.03}), at(0.03, Vec3::Zero()), 2},
      {"ball on a chamfer", chamfered(), Sphere({.radius = 0.015}), at(0.0, {1e-4, 0.0, 0.0275}),
       1},
  };
}

TEST(ConeBores, AgreeWithTheCertifiedBounds) {
  for (const Case& c : cases()) {
    const VolumeMetrics octree = evaluated(c.a, c.b, c.X_AB, Engine::kOctree, 1e-2).total;
    const Interference out = evaluated(c.a, c.b, c.X_AB);
    EXPECT_EQ(out.engine, Engine::kLines) << c.name;
    EXPECT_EQ(out.sites.size(), c.sites) << c.name;
    EXPECT_NEAR(out.total.volume, octree.volume, octree.volume_error) << c.name;
    EXPECT_NEAR(out.total.volume, octree.volume, 2e-3 * octree.volume) << c.name;
    EXPECT_NEAR(out.total.area, octree.area, 0.02 * octree.area) << c.name;
    EXPECT_NEAR(out.total.counter_area, octree.counter_area, 0.02 * octree.counter_area) << c.name;
  }
}

// The apex of the cone lies in the tube of the capsule, and a ball behind it. Against the lengths
// of lines through both solids.
TEST(ConeBores, ACapsuleThatHoldsTheApexOfAChamfer) {
  const Pose above = testing::at(0, 0, .15);
  const Csg slab = without(testing::box(.3, .3, .05, above), testing::cone(.15, .25, .05, above));
  for (const double half_length : {.1, .3}) {
    if (test::kSanitized && half_length == .3) continue;
    const Capsule pill({.radius = .25, .half_length = half_length});
    for (const double z : {-.2, 0.0}) {
      for (const double x : {.05, .2}) {
        if (test::kSanitized && (z < 0.0) == (x < .1)) continue;
        const Pose X = testing::at(x, -.1, z);
        const VolumeMetrics exact = csg_metrics_by_lines(slab & Csg(pill, X));
        const Interference out = evaluated(slab, pill, X);
        EXPECT_NE(out.engine, Engine::kOctree);
        EXPECT_NEAR(out.total.volume, exact.volume, 1e-5 * exact.volume);
        EXPECT_LE((out.total.centroid - exact.centroid).norm(), 1e-5);
      }
    }
  }
}

TEST(ConeBores, AreaVectorAndMomentAreTheGradientOfVolume) {
  for (const Case& c : cases()) {
    const VolumeMetrics m = evaluated(c.a, c.b, c.X_AB, Engine::kAuto, 1e-6).total;
    const auto volume = [&](const Pose& X_AB) {
      return evaluated(c.a, c.b, X_AB, Engine::kAuto, 1e-6).total.volume;
    };
    const test::Gradient g = test::gradient_of_A(volume, c.X_AB, 1e-5);
    EXPECT_LE((g.shift - m.area_vector).norm(), 2e-3 * m.area) << c.name;
    EXPECT_LE((g.turn - m.area_moment).norm(), 2e-3 * m.area * kHalf) << c.name;
  }
}

TEST(ConeBores, TheOrderOfThePairDoesNotMatter) {
  for (const Case& c : cases()) {
    const VolumeMetrics m = evaluated(c.a, c.b, c.X_AB).total;
    const VolumeMetrics other = transformed(evaluated(c.b, c.a, c.X_AB.inverse()).total, c.X_AB);
    EXPECT_NEAR(other.volume, m.volume, 1e-5 * m.volume) << c.name;
    EXPECT_LE((other.area_vector + m.area_vector).norm(), 1e-3 * m.area) << c.name;
    EXPECT_LE((other.centroid - m.centroid).norm(), 1e-5 * kHalf) << c.name;
  }
}

// A cutter that reaches over the edges on both sides makes the same chamfer.
TEST(ConeBores, AChamferMayOverlapTheBore) {
  const Csg over = without(without(block(), bore()), cone(0.0095, 0.0135, 0.0165, 0.0205));
  for (const Case& c : cases()) {
    if (std::string(c.name).find("chamfer") == std::string::npos) continue;
    const Interference out = evaluated(over, c.b, c.X_AB);
    EXPECT_EQ(out.engine, Engine::kLines) << c.name;
    EXPECT_EQ(out.sites.size(), c.sites) << c.name;
    const VolumeMetrics m = evaluated(c.a, c.b, c.X_AB).total;
    EXPECT_NEAR(out.total.volume, m.volume, 1e-5 * m.volume) << c.name;
    EXPECT_LE((out.total.area_vector - m.area_vector).norm(), 1e-4 * m.area) << c.name;
  }
}

// A cone's apex in reach is beyond its bundle; the surface of the overlap serves.
TEST(ConeBores, ACupWithAPointIsServedByTheSurface) {
  const double r = 0.012, z = 0.0175, slope = kTop / kHalf;
  const Csg pointed = without(block(), cone(0.0, kTop, 0.0, kHalf));
  const auto excess = [&](double h) { return r * r - (h - z) * (h - z) - slope * slope * h * h; };
  const double a = 1.0 + slope * slope, root = std::sqrt(z * z - a * (z * z - r * r));
  ASSERT_LT((z + root) / a, kHalf);
  const double expected = ring(excess, (z - root) / a, (z + root) / a);
  const Interference out =
      evaluated(pointed, Sphere({.radius = r}), {Mat3::Identity(), {0.0, 0.0, z}});
  EXPECT_EQ(out.engine, Engine::kSurfaceSweep);
  EXPECT_NEAR(out.total.volume, expected, 1e-5 * expected);
}

}  // namespace
}  // namespace volcontact::cone_bores_test
