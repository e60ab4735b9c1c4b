// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/surface_sweep/surface_sweep.h"

#include <gtest/gtest.h>

#include "core/support/csg_solids.h"
#include "core/support/evaluated.h"
#include "core/support/gradient.h"
#include "core/support/sanitized.h"

namespace volcontact::surface_sweep_test {
namespace {

using namespace testing;
using test::evaluated;

Interference sweep(const Shape& a, const Shape& b, const Pose& X_AB, bool served = true) {
  SurfaceSweepScratch scratch;
  Interference out;
  EXPECT_EQ(surface_sweep(a, b, X_AB, {}, scratch, out), served);
  return out;
}

const Csg kPlate = box(.3, .2, .05) - tube(.05, .1, at(.1, 0, 0)) - tube(.04, .1, at(-.1, .05, 0));

// A slab laid over both holes of a plate, which it dips into.
TEST(Shell, ASlabOverTwoHoles) {
  const double area = .4 * .3 - kPi * (.05 * .05 + .04 * .04);
  for (const double depth : {1e-3, 1e-9}) {
    const Interference out =
        sweep(Box({.half_sizes = {.2, .15, .1}}), kPlate, at(0, 0, depth - .15));
    ASSERT_EQ(out.sites.size(), 1u);
    const VolumeMetrics& m = out.total;
    EXPECT_NEAR(m.volume, area * depth, 1e-5 * area * depth);
    EXPECT_NEAR(m.area, area, 2.0 * depth);
    EXPECT_LE((m.normal() - Vec3::UnitZ()).norm(), 1e-6);
    EXPECT_NEAR(m.area_vector.norm(), area, 1e-5 * area);
    EXPECT_NEAR(m.depth, depth, 1e-6 * depth);
    EXPECT_NEAR(m.depth_moment, 0.5 * depth * depth * area, 1e-3 * depth * depth * area);
    EXPECT_LE(m.volume_error, 1e-3 * m.volume);
  }
}

// Columns in a cap are a parabola along every curve of its plane side.
TEST(Shell, DepthMomentOfACap) {
  const double R = .05;
  const Csg bored = box(.3, .3, .1) - tube(.05, .2);
  for (const double depth : {1e-4, 1e-3, 1e-2}) {
    const double d = R - depth;
    const auto primitive = [d](double s) {
      return s * s * (s * s / 4.0 - 2.0 * d * s / 3.0 + d * d / 2.0);
    };
    const double expected = kPi * (primitive(R) - primitive(d));
    const VolumeMetrics m = sweep(bored, Sphere({.radius = R}), at(.15, .1, .1 + d)).total;
    EXPECT_NEAR(m.depth_moment, expected, 2e-2 * expected) << depth;
  }
}

// A capsule that lies across an edge of a box, against columns on a lattice. Those of the sweep
// start at a few places on either side of the edge.
TEST(Shell, DepthMomentOfACapsuleAcrossAnEdge) {
  const Box block({.half_sizes = {.1, .1, .1}});
  test::Random random(3895);
  double mean = 0.0;
  constexpr int kPoses = 25, kLines = 120;
  for (int i = 0; i < kPoses; ++i) {
    const double radius = random.log_uniform(.01, .05), lean = random.uniform(.4, 1.2);
    const double along = random.uniform(0.0, kPi), depth = radius * random.log_uniform(1e-3, .3);
    const Capsule rod({.radius = radius, .half_length = .15});
    const Vec3 out(std::cos(lean), 0, std::sin(lean)), side(-std::sin(lean), 0, std::cos(lean));
    const Vec3 axis = std::cos(along) * side + std::sin(along) * Vec3::UnitY();
    if (std::abs(std::cos(along)) < .3) continue;  // else about parallel to the edge
    const Pose X{basis_with_z(axis),
                 Vec3(.1, random.uniform(-.05, .05), .1) + (radius - depth) * out};
    const VolumeMetrics m = sweep(block, rod, X).total;
    // Axes in which the overlap is longest and shortest as seen along the normal.
    Mat3 basis = basis_with_z(m.normal());
    const Mat3 seen = basis.transpose() * m.second_moment() * basis / m.volume;
    const double turn = 0.5 * std::atan2(2.0 * seen(0, 1), seen(0, 0) - seen(1, 1));
    basis = basis * rotation_about(Vec3::UnitZ(), turn);
    double step[2], expected = 0.0;
    for (int j = 0; j < 2; ++j) {
      const Vec3 e = basis.col(j);
      step[j] = 4.0 * std::sqrt(e.dot(m.second_moment() * e) / m.volume) / kLines;
    }
    for (int j = -kLines; j <= kLines; ++j) {
      for (int k = -kLines; k <= kLines; ++k) {
        const Vec3 x = m.centroid + j * step[0] * basis.col(0) + k * step[1] * basis.col(1);
        const RayInterval in_a = block.ray(x, basis.col(2));
        const RayInterval in_b = rod.ray(X.inverse() * x, X.rotation.transpose() * basis.col(2));
        const double length = std::min(in_a.leave, in_b.leave) - std::max(in_a.enter, in_b.enter);
        if (length > 0.0) expected += 0.5 * length * length * step[0] * step[1];
      }
    }
    EXPECT_NEAR(m.depth_moment, expected, 0.12 * expected) << i;
    mean += (m.depth_moment / expected - 1.0) / kPoses;
  }
  EXPECT_NEAR(mean, 0.0, 0.02);
}

// A region far smaller than the way from one of the first curves to the next, beside a large one: a
// cube in a block, which a plate overlaps besides.
TEST(Shell, ASmallRegionBesideALargeOne) {
  const Shape block = Box({.half_sizes = {.3, .3, .1}});
  const Csg bored = box(.3, .3, .1) - tube(.05, .2);
  test::Random random(58);
  for (int i = 0; i < 40; ++i) {
    const double half = random.log_uniform(1e-3, 1e-2);
    const Pose X_cube{random.rotation(), Vec3(random.uniform(.1, .25), random.uniform(-.2, .2),
                                              random.uniform(-.05, .05))};
    const Csg b = box(.1, .1, .1, at(-.15, -.15, .15)) + box(half, half, half, X_cube);
    const double expected = .2 * .2 * .05 + 8.0 * half * half * half;
    for (const Shape& a : {block, Shape(bored)}) {
      const Interference out = sweep(a, b, {});
      EXPECT_NEAR(out.total.volume, expected, 1e-9 * expected) << i;
      EXPECT_EQ(out.sites.size(), 2u) << i;
    }
  }
}

// What is in the plate is what is in the block less what is in the holes.
TEST(Shell, HolesTakeAwayWhatIsInThem) {
  const Shape block = Box({.half_sizes = {.3, .2, .05}});
  const Shape plugs[] = {Cylinder({.radius = .05, .half_length = .05}),
                         Cylinder({.radius = .04, .half_length = .05})};
  const Pose X_plugs[] = {at(.1, 0, 0), at(-.1, .05, 0)};
  const Shape bodies[] = {Sphere({.radius = .15}),
                          Cylinder({.radius = .08, .half_length = .2}),
                          Ellipsoid({.semi_axes = {.2, .1, .15}}),
                          Capsule({.radius = .06, .half_length = .1}),
                          Frustum({.bottom_radius = .1, .top_radius = .05, .half_length = .15}),
                          Torus({.major_radius = .12, .minor_radius = .03})};
  test::Random random(9);
  int compared = 0;
  for (const Shape& body : bodies) {
    for (int i = 0; i < 3; ++i) {
      const Pose X{random.rotation(), random.in_box(.1)};  // of the body in the plate
      double expected = evaluated(block, body, X).total.volume;
      for (int k = 0; k < 2; ++k) {
        expected -= evaluated(plugs[k], body, X_plugs[k].inverse() * X).total.volume;
      }
      if (expected < 1e-6) continue;
      ++compared;
      const VolumeMetrics m = sweep(kPlate, body, X).total;
      EXPECT_NEAR(m.volume, expected, 1e-3 * expected) << name_of(body) << " " << i;
      EXPECT_LE(std::abs(m.volume - expected), m.volume_error + 3e-4 * expected);
    }
  }
  EXPECT_GE(compared, 12);
}

// A ring pressed into its bore, and a ring on its rod: each section loses a segment of the circle.
TEST(Shell, ARingInABoreAndOnARod) {
  const double R = .1, r = .03, h = .025;  // the wall is h from the middle of the tube
  const double area = r * r * std::acos(h / r) - h * std::sqrt(r * r - h * h);
  const double moment = 2.0 / 3.0 * std::pow(r * r - h * h, 1.5);
  const Shape ring = Torus({.major_radius = R, .minor_radius = r});
  const Csg bored = box(.3, .3, .1) - tube(R + h, .5);
  const Interference outside = sweep(ring, bored, at(.0, .0, .02));
  const double outer = 2.0 * kPi * (R * area + moment), inner = 2.0 * kPi * (R * area - moment);
  ASSERT_EQ(outside.sites.size(), 1u);
  EXPECT_NEAR(outside.total.volume, outer, 1e-5 * outer);
  EXPECT_LE(outside.total.centroid.norm(), 1e-6);
  const Interference on_rod = sweep(ring, Shape(tube(R - h, .4) - tube(.02, .5)), at(0, 0, 0));
  ASSERT_EQ(on_rod.sites.size(), 1u);
  EXPECT_NEAR(on_rod.total.volume, inner, 1e-5 * inner);
  EXPECT_LE(on_rod.total.area_vector.norm(), 1e-6 * on_rod.total.area);
}

// A bar through a bore that it does not fill, out of both sides of the block.
TEST(Shell, ABarBesideTheBoreHasTwoSites) {
  const Csg bored = box(.3, .3, .1) - tube(.1, .5);
  const Interference out = sweep(Box({.half_sizes = {.2, .02, .05}}), bored, at(0, 0, 0));
  ASSERT_EQ(out.sites.size(), 2u);
  // Per side: 0.2 long, less the strip within the circle.
  const double strip = .02 * std::sqrt(.01 - .0004) + .01 * std::asin(.2);
  EXPECT_NEAR(out.total.volume, (.4 * .04 - 2.0 * strip) * .1, 1e-7);
  EXPECT_NEAR(out.sites[0].volume, out.sites[1].volume, 1e-9);
  EXPECT_NEAR(std::abs(out.sites[0].centroid.x() - out.sites[1].centroid.x()),
              2.0 * std::abs(out.sites[0].centroid.x()), 1e-9);
}

TEST(Shell, ServesUnionsOfRoundSolids) {
  const Csg two = ball(.2) + ball(.2, at(.2, .1, 0));
  const double depth = .01;
  const Interference out = sweep(HalfSpace(), two, at(0, 0, .2 - depth));
  ASSERT_EQ(out.sites.size(), 2u);
  const double cap = kPi * depth * depth * (.6 - depth) / 3.0;
  for (const VolumeMetrics& site : out.sites) EXPECT_NEAR(site.volume, cap, 1e-6 * cap);
  EXPECT_NEAR(out.total.depth, depth, 1e-9);
}

TEST(Shell, ASolidWithinAnotherIsContained) {
  const Csg part = tube(.1, .1) - tube(.05, .2);
  const Interference out = sweep(box(1, 1, 1) - ball(.2, at(.7, 0, 0)), part, at(.1, .1, 0));
  ASSERT_EQ(out.sites.size(), 1u);
  EXPECT_EQ(out.total.status, Status::kContained);
  const double volume = kPi * (.01 - .0025) * .2;
  EXPECT_NEAR(out.total.volume, volume, 1e-9);
  EXPECT_EQ(out.total.area_vector.norm(), 0.0);
}

// A bored slab with a recess in its lower side, pressed into a bored block: two feet become one
// site when the recess is full, and part again. Volume, force and torque about the origin are
// closed forms of the depth all along: no jump.
TEST(Shell, WrenchIsContinuousThroughMergeAndSplit) {
  constexpr double kRecess = 2e-3, kHole = .008, kBore = .006;
  const Csg bridge = box(.045, .02, .01, at(.045, 0, kRecess + .01)) +
                     box(.015, .02, .5 * kRecess, at(.015, 0, .5 * kRecess)) +
                     box(.005, .02, .5 * kRecess, at(.085, 0, .5 * kRecess)) -
                     tube(kHole, .1, at(.015, 0, 0));
  const Csg block = box(.2, .2, .1, at(0, 0, -.1)) - tube(kBore, .5, at(.055, 0, 0));
  const double left = .03 * .04 - kPi * kHole * kHole, right = .01 * .04;
  const double middle = .05 * .04 - kPi * kBore * kBore;
  const double to_left = .015, to_right = .085, to_middle = .055;  // their middles
  std::vector<double> depths = {2e-4, 1e-3, 1.9e-3, 2.1e-3, 3e-3};
  for (const double e : {1e-4, 1e-5, 1e-6}) {
    depths.push_back(kRecess - e);
    depths.push_back(kRecess + e);
  }
  for (const double depth : depths) {
    const Interference out = sweep(bridge, block, at(0, 0, depth));
    EXPECT_EQ(out.sites.size(), depth > kRecess ? 1u : 2u) << depth;
    const double above = std::max(0.0, depth - kRecess);
    const double force = (left + right) * depth + middle * above;
    const double torque = (to_left * left + to_right * right) * depth + to_middle * middle * above;
    Vec3 push = Vec3::Zero(), twist = Vec3::Zero();  // by V n at the centroid of each site
    for (const VolumeMetrics& site : out.sites) {
      push += site.volume * site.normal();
      twist += site.centroid.cross(site.volume * site.normal());
    }
    EXPECT_NEAR(out.total.volume, force, 1e-5 * force) << depth;
    EXPECT_NEAR(push.z(), force, 1e-5 * force) << depth;
    EXPECT_NEAR(twist.y(), -torque, 1e-5 * torque) << depth;
    EXPECT_LE(push.head<2>().norm(), 1e-5 * force) << depth;
  }
}

TEST(Shell, GivesUpWhatIsApart) {
  sweep(kPlate, Sphere({.radius = .03}), at(.1, 0, 0), false);  // in the hole
}

// S and T against finite differences of V, and the order of the pair.
TEST(Shell, AreaVectorAndMomentAreTheGradientOfVolume) {
  test::Random random(11);
  const Shape bodies[] = {Sphere({.radius = .12}), Box({.half_sizes = {.1, .06, .12}}),
                          Torus({.major_radius = .1, .minor_radius = .03})};
  int compared = 0;
  for (const Shape& body : bodies) {
    for (int i = 0; i < 2; ++i) {
      const Pose X{random.rotation(), random.in_box(.08)};
      const VolumeMetrics m = sweep(kPlate, body, X).total;
      if (!m.touching() || m.status == Status::kContained) continue;
      const auto volume = [&](const Pose& X_AB) { return sweep(kPlate, body, X_AB).total.volume; };
      const test::Gradient g = test::gradient_of_A(volume, X, 1e-3);
      EXPECT_LE((g.shift - m.area_vector).norm(), 1e-3 * m.area) << name_of(body) << i;
      EXPECT_LE((g.turn - m.area_moment).norm(), 1e-3 * m.area * .3) << name_of(body) << i;
      const VolumeMetrics other = transformed(sweep(body, kPlate, X.inverse()).total, X);
      EXPECT_NEAR(other.volume, m.volume, m.volume_error + other.volume_error);
      EXPECT_LE((other.area_vector + m.area_vector).norm(), 1e-3 * m.area);
      ++compared;
    }
  }
  EXPECT_GE(compared, 5);
}

// Poses that were left to the octree.
TEST(Shell, StaysWithinTheCertifiedBoundsOfTheOctree) {
  const Shape bodies[] = {Capsule({.radius = .05, .half_length = .1}),
                          Shape(tube(.08, .1) - tube(.05, .2))};
  test::Random random(21);
  int served = 0, tried = 0;
  const std::vector<NamedSolid> kinds = kinds_of_solids();
  for (std::size_t i = 0; i < kinds.size(); i += test::cases(1, 4)) {
    const NamedSolid& kind = kinds[i];
    const Shape& body = bodies[tried % 2];
    const Pose X{random.rotation(), random.in_box(.15)};
    ++tried;
    const VolumeMetrics octree =
        evaluated(kind.solid, body, X, {.tolerance = 2e-2, .engine = Engine::kOctree}).total;
    SurfaceSweepScratch scratch;
    Interference out;
    if (!surface_sweep(kind.solid, body, X, {}, scratch, out)) {
      EXPECT_LE(octree.volume, octree.volume_error + 1e-7) << kind.name;
      continue;
    }
    ++served;
    EXPECT_LE(std::abs(out.total.volume - octree.volume),
              octree.volume_error + out.total.volume_error + 1e-12)
        << kind.name;
  }
  EXPECT_GT(served, tried / 2);
}

}  // namespace
}  // namespace volcontact::surface_sweep_test
