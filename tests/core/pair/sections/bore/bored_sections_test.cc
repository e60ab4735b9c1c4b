// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/bore/bored_sections.h"

#include <gtest/gtest.h>

#include "core/support/csg_solids.h"
#include "core/support/evaluated.h"
#include "core/support/gradient.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"
#include "volcontact/pair/interference.h"
#include "volcontact/pair/octree/octree.h"
#include "volcontact/pair/quadrature/gauss.h"
#include "volcontact/shape/csg/csg_metrics.h"

namespace volcontact::bored_sections_test {
namespace {

using test::evaluated;

constexpr double kBore = 0.01;  // radius [m]
constexpr double kHalf = 0.02;  // half height of the block

// A block with a bore along z.
Shape bored_block() {
  return Csg(Csg::Operation::kDifference, Csg(Box({.half_sizes = {0.03, 0.03, kHalf}})),
             Csg(Cylinder({.radius = kBore, .half_length = 0.03})));
}

// Area of a disc of radius r outside of a disc of radius R whose center is d away.
double lune(double r, double R, double d) {
  if (d + r <= R) return 0.0;
  if (d >= r + R) return kPi * r * r;
  if (d + R <= r) return kPi * (r * r - R * R);
  const double a = std::acos((d * d + r * r - R * R) / (2.0 * d * r));
  const double b = std::acos((d * d + R * R - r * r) / (2.0 * d * R));
  return kPi * r * r -
         (r * r * (a - 0.5 * std::sin(2.0 * a)) + R * R * (b - 0.5 * std::sin(2.0 * b)));
}

TEST(BoredLines, AShiftedPegIsALuneTimesTheHeight) {
  for (double clearance : {3e-4, 2e-5}) {
    const double r = kBore - clearance;
    const Shape peg = Cylinder({.radius = r, .half_length = 0.05});
    for (double depth : {1e-6, 1e-5, 3e-4, 3e-3}) {
      const double shift = clearance + depth;
      const Pose X{Mat3::Identity(), {shift, 0.0, 0.004}};
      const Interference out = evaluated(bored_block(), peg, X);
      EXPECT_EQ(out.engine, Engine::kLines);
      ASSERT_EQ(out.sites.size(), 1u);
      const double expected = lune(r, kBore, shift) * 2.0 * kHalf;
      EXPECT_NEAR(out.total.volume, expected, 5e-6 * expected) << "depth " << depth;
      EXPECT_NEAR(out.total.depth, depth, 1e-2 * depth);
      EXPECT_GE(out.total.normal().dot(Vec3::UnitX()), 1.0 - 1e-9);  // the block is pushed along
    }
  }
}

// Slices across the axis are lunes.
TEST(BoredLines, ABallAtTheWallIsTheSumOfItsSlices) {
  const double r = 0.008;
  for (double depth : {1e-6, 2e-5, 5e-4}) {
    const double shift = kBore - r + depth, reach = std::sqrt(2.0 * r * depth);
    const Pose X{Mat3::Identity(), {0.6 * shift, 0.8 * shift, 0.003}};
    double expected = 0.0;
    constexpr int kSlices = 20000;
    for (int i = 0; i < kSlices; ++i) {
      const double z = reach * (2.0 * (i + 0.5) / kSlices - 1.0);
      expected += lune(std::sqrt(r * r - z * z), kBore, shift) * 2.0 * reach / kSlices;
    }
    const Interference out = evaluated(bored_block(), Sphere({.radius = r}), X);
    EXPECT_EQ(out.engine, Engine::kLines);
    EXPECT_NEAR(out.total.volume, expected, 2e-5 * expected) << "depth " << depth;
    EXPECT_TRUE(out.total.normal().isApprox(Vec3(0.6, 0.8, 0.0), 1e-6));
  }
}

// The ring between the wall and where the ball leaves the top is a solid of revolution.
TEST(BoredLines, DepthMomentIsTheWorkOfTheVolume) {
  // int V d(depth) along the push, in Gauss's five places of each of eight parts.
  const Shape ball = Sphere({.radius = 0.001});
  const auto pushed = [&](double depth) {
    return evaluated(bored_block(), ball, {Mat3::Identity(), {kBore - 0.001 + depth, 0.0, 0.003}});
  };
  constexpr double kDepth = 1e-4;  // a tenth of the radius
  constexpr int kParts = 8;
  double work = 0.0;
  for (int part = 0; part < kParts; ++part) {
    for (int i = 0; i < 5; ++i) {
      const double depth = kDepth * (part + GaussRule<5>::kNodes[i]) / kParts;
      work += GaussRule<5>::kWeights[i] * kDepth / kParts * pushed(depth).total.volume;
    }
  }
  EXPECT_NEAR(pushed(kDepth).total.depth_moment, work, 2e-6 * work);
}

TEST(BoredLines, ABallOnTheRimIsARing) {
  const double r = 0.015;
  for (double depth : {1e-6, 1e-4, 2e-3}) {
    const double z = kHalf + std::sqrt(r * r - kBore * kBore) - depth;  // of its center
    const auto primitive = [&](double rho) {  // of 2 pi rho (top - ball's lower face)
      return kPi * rho * rho * (kHalf - z) - 2.0 / 3.0 * kPi * std::pow(r * r - rho * rho, 1.5);
    };
    const double outer = std::sqrt(r * r - (z - kHalf) * (z - kHalf));
    const double expected = primitive(outer) - primitive(kBore);
    const Interference out =
        evaluated(bored_block(), Sphere({.radius = r}), {Mat3::Identity(), {0.0, 0.0, z}});
    EXPECT_EQ(out.engine, Engine::kLines);
    EXPECT_EQ(out.sites.size(), 1u);
    EXPECT_NEAR(out.total.volume, expected, 1e-8 * expected + 1e-20) << "depth " << depth;
    EXPECT_GT(out.total.area_vector.z(), 0.99 * out.total.area_vector.norm());
  }
}

TEST(BoredLines, ATiltedPegTouchesInTwoSites) {
  const Shape block = bored_block();
  for (double clearance : {3e-4, 2e-5}) {
    const Shape peg = Cylinder({.radius = kBore - clearance, .half_length = 0.04});
    const double tilt = 1.5 * clearance / kHalf;
    const Pose X{test::turn({1.0, 0.2, 0.0}, tilt), Vec3::Zero()};
    const Interference out = evaluated(block, peg, X);
    EXPECT_EQ(out.engine, Engine::kLines);
    ASSERT_EQ(out.sites.size(), 2u);
    EXPECT_NEAR(out.sites[0].volume, out.sites[1].volume, 1e-6 * out.total.volume);
    EXPECT_LE((out.sites[0].centroid + out.sites[1].centroid).norm(), 1e-6 * kHalf);
    EXPECT_LE(out.total.area_vector.norm(), 1e-6 * out.total.area);
    EXPECT_GT(out.sites[0].area_vector.norm(), 0.9 * out.sites[0].area);
    const Interference octree = evaluated(block, peg, X, Engine::kOctree, 1e-2);
    EXPECT_NEAR(out.total.volume, octree.total.volume, octree.total.volume_error);
    EXPECT_EQ(octree.sites.size(), 2u);
    const Interference mirrored = evaluated(peg, block, X.inverse());
    EXPECT_NEAR(mirrored.total.volume, out.total.volume, 1e-5 * out.total.volume);
    EXPECT_EQ(mirrored.sites.size(), 2u);
  }
}

TEST(BoredLines, AreaVectorAndMomentAreTheGradientOfVolume) {
  const Shape block = bored_block();
  const Shape peg = Cylinder({.radius = kBore - 3e-4, .half_length = 0.04});
  const Pose X{test::turn({1.0, 0.2, 0.0}, 0.025), {2e-4, -1e-4, 0.003}};
  const VolumeMetrics m = evaluated(block, peg, X, Engine::kAuto, 1e-6).total;
  const auto volume = [&](const Pose& X_AB) {
    return evaluated(block, peg, X_AB, Engine::kAuto, 1e-6).total.volume;
  };
  const test::Gradient g = test::gradient_of_A(volume, X, 1e-5);
  EXPECT_LE((g.shift - m.area_vector).norm(), 1e-3 * m.area);
  EXPECT_LE((g.turn - m.area_moment).norm(), 1e-3 * m.area * kHalf);
}

// A tilted peg that is pushed aside: one of two sites leaves, and comes back.
TEST(BoredLines, VolumeIsContinuousWhileASiteLeavesAndComesBack) {
  const Shape block = bored_block();
  const Shape peg = Cylinder({.radius = kBore - 2e-5, .half_length = 0.04});
  const double tilt = 2e-3;
  double before = 0.0, largest = 0.0;
  std::size_t most = 0, fewest = 10;
  constexpr int kSteps = 400;
  for (int i = 0; i <= kSteps; ++i) {
    const double shift = 1e-4 * (2.0 * i / kSteps - 1.0);
    const Interference out =
        evaluated(block, peg, {test::turn(Vec3::UnitX(), tilt), {0.0, shift, 0.0}});
    EXPECT_EQ(out.engine, Engine::kLines);
    if (i > 0) largest = std::max(largest, std::abs(out.total.volume - before));
    before = out.total.volume;
    most = std::max(most, out.sites.size());
    fewest = std::min(fewest, out.sites.size());
  }
  EXPECT_EQ(most, 2u);
  EXPECT_EQ(fewest, 1u);
  // A step of 0.5 um sweeps no more than that over the projected wall, 2 R h.
  EXPECT_LE(largest, 5.1e-7 * 2.0 * kBore * 2.0 * kHalf);
}

// A bar that lies beside the bore, with its middle farther along: no plane across the way to the
// middle keeps the two apart.
TEST(BoredLines, ABodyBesideTheBoreIsAsOnAWholeBlock) {
  const Shape bar = Box({.half_sizes = {0.03, 0.004, 0.004}});
  const Shape whole = Box({.half_sizes = {0.03, 0.03, kHalf}});
  const Mat3 turned = test::turn(Vec3::UnitZ(), 0.75);
  const Pose X{turned, turned * Vec3(0.02, -0.0165, kHalf + 0.0035)};
  const Interference out = evaluated(bored_block(), bar, X);
  EXPECT_EQ(out.engine, Engine::kLines);
  ASSERT_EQ(out.sites.size(), 1u);
  const VolumeMetrics expected = evaluated(whole, bar, X, Engine::kClip).total;
  EXPECT_NEAR(out.total.volume, expected.volume, 1e-6 * expected.volume);
  EXPECT_TRUE(out.total.area_vector.isApprox(expected.area_vector, 1e-6));
}

constexpr double kTilts[] = {0.0, 1e-15, 1e-12, 1e-8, 1e-7, 1e-6};  // [rad]

// The tube of the capsule runs along the columns then, or nearly. Against the lengths of lines
// through both solids, upright; a tilt moves no face by more than its angle times 0.4 m.
TEST(BoredLines, ACapsuleThatStandsInABlockBesideTheBore) {
  using namespace testing;
  const Csg bored = box(.3, .3, .2) - tube(.15, .4);
  const Csg counterbored = box(.3, .3, .2) - tube(.1, .4) - tube(.2, .1, at(0, 0, .15));
  struct Case {
    Csg block;
    double radius;
    Vec3 place;
  };
  const Case cases[] = {{bored, .2, {.1, 0, .2}},
                        {bored, .15, {.05, 0, .1}},
                        {bored, .1, {.2, .1, -.1}},
                        {counterbored, .2, {.1, 0, .2}},
                        {counterbored, .15, {0, .05, 0}}};
  const int kEvery = test::cases(1, 8);
  for (std::size_t i = 0; i < std::size(cases); i += kEvery) {
    const auto& [block, radius, place] = cases[i];
    const Capsule pill({.radius = radius, .half_length = .2});
    const VolumeMetrics exact =
        csg_metrics_by_lines(block & Csg(pill, at(place.x(), place.y(), place.z())));
    for (const double tilt : kTilts) {
      const Pose X = turned({1, .3, 0}, tilt, place);
      for (const bool swap : {false, true}) {
        const VolumeMetrics m = swap ? transformed(evaluated(pill, block, X.inverse()).total, X)
                                     : evaluated(block, pill, X).total;
        EXPECT_EQ(m.status, Status::kOk);
        EXPECT_NEAR(m.volume, exact.volume, 2e-4 * exact.volume + 0.4 * tilt) << "tilt " << tilt;
        EXPECT_LE((m.centroid - exact.centroid).norm(), 1e-3 * radius + tilt);
      }
    }
  }
}

// Wall on wall: no volume, wherever the two are and however they are turned.
TEST(BoredLines, WhatFitsABoreExactlyTouchesNothing) {
  using namespace testing;
  const Csg block = box(.3, .3, .2) - tube(.15, .4), pipe = tube(.3, .3) - tube(.2, .4);
  test::Random random(3);
  for (int i = 0; i < test::cases(20, 4); ++i) {
    const Pose X = i == 0 ? Pose{} : random.pose(.3);
    for (const double z : {0.0, .05, .2}) {
      for (const auto& [hollow, radius] : {std::pair{block, .15}, {pipe, .2}}) {
        const Shape fits[] = {
            Capsule({.radius = radius, .half_length = .2}),
            Cylinder({.radius = radius, .half_length = .25}), Sphere({.radius = radius}),
            Frustum({.bottom_radius = radius, .top_radius = .1, .half_length = .1})};
        for (const Shape& fit : fits) {
          const Interference out = evaluated(hollow.posed(X), fit, X * at(0, 0, z));
          EXPECT_LE(out.total.volume, 1e-15);
          EXPECT_EQ(out.total.status, Status::kOk);
        }
      }
    }
  }
}

// A half-space against a pipe that lies on it: a segment of the outer circle less one of the bore,
// which begins where the plane touches the bore.
TEST(BoredLines, APlaneThatTouchesABoreCutsASegment) {
  using namespace testing;
  const Csg pipe = tube(.3, .3) - tube(.2, .4);
  const auto segment = [](double r, double h) {
    return h < r ? r * r * std::acos(h / r) - h * std::sqrt(r * r - h * h) : 0.0;
  };
  for (const double beyond : {0.0, 1e-15, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4}) {
    for (const double side : {-1.0, 1.0}) {
      const double h = .2 + side * beyond;
      const Pose X = turned(Vec3::UnitX(), .5 * kPi, {0, 0, h});
      const double expected = .6 * (segment(.3, h) - segment(.2, h));
      const Interference out = evaluated(HalfSpace(), pipe, X);
      EXPECT_NEAR(out.total.volume, expected, 1e-5 * expected) << "beyond " << side * beyond;
      EXPECT_EQ(out.total.status, Status::kOk);
      EXPECT_EQ(out.sites.size(), 1u);
    }
  }
}

// The sum over lines along x through a rod and the wall of a cup at x > 0, between two radii about
// z: midpoints of an even lattice. The rod lies within the height of the wall.
VolumeMetrics by_lines_along_x(const Cylinder::Params& rod, const Pose& X, double inner,
                               double outer) {
  constexpr int kLines = 400;  // each way; twice as many change V by less than 2e-6 of it
  const Vec3 d = X.rotation.transpose() * Vec3::UnitX();
  const double spacing = 2.0 * 1.01 * rod.radius / kLines;
  VolumeMetrics sum;
  for (int i = 0; i < kLines; ++i) {
    for (int j = 0; j < kLines; ++j) {
      const double y = X.translation.y() + (i + 0.5 - 0.5 * kLines) * spacing;
      const double z = X.translation.z() + (j + 0.5 - 0.5 * kLines) * spacing;
      const Vec3 p = X.inverse() * Vec3(0.0, y, z);
      double ends[2] = {(-rod.half_length - p.z()) / d.z(), (rod.half_length - p.z()) / d.z()};
      if (ends[0] > ends[1]) std::swap(ends[0], ends[1]);
      const double aa = d.head<2>().squaredNorm(), ab = p.head<2>().dot(d.head<2>());
      const double bb = p.head<2>().squaredNorm() - rod.radius * rod.radius;
      if (aa > 0.0) {
        const double root = ab * ab - aa * bb;
        if (root < 0.0) continue;
        ends[0] = std::max(ends[0], (-ab - std::sqrt(root)) / aa);
        ends[1] = std::min(ends[1], (-ab + std::sqrt(root)) / aa);
      } else if (bb > 0.0) {
        continue;
      }
      const double from = std::max(ends[0], std::sqrt(std::max(0.0, inner * inner - y * y)));
      const double to = std::min(ends[1], std::sqrt(outer * outer - y * y));
      if (from >= to) continue;
      const double volume = (to - from) * spacing * spacing;
      sum.volume += volume;
      sum.centroid += volume * Vec3(0.5 * (from + to), y, z);
    }
  }
  sum.centroid /= sum.volume;
  return sum;
}

// A rod across the bore whose end face lies in it: its corners reach past the ends of the lobe, by
// little.
TEST(BoredLines, CornersThatReachPastALobe) {
  using namespace testing;
  const Csg cup = tube(.3, .3) - tube(.2, .3, at(0, 0, .1));
  for (const double end : {.06, .1, .14}) {
    for (const double tilt : {0.0, 1e-4}) {
      const Cylinder::Params size{.radius = .2, .half_length = .1};
      const Cylinder rod(size);
      Pose X = at(end + .1, 0, .05);
      X.rotation = Mat3(0, 0, 1, 1, 0, 0, 0, 1, 0);
      X.rotation = X.rotation * test::turn(Vec3::UnitX(), tilt);
      const VolumeMetrics exact = by_lines_along_x(size, X, .2, .3);
      const Interference out = evaluated(cup, rod, X);
      EXPECT_NEAR(out.total.volume, exact.volume, 1e-3 * exact.volume) << end << " " << tilt;
      EXPECT_LE((out.total.centroid - exact.centroid).norm(), 1e-3 * size.radius);
    }
  }
}

// What two faces along the bore leave of a ball about its axis: half-planes through the axis meet
// them edge on, and the place where a face takes over from the ball is a break.
TEST(BoredLines, ABallCutByFacesAlongTheBore) {
  const double r = 0.15, half = 0.1, bore = 0.05, high = std::sqrt(r * r - bore * bore);
  const Shape block = Csg(Csg::Operation::kDifference, Csg(Box({.half_sizes = {half, 0.3, 0.4}})),
                          Csg(Cylinder({.radius = bore, .half_length = 0.5})));
  const Shape ball = Sphere({.radius = r});
  const double slab = 2.0 * kPi * (r * r * half - half * half * half / 3.0);
  const double core = 4.0 / 3.0 * kPi * (r * r * r - high * high * high);
  for (const double turn : {0.0, 0.6, 2.5}) {
    const Pose X{rotation_about(Vec3::UnitY(), turn), Vec3::Zero()};
    for (const bool ball_first : {false, true}) {
      const Interference out =
          ball_first ? evaluated(ball, block, X) : evaluated(block, ball, X.inverse());
      EXPECT_EQ(out.engine, Engine::kLines);
      EXPECT_LE(std::abs(out.total.volume - (slab - core)), out.total.volume_error)
          << "turn " << turn;
    }
  }
}

TEST(BoredLines, AFreePegTouchesNothing) {
  const Shape peg = Cylinder({.radius = kBore - 2e-5, .half_length = 0.04});
  for (double shift : {0.0, 1e-5, 1.9e-5}) {
    const Interference out = evaluated(bored_block(), peg, {Mat3::Identity(), {shift, 0.0, 0.0}});
    EXPECT_EQ(out.engine, Engine::kLines);
    EXPECT_EQ(out.total.volume, 0.0);
    EXPECT_TRUE(out.sites.empty());
  }
}

// Seen from the apex of a chamfer the outline of what lies round it is a circle about the axis,
// from wherever the search for it begins.
TEST(BoredLines, ABallOnTheAxisOfAChamferedHole) {
  const double half = 0.05, bore = 0.05, wide = 0.07, start = 0.03, radius = 0.1;
  const Shape block = Csg(
      Csg::Operation::kDifference,
      Csg(Csg::Operation::kDifference, Csg(Box({.half_sizes = {0.309, 0.509, half}})),
          Csg(Cylinder({.radius = bore, .half_length = 0.1}))),
      Csg(Frustum({.bottom_radius = bore, .top_radius = wide, .half_length = 0.5 * (half - start)}))
          .posed({Mat3::Identity(), {0.0, 0.0, 0.5 * (half + start)}}));
  double expected = 0.0;
  constexpr int kSlices = 200000;
  for (int i = 0; i < kSlices; ++i) {
    const double z = -half + 2.0 * half * (i + 0.5) / kSlices;
    const double hole = z < start ? bore : bore + (wide - bore) * (z - start) / (half - start);
    const double ball2 = radius * radius - (z - half) * (z - half);
    expected += std::max(0.0, ball2 - hole * hole) * kPi * 2.0 * half / kSlices;
  }
  const Shape ball = Sphere({.radius = radius});
  for (int axis = 0; axis < 3; ++axis) {
    for (int quarter = 0; quarter < 8; ++quarter) {
      const Pose X{rotation_about(Vec3::Unit(axis), 0.25 * kPi * quarter), {0.0, 0.0, half}};
      for (const VolumeMetrics& m :
           {evaluated(block, ball, X).total, evaluated(ball, block, X.inverse()).total}) {
        EXPECT_NEAR(m.volume, expected, m.volume_error + 1e-6 * expected) << axis << " " << quarter;
      }
    }
  }
}

// A capsule across a bore that it is a little too thick for: symmetric, so that area vectors cancel
// whatever is overlooked.
TEST(BoredLines, ACapsuleAcrossABore) {
  const double bore = 0.045, radius = 0.05, half = 0.05, outer = 0.222;
  const Shape pipe =
      Csg(Csg::Operation::kDifference, Csg(Cylinder({.radius = outer, .half_length = 0.4})),
          Csg(Cylinder({.radius = bore, .half_length = 0.8})));
  const Shape capsule = Capsule({.radius = radius, .half_length = half});
  // In polar coordinates about the bore; y is along it, x and z across, the capsule along z.
  double expected = 0.0;
  constexpr int kSteps = 2000;
  const double reach = half + radius;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = 2.0 * kPi * (i + 0.5) / kSteps;
    for (int k = 0; k < kSteps; ++k) {
      const double rho = bore + (reach - bore) * (k + 0.5) / kSteps;
      const double x = rho * std::cos(angle);
      const double beyond = std::max(0.0, std::abs(rho * std::sin(angle)) - half);
      const double square = radius * radius - x * x - beyond * beyond;
      if (square > 0.0) expected += 2.0 * std::sqrt(square) * rho;
    }
  }
  expected *= 2.0 * kPi / kSteps * (reach - bore) / kSteps;
  // the capsule's axis across that of the pipe
  Mat3 across = Mat3::with_columns(Vec3::UnitX(), Vec3::UnitZ(), -Vec3::UnitY());
  for (const double off : {0.0, 1e-10, 1e-6}) {
    for (const double turn : {0.0, 0.3, 0.5 * kPi}) {
      const Mat3 round = rotation_about(Vec3::UnitZ(), turn);
      const Pose X{round * across, {off, 0.0, 0.06}};
      for (const VolumeMetrics& m :
           {evaluated(pipe, capsule, X).total, evaluated(capsule, pipe, X.inverse()).total}) {
        EXPECT_NEAR(m.volume, expected, m.volume_error + 2e-5 * expected) << off << " " << turn;
      }
    }
  }
}

// The end of a cone reaches the wall of a bore with two corners, and its middle just does, or not:
// two lobes, of which one place of the outline is beside both.
TEST(BoredLines, AnEndWithTwoCornersAtTheWall) {
  const Shape block =
      Csg(Csg::Operation::kDifference, Csg(Box({.half_sizes = {0.47, 0.62, 0.205}})),
          Csg(Cylinder({.radius = 0.4, .half_length = 0.51})));
  const Shape cone = Frustum({.bottom_radius = 0.25, .top_radius = 0.05, .half_length = 0.25});
  Mat3 across = Mat3::with_columns(-Vec3::UnitZ(), Vec3::UnitY(), Vec3::UnitX());
  static OctreeScratch scratch;
  for (const double beyond : {0.0, 1e-4, -1e-4, -1e-3}) {
    const Pose X{across.transpose(), {0.045, 0.0, -0.15 - beyond}};
    Interference bounded;
    octree_interference(cone, block, X, {}, scratch, bounded);
    ASSERT_GT(bounded.total.volume, 1e-6);
    for (const VolumeMetrics& m :
         {evaluated(cone, block, X).total, evaluated(block, cone, X.inverse()).total}) {
      EXPECT_NEAR(m.volume, bounded.total.volume, bounded.total.volume_error + m.volume_error)
          << beyond;
    }
  }
}

}  // namespace
}  // namespace volcontact::bored_sections_test
