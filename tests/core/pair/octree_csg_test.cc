// SPDX-License-Identifier: Apache-2.0
// The octree on composed solids, against the lengths of lines through both solids at once: a method
// that knows neither cells nor pieces.
#include <gtest/gtest.h>

#include "core/support/csg_solids.h"
#include "core/support/random.h"
#include "volcontact/pair/interference.h"
#include "volcontact/pair/octree.h"
#include "volcontact/shape/csg_metrics.h"

namespace volcontact {
namespace {

using namespace testing;  // the solids

Interference octree(const Csg& a, const Csg& b) {
  static OctreeScratch scratch;
  Interference out;
  octree_interference(view_of(a), view_of(b), Pose{}, {.tolerance = 1e-2}, scratch, out);
  return out;
}

// The sanitizers make every cell many times slower and look for other faults: fewer will do.
#if defined(__SANITIZE_ADDRESS__)
constexpr std::size_t kEvery = 8;
#else
constexpr std::size_t kEvery = 1;
#endif

TEST(OctreeCsg, BoundsHoldTheVolumeOfEveryKindOfSolid) {
  const Csg rod = tube(.06, .15, turned({1, .4, .2}, .8, {.1, .05, .08}));
  const std::vector<NamedSolid> kinds = kinds_of_solids();
  int touching = 0;
  for (std::size_t i = 0; i < kinds.size(); i += kEvery) {
    const NamedSolid& named = kinds[i];
    const double exact = csg_metrics_by_lines(named.solid & rod).volume;
    const Interference out = octree(named.solid, rod);
    EXPECT_LE(std::abs(out.total.volume - exact), out.total.volume_error + 1e-7 * exact)
        << named.name;
    touching += exact > 0.0;
  }
  EXPECT_GT(touching, 20 / static_cast<int>(kEvery));
}

// A cell longer than the bore is wide: its columns leave the solid and enter it again.
TEST(OctreeCsg, TheFarSideOfABoreCounts) {
  Pose X;
  X.rotation << 0.893878, -0.362873, -0.263259, 0.436683, 0.571886, 0.694446, -0.101442, -0.73571,
      0.669657;
  X.rotation = Eigen::Quaterniond(X.rotation).normalized().toRotationMatrix();
  X.translation = Vec3(0.130462, 0.0564184, 0.101759);
  const Csg rod = tube(.06, .15, X);
  const Csg boss = box(.3, .2, .05) + tube(.05, .1, at(.1, 0, .15));
  const double exact = csg_metrics_by_lines(boss & rod).volume;
  const Interference out = octree(boss, rod);
  EXPECT_LE(std::abs(out.total.volume - exact), out.total.volume_error);
  EXPECT_NEAR(out.total.volume, exact, 1e-2 * exact);
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

}  // namespace
}  // namespace volcontact
