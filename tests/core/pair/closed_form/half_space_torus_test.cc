// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/closed_form/half_space_torus.h"

#include "core/reference/section_oracle.h"
#include "core/support/half_space_checks.h"

namespace volcontact::half_space_torus_test {
namespace {

using test::immersed_by;
using test::Random;
using test::tilted_by;

Torus random_torus(double thinnest, double fattest, Random& random) {
  const double major = random.uniform(0.3, 1.0);
  return Torus({.major_radius = major, .minor_radius = major * random.uniform(thinnest, fattest)});
}

VolumeMetrics expected_metrics(const Torus& b, const Pose& X) {
  const long double R = b.major_radius(), r = b.minor_radius();
  const auto half = [=](long double q) { return std::sqrt(std::max(0.0L, (r - q) * (r + q))); };
  const auto outer = [=](long double q) { return R + half(q); };
  const auto inner = [=](long double q) { return R - half(q); };
  const auto slant = [=](long double q) { return r / std::max(1e-15L, half(q)); };
  // Breaks towards the top and bottom circles: a chord close by turns fast there.
  std::vector<long double> breaks{0.0L};
  for (long double rest = r; rest > 1e-9L * r; rest /= 4) {
    breaks.insert(breaks.end(), {r - rest, rest - r});
  }
  breaks.insert(breaks.end(), {r, -r});
  std::sort(breaks.begin(), breaks.end());
  VolumeMetrics m = test::sections_below(test::Revolution{breaks, outer, inner, slant, slant}, X);
  m.depth = b.support_height(-X.rotation.row(2)) - X.translation.z();
  return m;
}

constexpr test::Tolerance kTight{1e-8, 1.0};

TEST(HalfSpaceTorus, EqualsItsSections) {
  Random random(1);
  for (int i = 0; i < 40; ++i) {
    const Torus b = random_torus(0.05, 0.9, random);
    const Mat3 R = tilted_by(random.uniform(0.02, kPi - 0.02), random);
    const double share = i % 3 ? random.uniform() : random.log_uniform(1e-3, 1.0);
    const Pose X = immersed_by(b, R, share, random);
    const VolumeMetrics m = closed_form(HalfSpace(), b, X);
    EXPECT_TRUE(test::same(m, expected_metrics(b, X), kTight)) << i;
  }
}

TEST(HalfSpaceTorus, StandingOnEdgeAndLyingTiltedEqualTheirSections) {
  Random random(2);
  for (int i = 0; i < 40; ++i) {
    const Torus b = random_torus(0.05, 0.9, random);
    const double tilt = random.log_uniform(1e-8, 0.1);
    const Mat3 R = tilted_by(i % 2 ? kPi / 2 + tilt : 0.02 + tilt, random);
    const Pose X = immersed_by(b, R, random.log_uniform(1e-3, 0.9), random);
    const VolumeMetrics m = closed_form(HalfSpace(), b, X);
    EXPECT_TRUE(test::same(m, expected_metrics(b, X), kTight)) << i;
  }
}

// There the section changes with a singularity on the range, and the rule is no longer exact.
TEST(HalfSpaceTorus, APlaneThatTouchesTheHoleIsWithinTheErrorClaimed) {
  Random random(4);
  for (int i = 0; i < 40; ++i) {
    const Torus b = random_torus(0.05, 0.9, random);
    const double off = i % 2 ? random.log_uniform(1e-15, 1e-4) : 0.0;
    const Pose X{tilted_by(kPi / 2, random),
                 Vec3(0.2, 0.1, b.major_radius() - b.minor_radius() + off)};
    const VolumeMetrics m = closed_form(HalfSpace(), b, X);
    const double expected = expected_metrics(b, X).volume;
    EXPECT_LE(std::abs(m.volume - expected), m.volume_error + 1e-10 * expected) << i;
  }
}

TEST(HalfSpaceTorus, LyingFlatAndNearlySoIsARingOfOneSection) {
  // Pappus: the segment's area times the way of its centroid; all round alike.
  Random random(3);
  const double R = 0.6, r = 0.2;
  const Torus b({.major_radius = R, .minor_radius = r});
  for (double h : {1e-4, 0.01, 0.1, 0.2, 0.3}) {
    for (double tilt : {0.0, 1e-15, 1e-12, kPi - 1e-12, kPi}) {
      const Pose X{tilted_by(tilt, random), Vec3(0.3, 0.4, r - h)};
      const VolumeMetrics m = closed_form(HalfSpace(), b, X);
      const long double w = std::sqrt(h * (2.0L * r - h)), c = static_cast<long double>(r) - h;
      const double section = static_cast<double>(r * (r * std::atan2(w, c)) - c * w);
      EXPECT_NEAR(m.volume / (2 * kPi * R * section), 1.0, 1e-8);
      EXPECT_NEAR(m.area / (2 * kPi * R * 2 * static_cast<double>(w)), 1.0, 1e-8);
      EXPECT_LT((m.centroid - Vec3(0.3, 0.4, m.centroid.z())).norm(), 1e-7);
      EXPECT_NEAR(m.counter_area / (2 * kPi * R * r * 2 * static_cast<double>(std::atan2(w, c))),
                  1.0, 1e-8);
      EXPECT_NEAR(m.depth, h, 1e-11);
    }
  }
}

TEST(HalfSpaceTorus, CutThroughItsAxisIsHalf) {
  const Torus b({.major_radius = 0.6, .minor_radius = 0.2});
  const VolumeMetrics own = b.own_metrics();
  for (double tilt : {0.0, 1e-15, 1e-11, 1e-6, 0.01}) {
    const Pose X{test::turn(Vec3::UnitX(), kPi / 2 + tilt), Vec3::Zero()};
    const VolumeMetrics m = closed_form(HalfSpace(), b, X);
    EXPECT_NEAR(m.volume / own.volume, 0.5, 1e-10);
    if (tilt < 1e-5) {
      EXPECT_NEAR(m.area, 2.0 * kPi * 0.04, 1e-8);  // two discs
    }
  }
  for (double tilt : {0.1, 0.4, 1.0, 1.5}) {
    const Pose X{test::turn(Vec3::UnitX(), tilt), Vec3::Zero()};
    EXPECT_NEAR(closed_form(HalfSpace(), b, X).volume / own.volume, 0.5, 1e-9);
  }
}

TEST(HalfSpaceTorus, AHornTorusHasNoHoleAndIsServedToo) {
  Random random(4);
  for (int i = 0; i < 20; ++i) {
    const Torus b({.major_radius = 0.5, .minor_radius = 0.5});
    const Mat3 R = tilted_by(random.uniform(0.1, 3.0), random);
    const Pose X = immersed_by(b, R, random.uniform(0.05, 0.95), random);
    const VolumeMetrics m = closed_form(HalfSpace(), b, X);
    EXPECT_TRUE(test::same(m, expected_metrics(b, X), {1e-5, 1.0})) << i;
  }
}

// Discs that touch on the axis, from where they are whole to where they are dry within 1e-11 of a
// turn: half of V, and the two discs.
TEST(HalfSpaceTorus, AHornTorusCutThroughItsAxisIsHalf) {
  for (const double part : {1.0, 1.0 - 1e-9, 1.0 - 1e-5}) {
    const Torus b({.major_radius = 0.1, .minor_radius = 0.1 * part});
    const VolumeMetrics own = b.own_metrics();
    for (const double tilt : {0.0, 1e-15, 2.9e-11, 1e-8, 1e-5}) {
      for (const double height : {0.0, 2.4e-18, -2.4e-18, 1e-13, 1e-8}) {
        for (const double side : {-1.0, 1.0}) {
          const Pose X{test::turn(Vec3::UnitX(), kPi / 2 + side * tilt), {0.0, 0.0, height}};
          const VolumeMetrics m = closed_form(HalfSpace(), b, X);
          const double most = 2.0 * (1.0 + 1e-3) * kPi * 0.01 * (std::abs(height) + 0.2 * tilt);
          EXPECT_NEAR(m.volume, 0.5 * own.volume, most + m.volume_error + 1e-7 * own.volume)
              << part << " " << tilt << " " << height;
          EXPECT_NEAR(m.area_vector.norm(), 2.0 * kPi * 0.01 * part * part, 1e-4)
              << part << " " << tilt << " " << height;
        }
      }
    }
  }
}

// Of an upright torus below a plane at `height` over its middle: rings at all distances from its
// own middle plane, each cut by a line.
double volume_of_rings(const Torus& b, double height) {
  const auto disc_below = [height](double radius) {
    if (!(std::abs(height) < radius)) return height > 0.0 ? kPi * radius * radius : 0.0;
    const double half = std::sqrt((radius - height) * (radius + height));
    return radius * radius * std::atan2(half, -height) + height * half;
  };
  constexpr int kRings = 50000;
  const double R = b.major_radius(), r = b.minor_radius();
  double sum = 0.0;
  for (int i = 0; i < kRings; ++i) {
    const double theta = 0.5 * kPi * (i + 0.5) / kRings, half = r * std::cos(theta);
    sum += (disc_below(R + half) - disc_below(R - half)) * half;
  }
  return sum * kPi / kRings;
}

// The plane touches an equator, or nearly does: in the sections next to it a root bends within far
// less than the rest of them.
TEST(HalfSpaceTorus, StandsUprightOnAPlaneThatTouchesAnEquator) {
  Random random(8);
  for (int i = 0; i < 60; ++i) {
    const Torus b = random_torus(0.1, 0.9, random);
    const double R = b.major_radius(), r = b.minor_radius();
    const double off = random.log_uniform(1e-15, 1e-4) * (i % 2 == 0 ? R : -R);
    for (const double at : {-R - r, r - R, R - r, R + r}) {
      const Mat3 upright = test::turn(Vec3::UnitZ(), random.uniform(0.0, 2.0 * kPi)) *
                           test::turn(Vec3::UnitX(), 0.5 * kPi);
      const VolumeMetrics m = closed_form(HalfSpace(), b, {upright, Vec3(0.0, 0.0, -(at + off))});
      const double expected = volume_of_rings(b, at + off);
      EXPECT_NEAR(m.volume, expected, m.volume_error + 1e-9 * R * R * R) << at << " " << off;
      EXPECT_LE(m.volume_error, 1e-8 * R * R * R) << at << " " << off;
    }
  }
}

// Next to all of it only a cap stands out, whose volume and slope are next to nothing.
TEST(HalfSpaceTorus, NearlyAllIsAllButACap) {
  Random random(9);
  for (int i = 0; i < 200; ++i) {
    const Torus b = random_torus(0.1, 0.9, random);
    const double R = b.major_radius(), r = b.minor_radius();
    const double cap = random.log_uniform(1e-15, 1e-6) * r;
    const Mat3 upright = test::turn(Vec3::UnitX(), 0.5 * kPi);
    const VolumeMetrics m = closed_form(HalfSpace(), b, {upright, Vec3(0.0, 0.0, cap - R - r)});
    const double own = b.own_metrics().volume;
    EXPECT_NEAR(m.volume, own, m.volume_error + 2.0 * kPi * (R + r) * cap * cap) << cap;
  }
}

TEST(HalfSpaceTorus, GradientsAreTheForces) {
  Random random(5);
  for (int i = 0; i < 40; ++i) {
    const Torus b = random_torus(0.1, 0.8, random);
    const Pose X = immersed_by(b, random.rotation(), random.uniform(0.02, 0.98), random);
    test::expect_gradients(b, X, 1e-4, 1e-6);
  }
}

TEST(HalfSpaceTorus, WhollyBelowIsContained) {
  Random random(6);
  for (int i = 0; i < 30; ++i) {
    const Torus b = random_torus(0.1, 0.9, random);
    const double surface = 4.0 * kPi * kPi * b.major_radius() * b.minor_radius();
    const Mat3 R = random.rotation();
    test::expect_contained(b, immersed_by(b, R, random.uniform(1.001, 1.5), random), surface);
    test::expect_continuous_into_containment(b, R, random);
  }
}

TEST(HalfSpaceTorus, ApartAndThinAreNothing) {
  Random random(7);
  const Torus wire({.major_radius = 1.0, .minor_radius = 0.0});
  for (int i = 0; i < 50; ++i) {
    EXPECT_FALSE(closed_form(HalfSpace(), wire, random.pose(1.0)).touching());
    const Torus b = random_torus(0.1, 0.9, random);
    EXPECT_FALSE(
        closed_form(HalfSpace(), b, immersed_by(b, random.rotation(), -1e-9, random)).touching());
  }
}

}  // namespace
}  // namespace volcontact::half_space_torus_test
