// SPDX-License-Identifier: Apache-2.0
// The octree on faces of cones, outer and inner ones, against closed forms.
#include <gtest/gtest.h>

#include <cstring>

#include "core/support/random.h"
#include "volcontact/pair/octree/octree.h"

namespace volcontact::octree_cone_test {
namespace {

constexpr double kTolerances[] = {1e-1, 1e-2, 1e-3};

Interference octree(const Shape& a, const Shape& b, const Pose& X_AB, double tolerance,
                    int threads = 1) {
  static OctreeScratch scratch;
  Interference out;
  octree_interference(a, b, X_AB, {.tolerance = tolerance, .threads = threads}, scratch, out);
  EXPECT_LE(scratch.cell_count, kMostCells);
  return out;
}

void expect_certified(const Interference& out, double exact, double tolerance) {
  EXPECT_EQ(out.total.status, Status::kOk) << tolerance;
  EXPECT_LE(std::abs(out.total.volume - exact), out.total.volume_error) << tolerance;
  EXPECT_LE(out.total.volume_error, tolerance * out.total.volume) << tolerance;
}

// Cone with its apex up, half angle atan(k), cut off by a plane at the distance d from the apex and
// at the angle tilt to the base: a third of d times the ellipse of the section.
TEST(OctreeCone, CutOffTipIsAThirdOfItsSectionTimesItsHeight) {
  const Frustum cone({.bottom_radius = 0.3, .top_radius = 0.0, .half_length = 0.3});
  const double k = 0.5, d = 0.2;
  for (const double tilt : {0.0, 0.3, 0.7}) {
    const Mat3 r = test::turn(Vec3(0.6, 0.8, 0.0), kPi - tilt);
    const Pose X_AB{r, Vec3(0.0, 0.0, 0.3) + d * r.col(2)};
    const double m = k / std::cos(tilt), shrink = 1.0 - std::pow(m * std::sin(tilt), 2);
    const double section = kPi * d * d * m * m / (std::cos(tilt) * std::pow(shrink, 1.5));
    for (const double tolerance : kTolerances) {
      expect_certified(octree(cone, HalfSpace(), X_AB, tolerance), section * d / 3.0, tolerance);
    }
  }
}

// A ball of radius r in a conical cup whose apex lies in the middle of the block, at a height z on
// the axis: pi int (r^2 - (h - z)^2 - (slope h)^2) dh between the roots, where a parabola is
// positive.
TEST(OctreeCone, ABallInAPointedCupIsARing) {
  const double r = 0.12, z = 0.175, slope = 0.7;
  const Pose X{Mat3::Identity(), Vec3(0.0, 0.0, 0.1)};
  const Csg cup(Csg::Operation::kDifference, Csg(Box({.half_sizes = Vec3(0.3, 0.3, 0.2)})),
                Csg(Frustum({.bottom_radius = 0.0, .top_radius = 0.14, .half_length = 0.1}), X));
  const double a = 1.0 + slope * slope, root = std::sqrt(z * z - a * (z * z - r * r));
  const double exact = kPi * a * std::pow(2.0 * root / a, 3) / 6.0;
  const Pose X_AB{Mat3::Identity(), Vec3(0.0, 0.0, z)};
  for (const double tolerance : kTolerances) {
    expect_certified(octree(cup, Sphere({.radius = r}), X_AB, tolerance), exact, tolerance);
  }
}

// A block with a conical hole, wider at the top, and a round peg of radius c on the same axis that
// goes through both. It fills the hole where that is wider, and overlaps below.
class ConicalHole : public ::testing::Test {
 protected:
  static constexpr double kBottom = 0.1, kTop = 0.3, kHalf = 0.2, kPeg = 0.22;
  static double radius(double z) { return 0.5 * (kBottom + kTop + (kTop - kBottom) * z / kHalf); }
  // pi int (c^2 - r(z)^2) dz from the bottom up to r = c.
  static double exact() {
    const double slope = 0.5 * (kTop - kBottom) / kHalf;
    const double length = (kPeg - kBottom) / slope;
    return kPi *
           (kPeg * kPeg * length - (std::pow(kPeg, 3) - std::pow(kBottom, 3)) / (3.0 * slope));
  }
  const Csg block_ =
      Csg(Csg::Operation::kDifference, Csg(Box({.half_sizes = Vec3(0.5, 0.5, kHalf)})),
          Csg(Frustum({.bottom_radius = kBottom, .top_radius = kTop, .half_length = kHalf})));
  const Cylinder peg_{{.radius = kPeg, .half_length = 0.5}};
};

TEST_F(ConicalHole, RingBelowThePegIsCertified) {
  for (const double tolerance : kTolerances) {
    expect_certified(octree(block_, peg_, Pose{}, tolerance), exact(), tolerance);
    expect_certified(octree(peg_, block_, Pose{}, tolerance), exact(), tolerance);
  }
}

// The octree's cells see the cone from all sides when block and peg turn together about an axis
// that is not theirs.
TEST_F(ConicalHole, BoundsHoldHoweverTheConeIsTurned) {
  test::Random random(3);
  for (int i = 0; i < 20; ++i) {
    const Pose X{random.rotation(), random.in_box(0.3)};
    const Csg block = block_.posed(X), peg = Csg(peg_).posed(X);
    expect_certified(octree(block, peg, Pose{}, 1e-2), exact(), 1e-2);
  }
}

TEST_F(ConicalHole, ThreadsChangeNoBit) {
  const Interference one = octree(block_, peg_, Pose{}, 1e-3, 1);
  for (const int threads : {2, 3, 4, 8, 16}) {
    const Interference many = octree(block_, peg_, Pose{}, 1e-3, threads);
    EXPECT_EQ(std::memcmp(&many.total.volume, &one.total.volume, sizeof(double)), 0) << threads;
    EXPECT_EQ(many.total.area_vector, one.total.area_vector) << threads;
    EXPECT_EQ(many.total.inertia, one.total.inertia) << threads;
    EXPECT_EQ(many.total.depth_moment, one.total.depth_moment) << threads;
  }
}

// Out of cells: the answer says so, and its bound is still certain.
TEST_F(ConicalHole, BudgetOfCellsIsKeptAndReported) {
  OctreeScratch scratch;
  Interference out;
  double last = kInfinity;
  for (const int budget : {100, 400, 1600}) {
    octree_interference(block_, peg_, Pose{}, {.tolerance = 1e-5, .most_cells = budget}, scratch,
                        out);
    EXPECT_LE(scratch.cell_count, budget);
    EXPECT_EQ(out.total.status, Status::kApproximate);
    EXPECT_LE(std::abs(out.total.volume - exact()), out.total.volume_error);
    EXPECT_LT(out.total.volume_error, last);
    last = out.total.volume_error;
  }
  EXPECT_LT(last, 0.05 * exact());
}

// Pegs, balls and cones in chamfered, conical and spherical holes meet the usual tolerance with
// what a time step allows.
TEST(OctreeCone, HolesMeetTheToleranceWithinAStep) {
  const auto without = [](const Csg& a, const Csg& b) {
    return Csg(Csg::Operation::kDifference, a, b);
  };
  const auto up = [](const Csg& solid, double z) {
    return solid.posed({Mat3::Identity(), Vec3(0.0, 0.0, z)});
  };
  const Csg block(Box({.half_sizes = Vec3(0.02, 0.02, 0.01)}));
  const Csg bored = without(block, Csg(Cylinder({.radius = 0.008, .half_length = 0.02})));
  const Frustum chamfer({.bottom_radius = 0.008, .top_radius = 0.0101, .half_length = 0.001});
  const Frustum funnel({.bottom_radius = 0.004, .top_radius = 0.012, .half_length = 0.01});
  const Csg holes[] = {without(bored, up(Csg(chamfer), 0.0091)), without(block, Csg(funnel)),
                       without(block, up(Csg(Sphere({.radius = 0.01})), 0.01))};
  const Shape bodies[] = {
      Cylinder({.radius = 0.0081, .half_length = 0.015}), Sphere({.radius = 0.0095}),
      Frustum({.bottom_radius = 0.002, .top_radius = 0.011, .half_length = 0.01})};
  test::Random random(8);
  OctreeScratch scratch;
  Interference out;
  int touching = 0;
  for (const Csg& hole : holes) {
    for (const Shape& body : bodies) {
      const double towards = random.uniform(0.0, 2.0 * kPi);
      const Pose X{test::turn(Vec3(std::cos(towards), std::sin(towards), 0.0), 0.1),
                   random.in_box(1e-3) + Vec3(0.0, 0.0, 0.008)};
      octree_interference(hole, body, X, {.most_cells = kMostCellsInStep}, scratch, out);
      EXPECT_EQ(out.total.status, Status::kOk) << name_of(body);
      touching += out.total.touching();
    }
  }
  EXPECT_GE(touching, 7);
}

}  // namespace
}  // namespace volcontact::octree_cone_test
