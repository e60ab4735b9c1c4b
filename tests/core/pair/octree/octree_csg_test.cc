// SPDX-License-Identifier: Apache-2.0
// The octree on composed solids, against the lengths of lines through both solids at once: a method
// that knows neither cells nor pieces.
#include <gtest/gtest.h>

#include <span>

#include "core/support/random.h"
#include "core/support/sanitized.h"
#include "volcontact/pair/interference.h"
#include "volcontact/pair/octree/octree.h"
#include "volcontact/shape/csg/csg_metrics.h"

#include "core/support/csg_solids.h"

namespace volcontact::octree_csg_test {
namespace {

using namespace testing;  // the solids

// Of a matrix that is one but for the digits it was written with.
Mat3 nearest_rotation(const Mat3& r) {
  Mat3 out = r;
  for (int i = 0; i < 3; ++i) out = 0.5 * out * (3.0 * Mat3::Identity() - out.transpose() * out);
  return out;
}

Interference octree(const Csg& a, const Csg& b, double tolerance = 1e-2) {
  static OctreeScratch scratch;
  Interference out;
  octree_interference(view_of(a), view_of(b), Pose{}, {.tolerance = tolerance}, scratch, out);
  return out;
}

// Lines for the exact numbers: as many as they take, but under the sanitizers.
const double kWork = test::kSanitized ? 1e5 : kInfinity;

TEST(OctreeCsg, BoundsHoldTheVolumeOfEveryKindOfSolid) {
  const Csg rod = tube(.06, .15, turned({1, .4, .2}, .8, {.1, .05, .08}));
  const std::vector<NamedSolid> kinds = kinds_of_solids();
  const int kEvery = test::cases(1, 4, 48);
  int touching = 0;
  for (std::size_t i = 0; i < kinds.size(); i += kEvery) {
    const NamedSolid& named = kinds[i];
    const double exact = csg_metrics_by_lines(named.solid & rod).volume;
    const Interference out = octree(named.solid, rod);
    EXPECT_LE(std::abs(out.total.volume - exact), out.total.volume_error + 1e-7 * exact)
        << named.name;
    touching += exact > 0.0;
  }
  EXPECT_GT(touching, 20 / kEvery);
}

// Of a solid of several parts one or more lie in the other solid: that is not all of it, however
// few cells there are to tell. Parts without pieces leave most doubt. Closed forms.
TEST(OctreeCsg, PartsOfASolidWithinTheOtherCountOnce) {
  const double slab = .2 * .02 * .16, ring = 2.0 * kPi * kPi * .1 * .02 * .02;
  // Two slabs, of a block less another block that has a hole.
  const Csg slabs =
      (box(.1, .12, .08) - tube(.05, .3)) - (box(.12, .1, .09) - cone(.04, .015, .12));
  const Csg torus(Torus({.major_radius = .1, .minor_radius = .02}));
  const Csg rings = torus + torus.posed(at(.5, 0, 0));
  const Csg boxes = box(.05, .05, .05) + box(.05, .05, .05, at(.5, 0, 0));
  const Csg all = box(1, 1, 1);
  struct Case {
    Csg a, b;
    double volume;
  };
  const Case cases[] = {{slabs, all, 2.0 * slab},
                        {slabs, box(.3, .3, .3, at(0, .4, 0)), slab},
                        {slabs, box(.3, .3, .3, at(0, -.4, 0)), slab},
                        {rings, all, 2.0 * ring},
                        {rings, box(.2, .2, .2), ring},
                        {boxes, all, 2e-3},
                        {boxes, box(.2, .2, .2), 1e-3}};
  OctreeScratch scratch;
  Interference out;
  for (const auto& [a, b, volume] : cases) {
    for (const int most_cells : {100, 1000, 20000}) {
      for (const bool swap : {false, true}) {
        const Csg &one = swap ? b : a, &other = swap ? a : b;
        octree_interference(view_of(one), view_of(other), Pose{}, {.most_cells = most_cells},
                            scratch, out);
        EXPECT_LE(std::abs(out.total.volume - volume), out.total.volume_error + 1e-12);
        double sum = 0.0;
        for (const VolumeMetrics& site : out.sites) sum += site.volume;
        EXPECT_NEAR(sum, out.total.volume, 1e-15);
        if (out.total.status <= Status::kContained) {
          EXPECT_NEAR(out.total.volume, volume, 1e-3 * volume);
        }
      }
    }
  }
}

// A cell longer than the bore is wide: its columns leave the solid and enter it again.
TEST(OctreeCsg, TheFarSideOfABoreCounts) {
  Pose X;
  X.rotation = Mat3(0.893878, -0.362873, -0.263259, 0.436683, 0.571886, 0.694446, -0.101442,
                    -0.73571, 0.669657);
  X.rotation = nearest_rotation(X.rotation);
  X.translation = Vec3(0.130462, 0.0564184, 0.101759);
  const Csg rod = tube(.06, .15, X);
  const Csg boss = box(.3, .2, .05) + tube(.05, .1, at(.1, 0, .15));
  const double exact = csg_metrics_by_lines(boss & rod, kWork).volume;
  const Interference out = octree(boss, rod);
  EXPECT_LE(std::abs(out.total.volume - exact), out.total.volume_error);
  EXPECT_NEAR(out.total.volume, exact, 1e-2 * exact);
}

// Where the samples of the volume between a face and its plane cancel, they have no middle: leaves
// of these two gave centroids kilometres away.
TEST(OctreeCsg, CentroidsAreThoseOfTheIntersection) {
  const Csg block = box(.4, .4, .25) - tube(.15, .5) - tube(.25, .2, at(0, 0, .3));
  Pose X;
  X.rotation = nearest_rotation(Mat3(0.16985641245, -0.87781283998, 0.4478765646, -0.5725983011,
                                     0.28197799277, 0.76981789871, -0.80204737063, -0.38721186651,
                                     -0.45473837061));
  X.translation = Vec3(0.1147465486, 0.1784027458, 0.0561218447);
  Pose Y;
  Y.rotation = nearest_rotation(Mat3(-0.64673649140, -0.32451233726, -0.69023449179, 0.75869042589,
                                     -0.18088870225, -0.62583393570, 0.07823521174, -0.92842394432,
                                     0.36319172798));
  Y.translation = Vec3(-0.5330758238, -0.0137593497, -0.0872666454);
  const Csg pill = capsule(.2, .3), egg(Ellipsoid({.semi_axes = Vec3(.5, .35, .2)}));
  const std::pair<Csg, Csg> cases[] = {{pill, block.posed(X)}, {egg, block.posed(Y)}};
  for (const auto& [a, b] : std::span(cases).first(test::cases(2, 1))) {
    const VolumeMetrics exact = csg_metrics_by_lines(a & b, kWork);
    for (const double tolerance : {1e-2, 1e-3}) {
      if (test::kSanitized && tolerance < 1e-2) continue;
      const VolumeMetrics m = octree(a, b, tolerance).total;
      EXPECT_LE((m.centroid - exact.centroid).norm(), 0.5 * tolerance);  // half the block
      EXPECT_LE((m.inertia - exact.inertia).norm(), 3.0 * tolerance * exact.inertia.norm());
    }
  }
}

// The seams within the solid are no surface: a ball pressed into the top of a counterbored block
// next to its hole sees the top only.
TEST(OctreeCsg, AreasLeaveSeamsOut) {
  const double depth = .02, radius = .05;
  const Csg drop = ball(radius, at(.2, .1, .1 + radius - depth));
  const VolumeMetrics m = octree(counterbored(), drop).total;
  const double disc = kPi * depth * (2.0 * radius - depth);
  EXPECT_NEAR(m.area, disc, 1e-2 * disc);
  EXPECT_NEAR(m.counter_area, 2.0 * kPi * radius * depth, 1e-2 * m.counter_area);
  EXPECT_NEAR(m.area_vector.z(), disc, 1e-2 * disc);
  EXPECT_NEAR(m.volume, kPi * depth * depth * (radius - depth / 3.0), 1e-2 * m.volume);
}

// Wall against wall, 0.02 mm apart and a thousand times as long. The expected volumes are those of
// the lines engine, which knows no cells and integrates the wall's columns to 1e-7. Bounds of each
// wall by itself would take 3800 cells; together they need a third.
TEST(OctreeCsg, WallsThatAreNearlyParallelNeedFewCells) {
  const Shape block = box(.02, .02, .01) - tube(.01, .02);
  const Shape peg = Cylinder({.radius = 0.00998, .half_length = 0.02});
  test::Random random(8);
  InterferenceWorkspace workspace;
  Interference cells, lines;
  for (int i = 0; i < 12; ++i) {
    const double towards = random.uniform(0.0, 2.0 * kPi);
    const Pose X{
        test::turn({std::cos(towards), std::sin(towards), 0.0}, random.uniform(.0025, .004)),
        random.in_box(2e-6)};
    interference(block, peg, X, {.engine = Engine::kLines}, workspace, lines);
    ASSERT_EQ(lines.engine, Engine::kLines);
    for (const double tolerance : {1e-1, 1e-2}) {
      interference(block, peg, X,
                   {.tolerance = tolerance, .engine = Engine::kOctree, .most_cells = 1300},
                   workspace, cells);
      EXPECT_EQ(cells.total.status, Status::kOk);
      EXPECT_EQ(cells.sites.size(), 2u);
      EXPECT_LE(std::abs(cells.total.volume - lines.total.volume),
                cells.total.volume_error + 1e-7 * lines.total.volume);
    }
  }
}

// What little lies in a corner of a large cell is put where both solids are: an edge of the bar
// reaches 3 mm over the rim of the hole, 0.2 in 1,000 of the overlap.
TEST(OctreeCsg, ASmallSiteLiesInBothSolids) {
  const Csg cup = box(.3, .25, .2) - tube(.1, .2, at(0, 0, .2));
  const Box bar({.half_sizes = {.2, .05, .1}});
  Pose X;
  X.rotation = Mat3(.62767394429504275, .75279892414022065, .19829069435157615,
                    -.026869566377383192, .27551457860380679, -.96092129926412728,
                    -.77801249736478861, .59781727709233501, .19316070292404619);
  X.translation = {-.088525436917326228, .22520823238336474, -.11092734681562799};
  for (const double shift : {0.0, 1e-4, -1e-4, 1e-3}) {
    X.translation.x() += shift;
    static OctreeScratch scratch;
    Interference out;
    octree_interference(Shape(bar), Shape(cup), X, {.tolerance = 3e-2}, scratch, out);
    ASSERT_EQ(out.sites.size(), 2u);
    for (const VolumeMetrics& site : out.sites) {
      const Vec3 beyond_bar = site.centroid.cwiseAbs() - Vec3(.2, .05, .1);
      const Vec3 beyond_cup = (X.inverse() * site.centroid).cwiseAbs() - Vec3(.3, .25, .2);
      EXPECT_LE(beyond_bar.maxCoeff(), 1e-9);
      EXPECT_LE(beyond_cup.maxCoeff(), 1e-9);
    }
  }
}

// Coarse cells give rough numbers, but such as two solids can have: nothing is refused.
TEST(OctreeCsg, NoRoughNumberIsImpossible) {
  const Shape others[] = {Sphere({.radius = .15}), Cylinder({.radius = .09, .half_length = .3}),
                          Frustum({.bottom_radius = .2, .top_radius = .05, .half_length = .1}),
                          Box({.half_sizes = {.2, .05, .1}})};
  test::Random random(1);
  const int kPoses = test::cases(10, 1);
  InterferenceWorkspace workspace;
  Interference out;
  const std::vector<NamedSolid> kinds = kinds_of_solids();
  for (std::size_t kind = 0; kind < kinds.size(); kind += test::cases(1, 4)) {
    const NamedSolid& named = kinds[kind];
    for (int i = 0; i < kPoses; ++i) {
      for (const Shape& other : others) {
        interference(other, named.solid, random.pose(.3),
                     {.tolerance = 3e-2, .engine = Engine::kOctree, .threads = 1}, workspace, out);
        EXPECT_NE(out.total.status, Status::kInvalid) << named.name << ", " << name_of(other);
      }
    }
  }
}

}  // namespace
}  // namespace volcontact::octree_csg_test
