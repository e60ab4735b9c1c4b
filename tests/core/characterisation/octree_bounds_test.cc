// SPDX-License-Identifier: Apache-2.0
// The certified bounds of the octree on random composed solids, against the lengths of random lines
// through solids that are written down once more: no cells, no pieces, no signed distances.
#include <gtest/gtest.h>

#include "core/reference/line_lattice.h"
#include "core/search/fuzz.h"
#include "core/support/random_solids.h"
#include "volcontact/pair/octree/octree.h"

namespace volcontact::test::octree_bounds_test {
namespace {

constexpr int kLines = 2000;
constexpr std::uint64_t kSeeds = 24;

// A composed solid whose own volume is not known: that of a solid with a ring takes seconds.
struct Bare {
  const Csg& solid;

  Aabb bounds() const { return solid.bounds(); }
  double signed_distance(const Vec3& p) const { return solid.signed_distance(p); }
  void pieces(PieceList& list) const { solid.pieces(list); }
};

struct Judged {
  int poses = 0, touching = 0, precise = 0;
};

// Whether V lies within volume_error of the answer, as far as the lines can tell.
void judge(const Csg& a, const Csg& b, const Pose& X_AB, double tolerance, std::uint64_t seed,
           Judged& judged) {
  OctreeScratch scratch;
  Interference out;
  const Bare bare_a{a}, bare_b{b};
  octree_interference(view_of(bare_a), view_of(bare_b), X_AB,
                      {.tolerance = tolerance, .most_cells = 10000}, scratch, out);
  Random random(seed);
  const LatticeVolume lines =
      lattice_volume(reference_solid(a), reference_solid(b), X_AB, a.bounds(), kLines, random);
  const VolumeMetrics& m = out.total;
  ++judged.poses;
  judged.touching += lines.volume > 0.0;
  judged.precise += m.volume_error <= tolerance * m.volume;
  EXPECT_LE(std::abs(m.volume - lines.volume), m.volume_error + lines.error + 1e-9)
      << "seed " << seed << ", tolerance " << tolerance << ": V = " << m.volume << ", bound "
      << m.volume_error << ", lines " << lines.volume << " +- " << lines.error
      << ", X_AB = " << literal(X_AB);
  double sum = 0.0;
  for (const VolumeMetrics& site : out.sites) sum += site.volume;
  EXPECT_NEAR(sum, m.volume, 1e-9 * m.volume) << seed;
}

class OctreeBounds : public ::testing::TestWithParam<bool> {};

TEST_P(OctreeBounds, HoldTheVolumeOfRandomComposedSolids) {
  const bool aligned = GetParam();
  Judged judged;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Random random(seed);
    const Csg a = random_solid(2 + static_cast<int>(seed % 3), aligned, random);
    const Csg b = random_solid(1 + static_cast<int>(seed % 4), aligned, random);
    Pose X_AB = random.pose(0.2);
    if (aligned) X_AB = {Mat3::Identity(), Vec3(0.1 * static_cast<double>(seed % 4), 0.1, 0.0)};
    judge(a, b, X_AB, seed % 4 == 0 ? 1e-3 : 1e-2, seed, judged);
  }
  EXPECT_GT(judged.touching, judged.poses / 2);
  EXPECT_GT(judged.precise, judged.poses / 3);
}

INSTANTIATE_TEST_SUITE_P(Solids, OctreeBounds, ::testing::Values(false, true),
                         [](const auto& test) { return test.param ? "aligned" : "turned"; });

// The oracle itself: textbook volumes lie within its doubt, and the doubt is small.
TEST(LineLattice, KnowsTheVolumeOfABallInARoom) {
  Random random(3);
  const Aabb room{Vec3::Constant(-0.3), Vec3::Constant(0.3)};
  const LatticeVolume lines =
      lattice_volume(reference_solid(Box({.half_sizes = Vec3::Constant(0.3)})),
                     reference_solid(Sphere({.radius = 0.25})), Pose{}, room, kLines, random);
  const double exact = 4.0 / 3.0 * kPi * 0.25 * 0.25 * 0.25;
  EXPECT_NEAR(lines.volume, exact, lines.error);
  EXPECT_LT(lines.error, 4e-3 * exact);
}

}  // namespace
}  // namespace volcontact::test::octree_bounds_test
