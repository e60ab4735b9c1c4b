// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/radial/composed_columns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/support/csg_solids.h"
#include "core/support/evaluated.h"
#include "core/support/gradient.h"
#include "core/support/matchers.h"
#include "core/support/meshes.h"
#include "core/support/overlapping.h"
#include "core/support/random_shapes.h"
#include "core/support/sanitized.h"

namespace volcontact::composed_columns_test {
namespace {

using test::box_soup;
using test::evaluated;
using test::mesh_of;
using test::overlapping;
using test::Random;
using test::shifted;
using test::Soup;
namespace solids = volcontact::testing;

constexpr double kRadius = 4e-3, kHalfLength = 0.015, kHalfPlate = 0.01;

// A prism of n sides about z, its corners on a circle.
Soup prism(double radius, double half_length, int n, int rows) {
  Soup soup;
  for (int k = 0; k <= rows; ++k) {
    for (int i = 0; i < n; ++i) {
      const double angle = 2.0 * kPi * i / n;
      soup.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle),
                               half_length * (2.0 * k / rows - 1.0)});
    }
  }
  for (int k = 0; k < rows; ++k) {
    for (int i = 0; i < n; ++i) {
      const int a = k * n + i, b = k * n + (i + 1) % n;
      soup.triangles.push_back({a, b, b + n});
      soup.triangles.push_back({a, b + n, a + n});
    }
  }
  const int bottom = static_cast<int>(soup.vertices.size()), first = rows * n;
  soup.vertices.push_back({0.0, 0.0, -half_length});
  soup.vertices.push_back({0.0, 0.0, half_length});
  for (int i = 0; i < n; ++i) {
    soup.triangles.push_back({bottom, (i + 1) % n, i});
    soup.triangles.push_back({bottom + 1, first + i, first + (i + 1) % n});
  }
  return soup;
}

Csg bored_plate(double radius) {
  return solids::box(.02, .02, kHalfPlate) - solids::tube(radius, .05);
}

// Area of a regular polygon, moved along x, outside of a circle: by a fine sum over its edges.
double area_outside(double corner_radius, int n, double x, double circle) {
  constexpr int kSteps = 4000;
  double area = 0.0;
  for (int i = 0; i < n; ++i) {
    const double a = 2.0 * kPi * i / n, b = 2.0 * kPi * (i + 1) / n;
    const Vec3 p(x + corner_radius * std::cos(a), corner_radius * std::sin(a), 0.0);
    const Vec3 q(x + corner_radius * std::cos(b), corner_radius * std::sin(b), 0.0);
    const Vec3 normal((q - p).y(), -(q - p).x(), 0.0);
    for (int k = 0; k < kSteps; ++k) {
      const Vec3 y = p + (k + 0.5) / kSteps * (q - p);
      const double r2 = y.squaredNorm();
      if (r2 > circle * circle) area += 0.5 * (1.0 - circle * circle / r2) * y.dot(normal) / kSteps;
    }
  }
  return area;
}

TEST(ComposedColumns, APegAgainstTheWallOfABoreIsALune) {
  for (const double clearance : {1e-4, 1e-5}) {
    const Csg plate = bored_plate(kRadius + clearance);
    for (const int n : {40, 101}) {
      const Mesh peg = mesh_of(prism(kRadius, kHalfLength, n, 3));
      for (const double depth : {0.1 * clearance, clearance}) {
        const double x = clearance + depth;
        const double area = area_outside(kRadius, n, x, kRadius + clearance);
        const Interference out = evaluated(peg, plate, shifted(-x, 0.0, 0.0));
        EXPECT_EQ(out.engine, Engine::kColumns);
        EXPECT_EQ(out.total.status, Status::kOk);
        const double volume = 2.0 * kHalfPlate * area;
        EXPECT_NEAR(out.total.volume, volume, 2e-5 * volume);
        EXPECT_NEAR(out.total.normal().x(), -1.0, 1e-4);
        EXPECT_NEAR(out.total.centroid.z(), 0.0, 1e-6);
        ASSERT_EQ(out.sites.size(), 1u);
      }
    }
  }
}

TEST(ComposedColumns, APegThatIsTooLargePressesAllAround) {
  const double bore = kRadius - 2e-5;
  const int n = 64;
  const Mesh peg = mesh_of(prism(kRadius, kHalfLength, n, 2));
  const Interference out = evaluated(peg, bored_plate(bore), Pose{});
  const double area = 0.5 * n * kRadius * kRadius * std::sin(2.0 * kPi / n) - kPi * bore * bore;
  const double volume = 2.0 * kHalfPlate * area;
  EXPECT_NEAR(out.total.volume, volume, 1e-5 * volume);
  EXPECT_LE(out.total.area_vector.norm(), 1e-6 * out.total.area);
  EXPECT_NEAR(out.total.counter_area, 4.0 * kPi * bore * kHalfPlate, 1e-3 * out.total.counter_area);
  EXPECT_NEAR(out.total.inertia(2, 2), volume * kRadius * kRadius, 0.02 * out.total.inertia(2, 2));
}

TEST(ComposedColumns, ATiltedPegTouchesAtTwoPlaces) {
  const double clearance = 1e-4, tilt = 0.015;
  const Mesh peg = mesh_of(prism(kRadius, kHalfLength, 64, 4));
  const Pose X_AB{test::turn(Vec3::UnitY(), tilt), Vec3::Zero()};
  const Interference out = evaluated(peg, bored_plate(kRadius + clearance), X_AB);
  EXPECT_EQ(out.engine, Engine::kColumns);
  ASSERT_EQ(out.sites.size(), 2u);
  const VolumeMetrics &one = out.sites[0], &two = out.sites[1];
  EXPECT_NEAR(one.volume, two.volume, 1e-3 * one.volume);
  EXPECT_LE((one.centroid + two.centroid).norm(), 1e-4 * one.centroid.norm());
  EXPECT_GT(one.centroid.norm(), 0.9 * kHalfPlate);
  EXPECT_LT(one.normal().dot(two.normal()), -0.99);
}

// A box is served by lines as well, on other ways altogether.
TEST(ComposedColumns, AMeshOfABoxMeetsComposedSolidsAsTheBox) {
  const Vec3 half(0.12, 0.04, 0.3);
  const Box box({.half_sizes = half});
  Random random(1);
  int kinds = 0;
  for (const solids::NamedSolid& kind : solids::kinds_of_solids()) {
    if (!has_columns_pieces(kind.solid)) continue;
    ++kinds;
    int compared = 0, served = 0;
    for (int i = 0; i < test::cases(10, 1); ++i) {
      const Mesh mesh = mesh_of(box_soup(half, 1 + 3 * (i % 2)));
      const Pose X_AB =
          overlapping(box, kind.solid, random, std::pow(10.0, random.uniform(-3.5, -1.0)));
      const Interference expected = evaluated(box, kind.solid, X_AB, Engine::kLines, 1e-5);
      if (!expected.total.touching() || expected.engine == Engine::kOctree) continue;
      ++compared;
      const Interference out = evaluated(mesh, kind.solid, X_AB);
      if (out.engine != Engine::kColumns) continue;
      ++served;
      const VolumeMetrics &m = out.total, &e = expected.total;
      EXPECT_NEAR(m.volume, e.volume, 5e-3 * e.volume + 2.0 * m.volume_error) << kind.name;
      EXPECT_LE((m.area_vector - e.area_vector).norm(), 5e-3 * e.area) << kind.name;
      EXPECT_LE((m.centroid - e.centroid).norm(), 0.02 * std::cbrt(e.volume)) << kind.name;
    }
    EXPECT_GE(compared, test::cases(4, 0)) << kind.name;
    EXPECT_GE(2 * served, test::cases(compared, 0)) << kind.name;
  }
  EXPECT_GE(kinds, 15);
}

TEST(ComposedColumns, APolytopeInABoreIsServedToo) {
  const double clearance = 1e-4, x = 1.5e-4;
  const int n = 64;
  const ConvexPolytope peg(prism(kRadius, kHalfLength, n, 1).vertices);
  const Csg plate = bored_plate(kRadius + clearance);
  const Interference out = evaluated(peg, plate, shifted(-x, 0.0, 0.0));
  EXPECT_EQ(out.engine, Engine::kColumns);
  const double volume = 2.0 * kHalfPlate * area_outside(kRadius, n, x, kRadius + clearance);
  EXPECT_NEAR(out.total.volume, volume, 1e-4 * volume);
  const VolumeMetrics mirrored = evaluated(plate, peg, shifted(x, 0.0, 0.0)).total;
  EXPECT_NEAR(mirrored.volume, out.total.volume, 1e-12 * volume);
}

TEST(ComposedColumns, APlateOnABoredBlockLeavesTheHoleOut) {
  const double r = .05, depth = 1e-3;
  const Csg block = solids::box(.2, .2, .1) - solids::tube(r, .5);
  for (const double half : {.15, .3}) {
    const Mesh plate = mesh_of(box_soup(Vec3(half, half, .05), 5));
    const Interference out = evaluated(plate, block, shifted(0.0, 0.0, -.15 + depth));
    const double side = 2.0 * std::min(half, .2);
    const double volume = depth * (side * side - kPi * r * r);
    EXPECT_EQ(out.engine, Engine::kColumns);
    EXPECT_NEAR(out.total.volume, volume, 1e-4 * volume);
    EXPECT_NEAR(out.total.depth, depth, 0.02 * depth);
    EXPECT_NEAR(out.total.depth_moment, 0.5 * volume * depth, 1e-3 * volume * depth);
    EXPECT_NEAR(out.total.normal().z(), 1.0, 1e-6);
  }
}

TEST(ComposedColumns, FourPinsInFourBoresAreFourSites) {
  Csg plate = solids::box(.1, .1, .02);
  Soup pins = box_soup(Vec3(.09, .09, .01)).moved(shifted(0.0, 0.0, .04));
  const double r = 8e-3, clearance = 1e-4;
  for (const double x : {-.06, .06}) {
    for (const double y : {-.06, .06}) {
      plate = plate - solids::tube(r + clearance, .05, solids::at(x, y, 0.0));
      pins = pins.with(prism(r, .025, 48, 2).moved(shifted(x, y, 0.0)));
    }
  }
  const Interference out = evaluated(mesh_of(pins), plate, shifted(-2.0 * clearance, 0.0, 0.0));
  EXPECT_EQ(out.engine, Engine::kColumns);
  ASSERT_EQ(out.sites.size(), 4u);
  const double volume = .04 * area_outside(r, 48, 2.0 * clearance, r + clearance);
  for (const VolumeMetrics& site : out.sites) EXPECT_NEAR(site.volume, volume, 1e-4 * volume);
}

TEST(ComposedColumns, ABoxInAPocketTouchesAcrossItsSeamsOnce) {
  const Csg block = solids::box(.2, .2, .1) - solids::box(.1, .1, .05, solids::at(0, 0, .08));
  const Mesh box = mesh_of(box_soup(Vec3(.0995, .0995, .05), 2));
  // Into the floor of the pocket, and nothing else.
  const Interference out = evaluated(box, block, shifted(0.0, 0.0, -.03 - .05 + 1e-3));
  ASSERT_EQ(out.sites.size(), 1u);
  EXPECT_NEAR(out.total.volume, 1e-3 * .199 * .199, 1e-9 * out.total.volume);
}

TEST(ComposedColumns, TheWholeOfABodyIsContained) {
  const Csg plate = bored_plate(kRadius);
  const Mesh chip = mesh_of(box_soup(Vec3::Constant(1e-3), 2));
  const Interference inner = evaluated(chip, plate, shifted(-.01, 0.0, 0.0));
  EXPECT_EQ(inner.total.status, Status::kContained);
  EXPECT_NEAR(inner.total.volume, 8e-9, 1e-12);
  const Mesh around = mesh_of(box_soup(Vec3::Constant(.05), 3));
  const Interference outer = evaluated(around, plate, Pose{});
  const double volume = 2.0 * kHalfPlate * (.04 * .04 - kPi * kRadius * kRadius);
  EXPECT_NEAR(outer.total.volume, volume, 1e-6 * volume);
  EXPECT_EQ(evaluated(chip, plate, Pose{}).total.volume, 0.0);
}

// The surface of the overlap is closed: each body's share of it is no smaller than |S|.
TEST(ComposedColumns, NoSurfaceIsSmallerThanItsAreaVector) {
  Random random(3);
  const ConvexPolytope gem = test::random_polytope(18, random);
  const Csg block = testing::box(.8, .8, .5) - testing::tube(.3, 1.) -
                    testing::tube(.5, .4, testing::at(0, 0, .6));
  const int kPoses = test::cases(3000, 300, 50);
  int served = 0;
  for (int k = 0; k < kPoses; ++k) {
    const Pose X_AB = random.pose(1.2);
    const Interference out = evaluated(gem, block, X_AB);
    if (out.engine != Engine::kColumns || !out.total.touching()) continue;
    ++served;
    for (const VolumeMetrics& m : out.sites) {
      EXPECT_LE(m.area_vector.norm(), (1.0 + 1e-3) * std::min(m.area, m.counter_area)) << k;
    }
  }
  EXPECT_GT(served, kPoses / 6);
}

// A polytope that holds much of a rim. Two rules on its large triangles once agreed on a wrong sum,
// which came and went within a hair of a motion.
TEST(ComposedColumns, RimsMakeNoSteps) {
  Random random(3);
  std::vector<Vec3> points;
  for (int i = 0; i < 18; ++i) points.push_back(.4 * random.direction());
  const ConvexPolytope gem(points);
  const Csg block = solids::box(.4, .4, .25) - solids::tube(.15, .5) -
                    solids::tube(.25, .2, solids::at(0, 0, .3));
  Pose X_AB;
  X_AB.rotation = Mat3(-0.96530409964414177, 0.21508810072440673, -0.14807128059478747,
                       -0.19299459742893238, -0.96961990640229434, -0.15030077335679348,
                       -0.17590076910990796, -0.11650899551182019, 0.97748891215776457);
  std::vector<double> volumes;
  const int kSteps = test::cases(12, 3);
  for (int k = -kSteps; k <= kSteps; ++k) {
    X_AB.translation = Vec3(-0.0922 + 2e-5 * k, -0.1117, -0.4262);
    const Interference out = evaluated(gem, block, X_AB);
    ASSERT_EQ(out.engine, Engine::kColumns);
    volumes.push_back(out.total.volume);
  }
  for (std::size_t i = 2; i < volumes.size(); ++i) {
    EXPECT_NEAR(volumes[i] - volumes[i - 1], volumes[i - 1] - volumes[i - 2], 2e-5 * volumes[i]);
  }
}

TEST(ComposedColumns, TheAreaVectorIsTheGradientOfTheVolume) {
  const double clearance = 1e-4;
  const Mesh peg = mesh_of(prism(kRadius, kHalfLength, 64, 1));
  const Csg plate = bored_plate(kRadius + clearance);
  const Pose X_AB{test::turn(Vec3(0.2, 1.0, 0.0), 5e-3), Vec3(2e-4, 5e-5, 0.0)};
  const InterferenceOptions options{.tolerance = 1e-6, .engine = Engine::kColumns};
  const VolumeMetrics m = evaluated(peg, plate, X_AB, options).total;
  ASSERT_TRUE(m.touching());
  const auto volume = [&](const Pose& X) { return evaluated(peg, plate, X, options).total.volume; };
  const test::Gradient g = test::gradient_of_A(volume, X_AB, 2e-6);
  EXPECT_LE((g.shift - m.area_vector).norm(), 1e-3 * m.area_vector.norm());
}

// Two bores that run into each other: lines from the wall of one would pass through the other. V is
// that of a plate less the union of two circles; the slab between the two faces of the block goes
// all through it.
TEST(ComposedColumns, BoresThatRunIntoEachOther) {
  const double one = 0.006, other = 0.005, block_half = 0.02;
  for (const double d : {0.004, 0.008, 0.0105}) {
    if (test::kSanitized && d == 0.008) continue;
    const double a = (d * d + one * one - other * other) / (2.0 * d), b = d - a;
    const double common = std::abs(a) < one && std::abs(b) < other
                              ? one * one * std::acos(a / one) - a * std::sqrt(one * one - a * a) +
                                    other * other * std::acos(b / other) -
                                    b * std::sqrt(other * other - b * b)
                              : kPi * other * other;
    const double holes = kPi * (one * one + other * other) - common;
    const Csg block = solids::box(0.1, 0.1, block_half) - solids::tube(one, 0.05) -
                      solids::tube(other, 0.05).posed(shifted(d, 0.0, 0.0));
    for (const double half : {0.02, 0.03}) {
      const double area = 4.0 * half * half - holes;
      for (const double half_height : {0.005, 0.015, 0.05}) {
        std::vector<Vec3> corners;
        for (int i = 0; i < 8; ++i) {
          corners.push_back(Vec3(half, half, half_height).cwiseProduct(corner_signs(i)));
        }
        std::vector<Shape> bodies = {ConvexPolytope(corners)};
        // Of a mesh the octree sees to it, which takes long.
        if (d == 0.008 && half == 0.02)
          bodies.push_back(mesh_of(box_soup({half, half, half_height})));
        for (const Shape& body : bodies) {
          for (const double z : {block_half + half_height - 1e-4, block_half, 0.0}) {
            const double depth =
                std::min(block_half, z + half_height) - std::max(-block_half, z - half_height);
            const Pose X = shifted(0.001, 0.002, z);
            for (const VolumeMetrics& m :
                 {evaluated(block, body, X).total, evaluated(body, block, X.inverse()).total}) {
              EXPECT_NEAR(m.volume, depth * area, m.volume_error + 1e-6 * m.volume)
                  << d << " " << half << " " << half_height << " " << z;
            }
          }
        }
      }
    }
  }
}

// A bar through a plate cuts one bore in half along its axis and holds all of another. Closed form.
TEST(ComposedColumns, ABoreThatTheMeshHoldsWholeIsNoPartOfTheOverlap) {
  constexpr double kBar = 0.006, kWide = 0.007, kOne = 0.002, kOther = 0.0015;
  const Mesh bar = mesh_of(box_soup({kBar, kWide, 0.03}));
  for (const bool held_first : {false, true}) {
    const Csg cut = solids::tube(kOne, .05, solids::at(kBar, 0, 0)),
              held = solids::tube(kOther, .05, solids::at(-.002, .001, 0));
    const Csg plate = held_first ? solids::box(.02, .02, kHalfPlate) - held - cut
                                 : solids::box(.02, .02, kHalfPlate) - cut - held;
    const double area = 4.0 * kBar * kWide - kPi * (0.5 * kOne * kOne + kOther * kOther);
    const double expected = 2.0 * kHalfPlate * area;
    for (const double tilt : {0.0, 1e-13, -1e-13}) {
      const Pose X = solids::turned(Vec3(1, 2, 0), tilt, Vec3::Zero());
      const Interference ab = evaluated(bar, plate, X), ba = evaluated(plate, bar, X.inverse());
      EXPECT_NEAR(ab.total.volume, expected, 1e-5 * expected) << held_first << " " << tilt;
      EXPECT_NEAR(ba.total.volume, expected, 1e-5 * expected) << held_first << " " << tilt;
      EXPECT_EQ(ab.engine, Engine::kColumns);
    }
  }
}

// A part of the overlap of little volume is known to less than the tolerance of its own volume; the
// sum is known well, and the octree, which would follow, is off by more. Lines of the reference.
TEST(ComposedColumns, ASumIsJudgedByItsOwnVolume) {
  const ConvexPolytope a({{-0.28445077809946406, -0.083553231281763, 0.029008739768811822},
                          {-0.17225272273347508, -0.11697026396573278, -0.095506429520302014},
                          {0.34376238143566362, 0.00081886117118630617, -0.025532862553541154},
                          {0.14444008801405275, 0.12956614172177158, -0.071697916001074821},
                          {0.024275644006779822, -0.13527740452421669, -0.10754748755016579},
                          {0.10412503693983567, 0.0078652079561351736, 0.23802234789277857}});
  const double half = 0.084339378337642879;
  const Csg b = solids::tube(0.33689015789923504, half) -
                solids::tube(0.25, half, solids::at(0, 0, 0.065968669041942235));
  Pose X;
  X.rotation = Mat3(0.40478901456709881, 0.91441011241444459, 0.0, 0.91441011241444459,
                    -0.40478901456709881, 0.0, 0.0, 0.0, -1.0);
  X.translation = {-0.31425607419828133, -0.12140056968091492, -0.084339269778138382};
  const VolumeMetrics m = evaluated(a, b, X).total;
  const Vec3 expected(-0.065344614, -0.057523054, -0.040730388);  // to 4e-7
  const double gyration = std::sqrt(m.second_moment().trace() / m.volume);
  EXPECT_EQ(m.status, Status::kOk);
  EXPECT_LT((m.centroid - expected).norm(), 1e-4 * gyration);
  EXPECT_NEAR(m.volume, 0.00161872042, 3e-8 + m.volume_error);
}

}  // namespace
}  // namespace volcontact::composed_columns_test
