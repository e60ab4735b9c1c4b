// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/pressure/pressure_meshes.h"

#include <gtest/gtest.h>

#include "core/support/csg_solids.h"
#include "core/support/field_loops.h"
#include "core/support/meshes.h"
#include "core/support/sanitized.h"

namespace volcontact::pressure_meshes_test {
namespace {

using test::field_sum;
using test::FieldSum;

constexpr double kRule = 1e-3;

const Shape kBox = Box({.half_sizes = {0.1, 0.08, 0.06}});
const Shape kMesh = test::mesh_of(test::box_soup({0.1, 0.08, 0.06}, 2));
const Pose kCorner{test::turn({1.0, 0.3, -0.4}, 0.9), Vec3(0.1, 0.09, 0.07)};

Shape bumpy(int seed) {
  test::Soup soup = test::bumpy_soup(2, seed);
  for (Vec3& v : soup.vertices) v *= 0.1;
  return test::mesh_of(soup);
}

TEST(PressureMeshes, MeshesOfBoxesAreBoxes) {
  // Exact cells, all of the field in A or in B.
  for (const double share : {0.8, 0.3}) {
    const FieldSum one = field_sum(kMesh, kMesh, kCorner, share);
    const FieldSum other = field_sum(kBox, kBox, kCorner, share > 0.5 ? 1.0 : 0.0);
    const double size = other.field.force.norm();
    EXPECT_LT((one.field.force - other.field.force).norm(), kRule * size);
    EXPECT_LT((one.field.couple - other.field.couple).norm(), kRule * other.field.couple.norm());
    EXPECT_NEAR(one.field.energy, other.field.energy, 3.0 * kRule * other.field.energy);
    EXPECT_GT(one.field.error, 0.0);
    EXPECT_LT(one.field.error, 2.0 * kRule * size);
  }
}

TEST(PressureMeshes, FlatOnAFaceIsAWinklerBed) {
  // The table carries all: U = A h^2 / 2, F = A h.
  constexpr double kDepth = 0.004, kArea = 4.0 * 0.1 * 0.08;
  const Shape table = test::mesh_of(test::box_soup({1.0, 1.0, 0.5}));
  const FieldSum sum =
      field_sum(table, kMesh, {Mat3::Identity(), Vec3(0.3, 0.2, 0.56 - kDepth)}, 0.9);
  EXPECT_NEAR(sum.field.force.z(), -kArea * kDepth, kRule * kArea * kDepth);
  EXPECT_NEAR(sum.field.energy, 0.5 * kArea * kDepth * kDepth, kRule * sum.field.energy);
}

TEST(PressureMeshes, HollowsAreServed) {
  // Neither convex: -dU by differences of the energy, which has its own rule.
  const Shape a = bumpy(1), b = bumpy(2);
  const Pose X{kCorner.rotation, Vec3(0.1, 0.12, 0.1)};
  const FieldSum sum = field_sum(a, b, X);
  ASSERT_GT(sum.field.energy, 0.0);
  const auto energy = [&](const Pose& Y) { return field_sum(a, b, Y).field.energy; };
  const Vec3 way = sum.field.force.normalized();
  constexpr double kStep = 5e-4;
  const auto at = [&](double s) {
    Pose Y = X;
    Y.translation -= s * way;
    return energy(Y);
  };
  const double slope = (at(kStep) - at(-kStep)) / (2.0 * kStep);
  EXPECT_NEAR(sum.field.force.dot(way), -slope, 2e-2 * std::abs(slope));
  if (test::kSanitized) return;  // the same once more, at other poses
  EXPECT_LT(test::loop_work(a, b, X, 24), 1e-3);
}

TEST(PressureMeshes, ActionIsReaction) {
  const Shape a = bumpy(1);
  const Pose X{kCorner.rotation, Vec3(0.13, 0.1, 0.05)};
  const FieldSum on_a = field_sum(a, kMesh, X, 0.4), on_b = field_sum(kMesh, a, X.inverse(), 0.6);
  const double size = on_a.field.force.norm();
  ASSERT_GT(size, 0.0);
  EXPECT_LT((on_a.field.force + X.rotation * on_b.field.force).norm(), 1e-6 * size);
  EXPECT_NEAR(on_a.field.energy, on_b.field.energy, 1e-6 * on_a.field.energy);
}

TEST(PressureMeshes, ComposedSolidWithoutLayersCarries) {
  // An ellipsoid member has none; the face of the block beside it does as a box does.
  const Csg block = testing::box(.15, .15, .1) -
                    Csg(SimpleShape(Ellipsoid({.semi_axes = {.02, .02, .3}})), Pose{});
  const Shape solid = block;
  const Shape plain = Box({.half_sizes = {.15, .15, .1}});
  ASSERT_TRUE(has_pressure_field(solid, kMesh, Engine::kOctree));
  PressureScratch scratch;
  const Pose X{kCorner.rotation, Vec3(0.16, 0.02, 0.13)};
  const FieldSum other = field_sum(plain, kMesh, X);
  ASSERT_EQ(other.overlap.sites.size(), 1u);
  const PressureField field =
      pressure_meshes(solid, kMesh, X, {other.overlap.sites, 0, 0.4, {}}, scratch);
  EXPECT_LT((field.force - other.field.force).norm(), 5.0 * kRule * other.field.force.norm());
}

}  // namespace
}  // namespace volcontact::pressure_meshes_test
