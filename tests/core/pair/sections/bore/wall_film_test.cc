// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/bore/wall_film.h"

#include <gtest/gtest.h>

#include "core/support/csg_solids.h"
#include "core/support/evaluated.h"
#include "core/support/gradient.h"

namespace volcontact::wall_film_test {
namespace {

using test::evaluated;
namespace solids = volcontact::testing;

constexpr double kBore = 0.1, kHalfPeg = 0.15, kTop = 0.2, kMiddle = 0.1;

Csg bored_block() { return solids::box(.3, .3, kTop) - solids::tube(kBore, .4); }

// A peg about an axis that leans by `lean` against that of the bore and passes it at the distance
// `shift` in the middle of the peg, which reaches out of the block: over the wall at (theta, z)
// lies
//   d = s cos - gap - (s sin)^2 / (2 R),   s = shift + lean (z - middle).
// V and the height of its middle by sums over 4,000 x 800 places.
struct Film {
  double volume = 0.0, height = 0.0;
};
Film film(double gap, double shift, double lean) {
  constexpr int kAround = 4000, kAlong = 800;
  const double low = kMiddle - kHalfPeg, r = kBore - gap;
  Film sum;
  for (int i = 0; i < kAround; ++i) {
    const double theta = 2.0 * kPi * (i + 0.5) / kAround, c = std::cos(theta), s = std::sin(theta);
    for (int j = 0; j < kAlong; ++j) {
      const double z = low + (kTop - low) * (j + 0.5) / kAlong, off = shift + lean * (z - kMiddle);
      const double across = off * s;
      const double d = off * c - gap - across * across / (r + std::sqrt(r * r - across * across));
      if (!(d > 0.0)) continue;
      sum.volume += d * (kBore + 0.5 * d);
      sum.height += d * (kBore + 0.5 * d) * z;
    }
  }
  sum.height /= sum.volume;
  sum.volume *= 2.0 * kPi / kAround * (kTop - low) / kAlong;
  return sum;
}

// Pegs that lean by less than sections can tell from nothing, and by more.
TEST(WallFilm, APegThatLeansByNextToNothing) {
  const Csg block = bored_block();
  for (const double gap : {0.0, 1e-7}) {
    const Cylinder peg({.radius = kBore - gap, .half_length = kHalfPeg});
    for (const double lean : {1e-10, 1e-9, 1e-8, 9.9e-8, 1.01e-7, 1e-6}) {
      for (const double depth : {1e-10, 1e-9, 1e-8, 1e-7}) {
        const Pose X = solids::turned(Vec3::UnitY(), lean, {gap + depth, 0, kMiddle});
        const Film expected = film(gap, gap + depth, lean);
        const VolumeMetrics m = evaluated(block, peg, X).total;
        const VolumeMetrics n = evaluated(peg, block, X.inverse()).total;
        // Radii and poses are rounded: 3e-17 m of a film.
        const double slack = 1e-4 + 1e-15 / depth;
        EXPECT_NEAR(m.volume, expected.volume, slack * expected.volume) << gap << lean << depth;
        EXPECT_NEAR(n.volume, expected.volume, slack * expected.volume) << gap << lean << depth;
        EXPECT_NEAR(m.centroid.z(), expected.height, 1e-3 * kHalfPeg) << gap << lean << depth;
        EXPECT_EQ(m.status, Status::kOk);
      }
    }
  }
}

// S and T are the gradient of V, by differences.
TEST(WallFilm, TheGradientOfTheVolume) {
  const Csg block = bored_block();
  const Cylinder peg({.radius = kBore, .half_length = kHalfPeg});
  const double lean = 2e-9, step = 1e-11;
  const Vec3 shift(3e-10, 1e-10, kMiddle);
  const Pose X = solids::turned(Vec3::UnitY(), lean, shift);
  const VolumeMetrics m = evaluated(block, peg, X).total;
  const auto volume = [&](const Vec3& p, double angle) {
    return evaluated(block, peg, solids::turned(Vec3::UnitY(), angle, p)).total.volume;
  };
  for (int i = 0; i < 2; ++i) {
    const Vec3 e = step * Vec3::Unit(i);
    const double slope = (volume(shift + e, lean) - volume(shift - e, lean)) / (2.0 * step);
    EXPECT_NEAR(-m.area_vector[i], slope, 2e-3 * m.area);
  }
  // About the middle of the peg.
  const double slope =
      (volume(shift, lean + 10.0 * step) - volume(shift, lean - 10.0 * step)) / (20.0 * step);
  const Vec3 about = m.area_moment - shift.cross(m.area_vector);
  EXPECT_NEAR(-about.y(), slope, 2e-3 * m.area * kHalfPeg);
}

// Two films that face each other are two sites, whose forces turn the peg upright.
TEST(WallFilm, APegThatLeansInItsBoreTouchesTwice) {
  const Interference out =
      evaluated(bored_block(), Cylinder({.radius = kBore, .half_length = kHalfPeg}),
                solids::turned(Vec3::UnitY(), 1e-8, {0, 0, .02}));
  ASSERT_EQ(out.sites.size(), 2u);
  EXPECT_NEAR(out.sites[0].volume, out.sites[1].volume, 1e-4 * out.sites[0].volume);
  EXPECT_LT(out.sites[0].normal().dot(out.sites[1].normal()), -0.999);
}

// Of the same cone as the bore, moved aside or along the axis: d / cos = shift . normal.
TEST(WallFilm, AConeInAConicalBore) {
  const double top = .1, bottom = .05, half = .05, slope = (top - bottom) / (2.0 * half);
  const Csg block = solids::box(.3, .3, half) - solids::cone(bottom, top, half);
  const Frustum plug({.bottom_radius = bottom, .top_radius = top, .half_length = half});
  for (const double shift : {1e-11, 1e-10, 2e-9}) {
    // Sideways half of the wall is met: int cos+ = 2, times r over the height. Downwards all of it.
    const double aside = 2.0 * shift * 0.5 * (top + bottom) * 2.0 * half;
    const double down = 2.0 * kPi * shift * slope * 0.5 * (top + bottom) * 2.0 * half;
    const VolumeMetrics m = evaluated(block, plug, solids::at(shift, 0, 0)).total;
    const VolumeMetrics n = evaluated(block, plug, solids::at(0, 0, -shift)).total;
    const double slack = 1e-3 + 1e-15 / shift;
    EXPECT_NEAR(m.volume, aside, slack * aside);
    EXPECT_NEAR(n.volume, down, slack * down);
  }
}

// What fits exactly does not touch.
TEST(WallFilm, NothingBetweenAWallAndWhatFitsIt) {
  for (const double z : {0.0, .03, .1}) {
    const Cylinder peg({.radius = kBore, .half_length = kHalfPeg});
    EXPECT_EQ(evaluated(bored_block(), peg, solids::at(0, 0, z)).total.volume, 0.0);
  }
}

}  // namespace
}  // namespace volcontact::wall_film_test
