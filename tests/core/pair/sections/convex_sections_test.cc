// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/convex_sections.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "core/support/evaluated.h"
#include "core/support/gradient.h"
#include "core/support/matchers.h"
#include "core/support/meshes.h"
#include "core/support/random_shapes.h"
#include "core/support/sanitized.h"
#include "volcontact/pair/closed_form/half_space_ellipsoid.h"
#include "volcontact/pair/closed_form/sphere_sphere.h"
#include "volcontact/pair/octree/octree.h"

namespace volcontact::convex_sections_test {
namespace {

// Bodies of a few tenths of a metre; the first is unbounded, those of plane faces come last.
std::vector<Shape> solids() {
  test::Random random(41);
  return {HalfSpace(),
          Sphere({.radius = 0.25}),
          Ellipsoid({.semi_axes = {0.3, 0.2, 0.12}}),
          Capsule({.radius = 0.12, .half_length = 0.2}),
          Cylinder({.radius = 0.2, .half_length = 0.15}),
          Frustum({.bottom_radius = 0.25, .top_radius = 0.1, .half_length = 0.2}),
          Box({.half_sizes = {0.3, 0.2, 0.1}}),
          test::random_polytope(10, random)};
}
bool is_flat(std::size_t i) { return i == 0 || i >= 6; }

VolumeMetrics lines(const Shape& a, const Shape& b, const Pose& X_AB, double tolerance = 1e-3,
                    SimdPath path = best_simd_path()) {
  static LinesScratch scratch;
  scratch.path = path;
  Interference out;
  bool answered = false;
  std::visit(
      [&](const auto& solid_a, const auto& solid_b) {
        if constexpr (HasFaces<std::decay_t<decltype(solid_a)>> &&
                      HasFaces<std::decay_t<decltype(solid_b)>>) {
          answered = lines_interference(ConvexView(solid_a), ConvexView(solid_b), X_AB,
                                        {.tolerance = tolerance}, scratch, out);
        }
      },
      a, b);
  if (!answered) return test::evaluated(a, b, X_AB, {.tolerance = tolerance}).total;
  EXPECT_EQ(out.sites.size(), out.total.touching() ? 1u : 0u);
  return out.total;
}

// Moves B along a random direction until it overlaps A by `depth` and no more.
Pose pose_of_depth(const Shape& a, const Shape& b, double depth, test::Random& random) {
  Pose X{random.rotation(), Vec3::Zero()};
  const Vec3 d = std::holds_alternative<HalfSpace>(a) ? Vec3(Vec3::UnitZ()) : random.direction();
  double touching = 0.0, apart = 3.0;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (touching + apart);
    X.translation = middle * d;
    (lines(a, b, X).touching() ? touching : apart) = middle;
  }
  X.translation = (touching - depth) * d;
  return X;
}

TEST(Lines, EllipsoidOnAHalfSpaceIsTheClosedForm) {
  test::Random random(42);
  const Ellipsoid ellipsoid({.semi_axes = {0.3, 0.2, 0.12}});
  for (double depth : {1e-6, 1e-4, 1e-2, 0.1, 0.2}) {
    const Pose X = pose_of_depth(HalfSpace(), ellipsoid, depth, random);
    const VolumeMetrics m = lines(HalfSpace(), ellipsoid, X);
    VolumeMetrics expected = closed_form(HalfSpace(), ellipsoid, X);
    expected.counter_area = m.counter_area;  // has no closed form; see the next test
    EXPECT_TRUE(test::same(m, expected, {2e-5, 0.1})) << "depth " << depth;
    EXPECT_NEAR(m.volume, expected.volume, 1e-6 * expected.volume);
  }
}

TEST(Lines, BentAreaOfAnEllipsoidsCapIsItsQuadrature) {
  const Vec3 a(0.3, 0.2, 0.12);
  const double height = 0.11, reach = std::sqrt(1.0 - height * height / (a.z() * a.z()));
  double area = 0.0;  // over the footprint, in its own polar coordinates
  constexpr int kRings = 1000, kSpokes = 64;
  for (int i = 0; i < kRings; ++i) {
    for (int j = 0; j < kSpokes; ++j) {
      const double r = reach * (i + 0.5) / kRings, angle = 2.0 * kPi * j / kSpokes;
      const Vec3 unit(r * std::cos(angle), r * std::sin(angle), std::sqrt(1.0 - r * r));
      const Vec3 gradient = unit.cwiseQuotient(a);
      area += gradient.norm() / gradient.z() * a.x() * a.y() * r;
    }
  }
  area *= reach / kRings * 2.0 * kPi / kSpokes;
  const VolumeMetrics m =
      lines(HalfSpace(), Ellipsoid({.semi_axes = a}), {Mat3::Identity(), {0, 0, height}});
  EXPECT_NEAR(m.counter_area, area, 1e-6 * area);
}

TEST(Lines, ALensOfTwoBallsIsTheClosedForm) {
  const Sphere a({.radius = 0.25}), b({.radius = 0.2});
  const Vec3 direction = Vec3(0.3, 0.5, 0.7).normalized();
  for (double depth : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1}) {
    const Pose X{Mat3::Identity(), (0.45 - depth) * direction};
    const VolumeMetrics m = lines(a, b, X);
    EXPECT_TRUE(test::same(m, closed_form(a, b, X), {2e-6, 0.1})) << "depth " << depth;
  }
}

// The hoof that a plane through the middle of the bottom cuts off a cylinder has 2/3 r^2 h; here r
// is 0.2 and the plane rises 0.3 at the wall (Archimedes, The Method, proposition 11).
TEST(Lines, AHoofHasTwoThirdsOfTheSquareTimesItsHeight) {
  const Cylinder cylinder({.radius = 0.2, .half_length = 0.5});
  const Mat3 tilt = test::turn(Vec3::UnitX(), std::atan2(0.3, 0.2));
  const Pose X{tilt, tilt * Vec3(0.0, 0.0, 0.5)};
  EXPECT_NEAR(lines(HalfSpace(), cylinder, X).volume, 2.0 / 3.0 * 0.04 * 0.3, 1e-8);
}

// Two equal round tubes that cross at a right angle share 16/3 r^3 (Archimedes, proposition 15).
TEST(Lines, CrossedCylindersShareSixteenThirdsOfTheCube) {
  const Cylinder cylinder({.radius = 0.2, .half_length = 0.5});
  const Pose X{test::turn(Vec3::UnitX(), kPi / 2.0), Vec3::Zero()};
  const VolumeMetrics m = lines(cylinder, cylinder, X);
  EXPECT_NEAR(m.volume, 16.0 / 3.0 * 0.008, 1e-4 * m.volume);
  EXPECT_LE(m.centroid.norm(), 1e-6);
}

TEST(Lines, AnUprightCylinderIsADisc) {
  const Cylinder cylinder({.radius = 0.2, .half_length = 0.4});
  for (double tilt : {0.0, 1e-12, 1e-10, 1e-9, 1e-8, 1e-7}) {
    const Pose X{test::turn({1.0, 0.3, 0.0}, tilt), {0.0, 0.0, 0.3}};
    EXPECT_NEAR(lines(HalfSpace(), cylinder, X).volume, kPi * 0.04 * 0.1, 1e-8) << tilt;
  }
}

const int kPoses = test::cases(20, 8, 1);
const int kCoaxial = test::cases(120, 40, 8);

TEST(Lines, StaysWithinTheCertifiedBoundsOfTheOctree) {
  const std::vector<Shape> all = solids();
  test::Random random(43);
  OctreeScratch scratch;
  Interference octree;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 1; j < all.size(); ++j) {
      if (is_flat(i) && is_flat(j)) continue;
      for (int k = 0; k < kPoses; ++k) {
        const bool shallow = k % 2 == 0;
        const Pose X = shallow
                           ? pose_of_depth(all[i], all[j], random.log_uniform(1e-4, 0.03), random)
                           : random.pose(0.3);
        const VolumeMetrics m = lines(all[i], all[j], X);
        octree_interference(all[i], all[j], X, {.tolerance = 2e-2}, scratch, octree);
        const VolumeMetrics& o = octree.total;
        EXPECT_LE(std::abs(m.volume - o.volume), o.volume_error + m.volume_error + 1e-15)
            << name_of(all[i]) << " - " << name_of(all[j]) << " pose " << k << ", V = " << o.volume;
      }
    }
  }
}

TEST(Lines, OtherOrderOtherSideOfTheSameNumbers) {
  const std::vector<Shape> all = solids();
  test::Random random(44);
  for (std::size_t i = 1; i < all.size(); ++i) {
    for (std::size_t j = 1; j < all.size(); ++j) {
      if (is_flat(i) && is_flat(j)) continue;
      if (test::kSanitized && (i + j) % 4 != 1) continue;
      const Pose X = pose_of_depth(all[i], all[j], 0.01, random);
      const VolumeMetrics m = lines(all[i], all[j], X);
      const VolumeMetrics mirrored = reversed(transformed(lines(all[j], all[i], X.inverse()), X));
      EXPECT_NEAR(m.volume, mirrored.volume, 2e-4 * m.volume) << name_of(all[i]) << name_of(all[j]);
      EXPECT_LE((m.area_vector - mirrored.area_vector).norm(), 5e-3 * m.area);
    }
  }
}

TEST(Lines, AreaVectorAndMomentAreTheGradientOfVolume) {
  const std::vector<Shape> all = solids();
  test::Random random(45);
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 1; j < all.size(); ++j) {
      if (is_flat(i) && is_flat(j)) continue;
      if (test::kSanitized && (i + j) % 4 != 1) continue;  // thirteen times the tests above
      const Pose X = pose_of_depth(all[i], all[j], 0.02, random);
      const VolumeMetrics m = lines(all[i], all[j], X, 1e-6);
      const auto volume = [&](const Pose& X_AB) {
        return lines(all[i], all[j], X_AB, 1e-6).volume;
      };
      const test::Gradient g = test::gradient_of_A(volume, X, 1e-3);
      EXPECT_LE((g.shift - m.area_vector).norm(), 3e-3 * m.area)
          << name_of(all[i]) << " - " << name_of(all[j]);
      EXPECT_LE((g.turn - m.area_moment).norm(), 3e-3 * m.area * 0.5)
          << name_of(all[i]) << " - " << name_of(all[j]);
    }
  }
}

// Of bytes, so that even the signs of zeros and the bits of rounding agree.
TEST(Lines, AreaVectorHasTheDigitsThatAreAskedOfTheVolume) {
  // Round on round and round on edges; some poses have a place where a face only begins to touch.
  const std::vector<Shape> all = solids();
  test::Random random(44);
  std::vector<double> off;
  for (std::size_t i = 1; i < all.size(); ++i) {
    for (std::size_t j = i; j < all.size(); ++j) {
      if (is_flat(i) && is_flat(j)) continue;
      if (test::kSanitized && (i + j) % 2 == 1) continue;
      const Pose X = pose_of_depth(all[i], all[j], 0.02, random);
      const VolumeMetrics m = lines(all[i], all[j], X, 1e-8);
      const auto volume = [&](const Pose& Y) { return lines(all[i], all[j], Y, 1e-8).volume; };
      const test::Gradient gradient = test::gradient_of_A(volume, X, 2e-5);
      off.push_back((gradient.shift - m.area_vector).norm() / m.area_vector.norm());
      off.push_back((gradient.turn - m.area_moment).norm() / (0.3 * m.area_vector.norm()));
    }
  }
  std::sort(off.begin(), off.end());
  EXPECT_LT(off[off.size() / 2], 2e-10);
  EXPECT_LT(off[off.size() * 3 / 4], 3e-9);
}

// A thin rod has small ends and a long wall. What the wall's normals sum up to is as wrong as the
// wall is long; the ends, and where the rod enters the other solid, tell how long it can be at
// most.
TEST(Lines, TheAreaVectorOfARodIsNoLongerThanItsEnds) {
  const Shape others[] = {Sphere({.radius = 0.15}),
                          Frustum({.bottom_radius = 0.3, .top_radius = 0.4, .half_length = 0.23}),
                          Ellipsoid({.semi_axes = {0.3, 0.2, 0.12}}),
                          Cylinder({.radius = 0.2, .half_length = 0.15})};
  test::Random random(8);
  for (const Shape& a : others) {
    for (int i = 0; i < test::cases(60, 15); ++i) {
      const double radius = std::pow(10.0, random.uniform(-5.0, -3.0));
      const Shape rods[] = {
          Capsule({.radius = radius, .half_length = 0.08}),
          Cylinder({.radius = radius, .half_length = 0.3}),
          Frustum({.bottom_radius = radius, .top_radius = 1.2 * radius, .half_length = 0.15})};
      for (const Shape& b : rods) {
        const Pose X = random.pose(0.2);
        for (const VolumeMetrics& m : {lines(a, b, X), lines(b, a, X.inverse())}) {
          if (!m.touching()) continue;
          EXPECT_LE(m.area_vector.norm(), 1.001 * std::min(m.area, m.counter_area))
              << name_of(a) << " " << i << " " << radius << " V " << m.volume;
        }
      }
    }
  }
}

// The same where two round solids fit but for a touch by rounding.
TEST(Lines, TheAreaVectorOfATouchByRoundingIsAsSmall) {
  const Frustum cup({.bottom_radius = 0.12886933338484124,
                     .top_radius = 0.25773866676968249,
                     .half_length = 0.16902644747726908});
  const Ellipsoid ball({.semi_axes = {0.16902644747726908, 0.15, 0.16902644747726908}});
  const Frustum other({.bottom_radius = 0.25, .top_radius = 0.2, .half_length = 0.1});
  const Cylinder disc({.radius = 0.13, .half_length = 0.05});
  for (const double off : {0.0, 1e-15, 1e-13, 2e-11, 1e-9, 1e-7}) {
    for (const double aside : {0.0, 0.0045646476397676414, 0.05}) {
      const Pose in_cup = test::shifted(aside, aside, -off),
                 on_face = test::shifted(aside, aside, 0.05 + off);
      for (const VolumeMetrics& m : {lines(cup, ball, in_cup), lines(disc, other, on_face)}) {
        EXPECT_LE(m.area_vector.norm(), 1.001 * std::min(m.area, m.counter_area) + 1e-16)
            << off << " " << aside;
      }
    }
  }
}

TEST(Lines, EveryInstructionSetGivesTheSameBits) {
  const std::vector<Shape> all = solids();
  test::Random random(46);
  int compared = 0;
  for (SimdPath path : {SimdPath::kAvx2, SimdPath::kAvx512}) {
    if (!can_run(path)) continue;
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t j = 1; j < all.size(); ++j) {
        if (is_flat(i) && is_flat(j)) continue;
        for (int k = 0; k < kPoses; ++k) {
          const Pose X = random.pose(0.3);
          const VolumeMetrics m = lines(all[i], all[j], X, 1e-3, path);
          const VolumeMetrics portable = lines(all[i], all[j], X, 1e-3, SimdPath::kPortable);
          const auto same_bits = [&](const auto& x, const auto& y) {
            return std::memcmp(&x, &y, sizeof(x)) == 0;
          };
          ASSERT_TRUE(
              same_bits(m.volume, portable.volume) && same_bits(m.inertia, portable.inertia) &&
              same_bits(m.centroid, portable.centroid) && same_bits(m.area, portable.area) &&
              same_bits(m.area_vector, portable.area_vector) &&
              same_bits(m.area_moment, portable.area_moment) &&
              same_bits(m.depth_moment, portable.depth_moment) &&
              same_bits(m.depth, portable.depth) &&
              same_bits(m.counter_area, portable.counter_area) &&
              same_bits(m.volume_error, portable.volume_error))
              << name_of(all[i]) << " - " << name_of(all[j]);
          ++compared;
        }
      }
    }
  }
  if (compared == 0) GTEST_SKIP() << "this machine has the portable path only";
}

TEST(Lines, DegeneratePosesGiveFiniteNumbers) {
  const std::vector<Shape> all = solids();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 1; j < all.size(); ++j) {
      if (is_flat(i) && is_flat(j)) continue;
      for (double z : {0.0, 0.1, 0.12, 0.15, 0.2, 0.25, 0.3, 0.35, 0.45, 0.5, nan}) {
        for (const Mat3& r : {Mat3(Mat3::Identity()), test::turn(Vec3::UnitX(), kPi / 2.0),
                              test::turn(Vec3::UnitY(), kPi / 4.0)}) {
          const VolumeMetrics m = lines(all[i], all[j], {r, {0.0, 0.0, z}});
          EXPECT_TRUE(is_finite(m)) << name_of(all[i]) << " - " << name_of(all[j]) << " z " << z;
          EXPECT_EQ(m.status == Status::kInvalid, std::isnan(z));
          EXPECT_GE(m.volume, 0.0);
        }
      }
    }
  }
}

TEST(Lines, ASolidInsideAnotherIsContained) {
  const Cylinder inner({.radius = 0.1, .half_length = 0.1});
  const Box outer({.half_sizes = {0.5, 0.5, 0.5}});
  const Pose X{test::turn({1, 2, 3}, 0.4), {0.1, 0.0, -0.1}};
  const VolumeMetrics m = lines(outer, inner, X);
  EXPECT_EQ(m.status, Status::kContained);
  EXPECT_NEAR(m.volume, kPi * 0.01 * 0.2, 1e-15);
  EXPECT_TRUE(m.centroid.isApprox(X.translation));
  EXPECT_EQ(m.area_vector.norm(), 0.0);
}

// The sections sees nothing in the first of these poses, and the octree answers.
TEST(Lines, AConeWithItsAxisInAFaceAndItsRimOnAnotherIsCutInHalf) {
  const Vec3 half(1.0, 1.2, 0.6);
  const Frustum cone({.bottom_radius = 0.02, .top_radius = 0.0, .half_length = 0.18});
  for (const double z : {0.0, 7e-11, 0.3}) {
    const Pose X_AB{Vec3(-1.0, 1.0, -1.0).asDiagonal(), Vec3(half.x(), half.y() - 0.02, z)};
    const VolumeMetrics m =
        test::evaluated(Box({.half_sizes = half}), cone, X_AB, Engine::kLines).total;
    const double expected = 0.5 * cone.own_metrics().volume;
    EXPECT_NEAR(m.volume, expected, 1e-4 * expected);
  }
}

// The half-plane through the apex of a cone and along its axis sees both of its sides meet at once,
// and the face that holds the axis there as well.
TEST(Lines, HalfAConeLiesBelowTheFaceThatHoldsItsAxis) {
  const double r = 0.2, h = 0.15;
  const Shape box = Box({.half_sizes = {0.3, 0.25, 0.2}}),
              cone = Frustum({.bottom_radius = r, .top_radius = 0.0, .half_length = h});
  Mat3 R = {0, 0, 1, 0, 1, 0, -1, 0, 0};  // the axis along x
  for (double off : {0.0, 1e-12, -1e-12, 1e-7}) {
    // The rim touches the face y = 0.25.
    const Pose X{R, {0.0, 0.05 + off, 0.2}};
    const Interference out = test::evaluated(box, cone, X, Engine::kLines);
    EXPECT_EQ(out.engine, Engine::kLines);
    const double expected = 0.5 * kPi * r * r * 2.0 * h / 3.0;
    EXPECT_NEAR(out.total.volume, expected, 1e-4 * expected) << off;
    // By symmetry, and a quarter of the height from the base.
    EXPECT_NEAR(out.total.centroid.x(), -h + 0.5 * h, 1e-4 * h);
    EXPECT_NEAR(out.total.centroid.y(), 0.05, 1e-4 * r);
  }
}

// Bodies of revolution about one axis: the integral of the smaller of their sections, by the
// midpoint rule.
template <typename RadiusA, typename RadiusB>
double coaxial_volume(double from, double to, RadiusA&& radius_a, RadiusB&& radius_b) {
  constexpr int kSteps = 400000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double z = from + (to - from) * (i + 0.5) / kSteps;
    const double r = std::min(radius_a(z), radius_b(z));
    sum += r * r;
  }
  return kPi * sum * (to - from) / kSteps;
}
double radius_of(const Frustum& frustum, double z) {
  const Frustum::Params& p = frustum.params();
  if (std::abs(z) > p.half_length) return 0.0;
  const double share = 0.5 * (1.0 + z / p.half_length);
  return (1.0 - share) * p.bottom_radius + share * p.top_radius;
}

// The wall of the frustum comes so near the ball's surface, or a rim of it, that each takes over
// from the other within a small part of a section.
TEST(Lines, ABallInAFrustumAboutItsAxisHasSectionsOfDiscs) {
  test::Random random(51);
  for (int i = 0; i < kCoaxial; ++i) {
    const double r = 0.3, off = random.uniform(-0.2, 0.3), length = random.uniform(0.1, 0.3);
    const double side = random.uniform() < 0.5 ? -1.0 : 1.0;
    const double near = side * random.log_uniform(1e-6, 3e-2);
    Frustum::Params p{.bottom_radius = random.uniform(0.1, 0.5), .half_length = length};
    if (i % 2 == 0) {  // a rim on the ball, or nearly so
      const double rim = off - length, square = r * r - rim * rim;
      p.bottom_radius = square > 0.0 ? std::sqrt(square) + near : 0.2;
      p.top_radius = p.bottom_radius * random.uniform(0.1, 0.9);
    } else {  // a wall that touches it, or nearly so
      const double slope = random.uniform(-0.8, -0.1);
      const double at_center = (r + near) * std::sqrt(1.0 + slope * slope);
      p.bottom_radius = at_center + slope * (off - length);
      p.top_radius = at_center + slope * (off + length);
      if (!(p.bottom_radius > 0.01 && p.top_radius > 0.01)) continue;
    }
    const Frustum frustum(p);
    const double expected = coaxial_volume(
        off - length, off + length,
        [&](double z) { return std::sqrt(std::max(0.0, r * r - z * z)); },
        [&](double z) { return radius_of(frustum, z - off); });
    const Pose X{Mat3::Identity(), {0.0, 0.0, off}};
    for (const VolumeMetrics& m : {lines(Sphere({.radius = r}), frustum, X),
                                   lines(frustum, Sphere({.radius = r}), X.inverse())}) {
      EXPECT_NEAR(m.volume, expected, m.volume_error + 1e-8 * expected) << i << " " << near;
      EXPECT_NEAR(m.volume, expected, 1e-3 * expected) << i << " " << near;
    }
  }
}

// A disc with a slanted rim, much flatter than wide: its S is how V grows along the axis.
TEST(Lines, AFlatConeDiscIsPushedAlongTheAxis) {
  const Frustum body({.bottom_radius = 0.3, .top_radius = 0.1, .half_length = 0.2});
  for (double half : {1e-3, 1e-4, 1e-5}) {
    const Frustum disc({.bottom_radius = 0.4, .top_radius = 0.1, .half_length = half});
    for (double z : {-0.05, 0.03, 0.05, 0.12}) {
      const auto volume = [&](double at) {
        return coaxial_volume(
            at - half, at + half, [&](double x) { return radius_of(disc, x - at); },
            [&](double x) { return radius_of(body, x); });
      };
      constexpr double kStep = 1e-4;
      const double rate = (volume(z + kStep) - volume(z - kStep)) / (2.0 * kStep);
      const Pose X{Mat3::Identity(), {0.0, 0.0, z}};
      const VolumeMetrics m = lines(body, disc, X);
      EXPECT_NEAR(m.volume, volume(z), 1e-4 * m.volume);
      EXPECT_NEAR(-m.area_vector.z(), rate, 1e-3 * std::abs(rate)) << half << " " << z;
      const VolumeMetrics mirrored = lines(disc, body, X.inverse());
      EXPECT_NEAR(mirrored.area_vector.z(), rate, 1e-3 * std::abs(rate)) << half << " " << z;
    }
  }
}

// The part of a convex polygon, given by its corners in order, within a disc about the origin: for
// every edge the triangle to the origin where it is inside, and sectors where it is not.
double area_in_disc(const std::vector<Vec2>& polygon, double r) {
  const auto cross = [](const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); };
  const auto sector = [&](const Vec2& a, const Vec2& b) {
    return 0.5 * r * r * std::atan2(cross(a, b), a.dot(b));
  };
  double area = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2& p = polygon[i];
    const Vec2 d = polygon[(i + 1) % polygon.size()] - p;
    const double a = d.squaredNorm(), b = p.dot(d), square = b * b - a * (p.squaredNorm() - r * r);
    if (!(a > 0.0)) continue;
    const double root = std::sqrt(std::max(square, 0.0));
    const double from = std::clamp((-b - root) / a, 0.0, 1.0),
                 to = std::clamp((-b + root) / a, 0.0, 1.0);
    if (square <= 0.0 || from >= to) {
      area += sector(p, p + d);
      continue;
    }
    area +=
        sector(p, p + from * d) + 0.5 * cross(p + from * d, p + to * d) + sector(p + to * d, p + d);
  }
  return area;
}

// A polytope in a cylinder from sections across the axis of the cylinder: squares cut by the
// planes.
double volume_in_cylinder(const ConvexPolytope& polytope, const Cylinder& cylinder,
                          const Pose& X_PC) {
  constexpr int kSections = 4000;
  const Pose X_CP = X_PC.inverse();
  const double half = cylinder.half_length();
  std::vector<Vec2> polygon, cut;
  double sum = 0.0;
  for (int i = 0; i < kSections; ++i) {
    const double z = half * (2.0 * (i + 0.5) / kSections - 1.0);
    polygon = {{-9.0, -9.0}, {9.0, -9.0}, {9.0, 9.0}, {-9.0, 9.0}};
    for (const ConvexPolytope::Face& face : polytope.faces()) {
      const Vec3 n = X_CP.rotation * face.normal;
      const double offset = face.offset + n.dot(X_CP.translation) - n.z() * z;
      const auto beyond = [&](const Vec2& p) { return n.head<2>().dot(p) - offset; };
      cut.clear();
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vec2 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
        const double f = beyond(p), g = beyond(q);
        if (f <= 0.0) cut.push_back(p);
        if ((f <= 0.0) != (g <= 0.0)) cut.push_back(p + f / (f - g) * (q - p));
      }
      polygon.swap(cut);
    }
    if (polygon.size() > 2) sum += area_in_disc(polygon, cylinder.radius());
  }
  return sum * 2.0 * half / kSections;
}

TEST(Lines, APolytopeOfDozensOfFacesNearlyInOnePlaneHasSectionsOfPolygons) {
  test::Random random(52);
  for (int i = 0; i < kCoaxial / 4; ++i) {
    std::vector<Vec3> points;
    for (int k = 0; k < 60; ++k) {
      const double angle = random.uniform(0.0, 2.0 * kPi), rho = 0.3 * std::sqrt(random.uniform());
      points.push_back({rho * std::cos(angle), rho * std::sin(angle), random.uniform(-0.03, 0.03)});
    }
    const ConvexPolytope polytope(points);
    const Cylinder cylinder(
        {.radius = random.uniform(0.1, 0.4), .half_length = random.uniform(0.1, 0.4)});
    const Pose X{random.rotation(), random.in_box(0.2)};
    const double expected = volume_in_cylinder(polytope, cylinder, X);
    if (!(expected > 1e-6)) continue;
    for (const VolumeMetrics& m :
         {test::evaluated(polytope, cylinder, X, Engine::kLines).total,
          test::evaluated(cylinder, polytope, X.inverse(), Engine::kLines).total}) {
      EXPECT_NEAR(m.volume, expected, m.volume_error + 1e-5 * expected) << i;
      EXPECT_NEAR(m.volume, expected, 1e-3 * expected) << i;
    }
  }
}

// Faces of both pass through the origin of both frames: a place there is on them, though it is no
// distance from anywhere.
TEST(Lines, FacesThroughTheOriginOfBothFrames) {
  const Shape wedge = ConvexPolytope({{0.05, 0.15, 0.0},
                                      {0.0, 0.15, 0.0},
                                      {0.05, 0.05, 0.05},
                                      {-0.05, 0.05, 0.0},
                                      {0.0, 0.0, 0.1},
                                      {0.0, 0.0, -0.1},
                                      {0.05, 0.1, 0.0},
                                      {0.0, 0.1, 0.05}});
  const Shape cone =
      Frustum({.bottom_radius = 0.0989391454639759, .top_radius = 0.05, .half_length = 0.15});
  static OctreeScratch scratch;
  Interference bounded;
  octree_interference(wedge, cone, Pose{}, {}, scratch, bounded);
  ASSERT_GT(bounded.total.volume, 4e-4);
  for (const double off : {0.0, 1e-15, -1e-15, 1e-10}) {
    const Pose X{Mat3::Identity(), Vec3::Constant(off)};
    for (const VolumeMetrics& m :
         {test::evaluated(wedge, cone, X, Engine::kLines).total,
          test::evaluated(cone, wedge, X.inverse(), Engine::kLines).total}) {
      EXPECT_NEAR(m.volume, bounded.total.volume, bounded.total.volume_error) << off;
    }
  }
}

}  // namespace
}  // namespace volcontact::convex_sections_test
