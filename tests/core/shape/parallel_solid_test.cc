// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/parallel_solid.h"

#include <gtest/gtest.h>

#include "core/support/csg_solids.h"
#include "core/support/random.h"

namespace volcontact::parallel_solid_test {
namespace {

using test::Random;

const std::vector<Shape> kSolids = {
    Sphere({.radius = 0.4}),
    Capsule({.radius = 0.3, .half_length = 0.5}),
    Cylinder({.radius = 0.3, .half_length = 0.5}),
    Cylinder({.radius = 0.6, .half_length = 0.2}),
    Box({.half_sizes = {0.3, 0.5, 0.4}}),
    RoundedBox({.half_sizes = {0.3, 0.5, 0.4}, .radius = 0.12}),
    Torus({.major_radius = 0.6, .minor_radius = 0.25}),
    Frustum({.bottom_radius = 0.5, .top_radius = 0.2, .half_length = 0.4}),
    Frustum({.bottom_radius = 0.0, .top_radius = 0.5, .half_length = 0.6}),
    Frustum({.bottom_radius = 0.7, .top_radius = 0.65, .half_length = 0.1}),
};

double signed_distance(const Shape& shape, const Vec3& p) {
  return std::visit([&](const auto& solid) { return solid.signed_distance(p); }, shape);
}

TEST(ParallelSolid, HoldsWhatIsDeeper) {
  Random random(3);
  for (const Shape& solid : kSolids) {
    ASSERT_TRUE(has_parallel_solids(solid));
    for (const double share : {0.0, 0.3, 0.8}) {
      const double depth = share * greatest_depth(solid);
      Shape inner = solid;
      Pose X_SI;
      ASSERT_TRUE(parallel_solid(solid, depth, inner, X_SI)) << name_of(solid);
      int deeper = 0;
      for (int i = 0; i < 4000; ++i) {
        const Vec3 p = random.in_box(0.9);
        const double below = signed_distance(solid, p) + depth;
        if (std::abs(below) < 1e-12) continue;
        EXPECT_EQ(below < 0.0, signed_distance(inner, X_SI.inverse() * p) < 0.0) << name_of(solid);
        deeper += below < 0.0;
      }
      if (share < 0.5) {
        EXPECT_GT(deeper, 20) << name_of(solid);
      }
    }
  }
}

TEST(ParallelSolid, ComposedOneHoldsWhatIsDeeper) {
  // Members far from each other's edges: outside of a corner the depth is to the nearest face.
  using testing::at, testing::box, testing::tube, testing::ball;
  const Csg bored = box(.5, .4, .3) - tube(.1, .9) - ball(.1, at(.3, .2, .3));
  const Csg cut = box(.5, .4, .3) & Csg(HalfSpace(), testing::turned({1, 2, 3}, .4, {0, 0, .1}));
  const Csg kept = box(.5, .4, .3) - (tube(.2, .9) - tube(.1, .9));
  const Csg pair = box(.2, .2, .2) + ball(.2, at(.3, 0, 0));
  Random random(4);
  for (const Csg& solid : {bored, cut, kept, pair}) {
    ASSERT_TRUE(has_composed_parallels(solid));
    EXPECT_FALSE(has_parallel_solids(solid));
    constexpr double kDepth = 0.04;
    Shape inner = solid;
    Pose X_SI;
    ASSERT_TRUE(parallel_solid(solid, kDepth, inner, X_SI));
    int deeper = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vec3 p = random.in_box(0.6);
      const double below = signed_distance(solid, p) + kDepth;
      if (std::abs(below) < 1e-12) continue;
      EXPECT_EQ(below < 0.0, signed_distance(inner, X_SI.inverse() * p) < 0.0);
      deeper += below < 0.0;
    }
    EXPECT_GT(deeper, 20);
    EXPECT_FALSE(parallel_solid(solid, 1.01 * greatest_depth(solid), inner, X_SI));
  }
}

TEST(ParallelSolid, EndsAtTheGreatestDepth) {
  for (const Shape& solid : kSolids) {
    Shape inner = solid;
    Pose X_SI;
    const double depth = greatest_depth(solid);
    EXPECT_TRUE(parallel_solid(solid, 0.999999 * depth, inner, X_SI)) << name_of(solid);
    EXPECT_FALSE(parallel_solid(solid, 1.000001 * depth, inner, X_SI)) << name_of(solid);
  }
}

TEST(ParallelSolid, VolumeFallsByTheSurface) {
  for (const Shape& solid : kSolids) {
    Shape inner = solid;
    Pose X_SI;
    constexpr double kDepth = 1e-6;
    ASSERT_TRUE(parallel_solid(solid, kDepth, inner, X_SI));
    const double lost = own_metrics_of(solid).volume - own_metrics_of(inner).volume;
    const double area = surface_area(solid);
    EXPECT_NEAR(lost / kDepth, area, 1e-4 * area) << name_of(solid);
  }
}

TEST(ParallelSolid, OthersHaveNone) {
  const Shape egg = Ellipsoid({.semi_axes = {0.1, 0.2, 0.3}});
  Shape inner = egg;
  Pose X_SI;
  EXPECT_FALSE(has_parallel_solids(egg));
  EXPECT_FALSE(has_parallel_solids(HalfSpace()));
  EXPECT_FALSE(has_composed_parallels(composed(egg)));
  EXPECT_EQ(greatest_depth(egg), kInfinity);
  EXPECT_EQ(surface_area(egg), 0.0);
  EXPECT_FALSE(parallel_solid(egg, 0.0, inner, X_SI));
}

}  // namespace
}  // namespace volcontact::parallel_solid_test
