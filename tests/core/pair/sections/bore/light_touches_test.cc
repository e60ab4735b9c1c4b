// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/support/evaluated.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"
#include "volcontact/shape/csg/csg.h"

namespace volcontact::light_touches_test {
namespace {

// Solids far narrower than a bore, which touch its wall along a line or in a place by 1e-8 to 1e-4
// of its radius, as steel does under its load: what overlaps is narrow and was missed, or its ends
// were.
constexpr double kBore = 0.1, kHalf = 0.2;

Csg bored_block() {
  return Csg(Csg::Operation::kDifference, Csg(Box({.half_sizes = {0.3, 0.55, kHalf}})),
             Csg(Cylinder({.radius = kBore, .half_length = 2.0 * kHalf})));
}

// Across the axis: the area of a disc of this radius beyond the wall.
double area_beyond(double radius, double depth, double bore = kBore) {
  const double D = bore - radius + depth;                          // of the two middles
  const double chord = (depth * (radius + bore - D)) / (2.0 * D);  // of the wall, beyond its chord
  const double half = std::sqrt(chord * (2.0 * bore - chord));
  constexpr int kSteps = 400;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double y = half * ((i + 0.5) / kSteps), square = y * y;
    const double disc = square / (radius + std::sqrt(radius * radius - square));
    const double wall = square / (bore + std::sqrt(bore * bore - square));
    sum += depth - (disc - wall);
  }
  return 2.0 * half / kSteps * sum;
}

struct Touch {
  Shape solid;
  double reach;     // from its middle to where it touches the wall, along x
  double expected;  // at small depths
  double slack;
};

Touch touch_of(int kind, double depth, test::Random& random) {
  const double r = random.uniform(0.02, 0.06), h = random.uniform(0.02, 0.1);
  switch (kind) {
    case 0:
      return {Cylinder({.radius = r, .half_length = h}), r, 2.0 * h * area_beyond(r, depth), 1e-5};
    case 1: {  // and what of its ends touches: of a parabola as deep, two thirds, over their width
      const double ends = 2.0 * std::sqrt(2.0 * r * depth);
      const double area = area_beyond(r, depth);
      return {Capsule({.radius = r, .half_length = h}), r,
              (2.0 * h + 3.0 * kPi / 16.0 * ends) * area, 1e-4};
    }
    case 2: {
      const double across = 1.0 / (1.0 / r - 1.0 / kBore);
      return {Sphere({.radius = r}), r, kPi * depth * depth * std::sqrt(r * across), 1e-4};
    }
    case 3: {
      const double b = r * random.uniform(0.5, 1.2);
      const double across = 1.0 / (r / (b * b) - 1.0 / kBore), along = h * h / r;
      return {Ellipsoid({.semi_axes = {r, b, h}}), r,
              kPi * depth * depth * std::sqrt(along * across), 2e-3};
    }
    default: {  // an edge of a box, turned to the wall: two right triangles
      const double b = r * random.uniform(0.5, 1.0), sum = r / b + b / r;
      return {Box({.half_sizes = {r, b, h}}), std::hypot(r, b), h * depth * depth * sum, 1e-2};
    }
  }
}

TEST(LightTouches, OfTheWallOfAWideBoreAreAllThere) {
  test::Random random(7);
  const Shape block(bored_block());
  for (int i = 0; i < test::cases(1000, 100); ++i) {
    const int kind = i % 5;
    const double depth = kBore * random.log_uniform(1e-8, kind == 4 ? 1e-5 : 1e-4);
    const double turn = random.uniform(0.0, 6.0);
    // The depth that rounding leaves.
    const Touch first = touch_of(kind, depth, random);
    const double reach = kBore - first.reach + depth;
    const Vec3 at(reach * std::cos(turn), reach * std::sin(turn), random.uniform(-0.05, 0.05));
    double to_wall = turn;
    if (const auto* box = std::get_if<Box>(&first.solid)) {
      to_wall -= std::atan2(box->half_sizes().y(), box->half_sizes().x());
    }
    const Pose X{rotation_about(Vec3::UnitZ(), to_wall), at};
    for (const bool mirrored : {false, true}) {
      const Interference out = mirrored ? test::evaluated(first.solid, block, X.inverse())
                                        : test::evaluated(block, first.solid, X);
      const double rounding = 1e-15 / depth;  // of a place on the wall, twice
      EXPECT_NEAR(
          out.total.volume, first.expected,
          (first.slack + 30.0 * depth / kBore + rounding) * first.expected + out.total.volume_error)
          << "kind " << kind << " depth " << depth << " turn " << turn << " mirrored " << mirrored;
      EXPECT_EQ(out.sites.size(), 1u);
    }
  }
}

// A plug with the taper of its cup, far narrower, along the wall: sections from the apex see both
// edge on, and left it to the octree or found nothing.
TEST(LightTouches, OfAPlugAlongACupAreAllThere) {
  test::Random random(8);
  for (int i = 0; i < test::cases(200, 20); ++i) {
    const double slope = random.uniform(0.05, 0.4), h = 0.05, r = random.uniform(0.03, 0.09);
    if (r - slope * h < 0.005) continue;
    const double depth = kBore * random.log_uniform(1e-8, 1e-6), turn = random.uniform(0.0, 6.0);
    const Csg cup(Csg::Operation::kDifference, Csg(Box({.half_sizes = {0.3, 0.3, 0.1}})),
                  Csg(Frustum({.bottom_radius = kBore - 0.1 * slope,
                               .top_radius = kBore + 0.1 * slope,
                               .half_length = 0.1})));
    const Frustum plug(
        {.bottom_radius = r - slope * h, .top_radius = r + slope * h, .half_length = h});
    const double reach = kBore - r + depth;
    const Pose X{Mat3::Identity(), {reach * std::cos(turn), reach * std::sin(turn), 0.0}};
    double expected = 0.0;
    constexpr int kSteps = 100;
    for (int k = 0; k < kSteps; ++k) {
      const double z = h * (2.0 * (k + 0.5) / kSteps - 1.0);
      expected += area_beyond(r + slope * z, depth, kBore + slope * z) * 2.0 * h / kSteps;
    }
    for (const bool mirrored : {false, true}) {
      const Interference out =
          mirrored ? test::evaluated(plug, cup, X.inverse()) : test::evaluated(cup, plug, X);
      EXPECT_NEAR(out.total.volume, expected,
                  (1e-4 + 1e-15 / depth) * expected + out.total.volume_error)
          << "case " << i << " depth " << depth << " mirrored " << mirrored;
      EXPECT_EQ(out.total.status, Status::kOk);
      EXPECT_EQ(out.sites.size(), 1u);
    }
  }
}

}  // namespace
}  // namespace volcontact::light_touches_test
