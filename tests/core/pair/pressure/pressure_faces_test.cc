// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/pressure/pressure_faces.h"

#include <gtest/gtest.h>

#include "core/support/field_loops.h"
#include "core/support/meshes.h"
#include "core/support/random_shapes.h"

namespace volcontact::pressure_faces_test {
namespace {

using test::field_sum;
using test::FieldSum;

const Box kBlock({.half_sizes = {0.1, 0.08, 0.06}});
const Shape kBox = kBlock;
const Shape kMesh = test::mesh_of(test::box_soup({0.1, 0.08, 0.06}, 3));
const Shape kEgg = Ellipsoid({.semi_axes = {0.1, 0.07, 0.05}});
const Shape kTable = test::polytope_of(Box({.half_sizes = {1.0, 1.0, 0.5}}));
const Shape kWedge = ConvexPolytope(std::vector<Vec3>{{0.1, 0.1, -0.1},
                                                      {-0.1, 0.1, -0.1},
                                                      {0.1, -0.1, -0.1},
                                                      {-0.1, -0.1, -0.1},
                                                      {0.02, 0.0, 0.12},
                                                      {0.05, 0.03, 0.1}});
const Pose kCorner{test::turn({1.0, 0.3, -0.4}, 0.9), Vec3(0.1, 0.08, 0.1)};

TEST(PressureFaces, MeshOfABoxIsTheBox) {
  // Exact cells of both, with a rigid box.
  const FieldSum one = field_sum(kWedge, kMesh, kCorner),
                 other = field_sum(kWedge, kBox, kCorner, 1.0);
  const double size = other.field.force.norm();
  ASSERT_GT(size, 0.0);
  EXPECT_NEAR(one.field.energy, other.field.energy, 1e-10 * other.field.energy);
  EXPECT_LT((one.field.force - other.field.force).norm(), 1e-10 * size);
  EXPECT_LT((one.field.couple - other.field.couple).norm(), 1e-10 * other.field.couple.norm());
}

TEST(PressureFaces, FaceIsAHalfSpace) {
  // Lines are as good as 3e-6.
  // Archimedes under the top of a large block.
  PressureScratch scratch;
  const Shape floor = HalfSpace();
  for (const Shape& b : {kEgg, kMesh}) {
    const Pose X_on{kCorner.rotation, Vec3(0.1, -0.2, 0.54)},
        X{kCorner.rotation, Vec3(0.1, -0.2, 0.04)};
    const FieldSum table = field_sum(kTable, b, X_on), plane = field_sum(floor, b, X);
    const double size = plane.field.force.norm();
    ASSERT_GT(size, 0.0);
    EXPECT_NEAR(table.field.energy, plane.field.energy, 3e-6 * plane.field.energy) << name_of(b);
    EXPECT_LT((table.field.force - plane.field.force).norm(), 3e-6 * size) << name_of(b);
  }
}

TEST(PressureFaces, ForceIsTheGradientOfTheEnergy) {
  for (const Shape& b : {kEgg, kMesh}) {
    const FieldSum sum = field_sum(kWedge, b, kCorner);
    const auto energy = [&](const Pose& X) { return field_sum(kWedge, b, X).field.energy; };
    const test::Gradient gradient = test::gradient_of_A(energy, kCorner, 2e-5);
    EXPECT_LT((sum.field.force + gradient.shift).norm(), 1e-5 * gradient.shift.norm())
        << name_of(b);
    EXPECT_LT((sum.field.couple + gradient.turn).norm(), 1e-4 * gradient.turn.norm()) << name_of(b);
  }
}

TEST(PressureFaces, ClosedLoopsTakeNoWork) {
  EXPECT_LT(test::loop_work(kWedge, kEgg, kCorner, 200), 1e-6);
  EXPECT_LT(test::loop_work(kMesh, kWedge, kCorner.inverse(), 200), 1e-8);
}

TEST(PressureFaces, ActionIsReaction) {
  for (const Shape& b : {kEgg, kMesh}) {
    const FieldSum on_a = field_sum(kWedge, b, kCorner),
                   on_b = field_sum(b, kWedge, kCorner.inverse());
    const double size = on_a.field.force.norm();
    EXPECT_LT((on_a.field.force + kCorner.rotation * on_b.field.force).norm(), 1e-6 * size);
    EXPECT_NEAR(on_a.field.energy, on_b.field.energy, 1e-6 * on_a.field.energy);
  }
}

TEST(PressureFaces, SitesShareTheSum) {
  // A table with two blocks of one mesh on it: each half of the whole.
  const test::Soup block = test::box_soup({0.05, 0.04, 0.03});
  const Shape feet = test::mesh_of(
      block.moved(test::shifted(-0.2, 0, 0)).with(block.moved(test::shifted(0.2, 0, 0))));
  const FieldSum sum = field_sum(kTable, feet, {Mat3::Identity(), Vec3(0.0, 0.1, 0.529)});
  ASSERT_EQ(sum.by_site.size(), 2u);
  for (const Vec3& force : sum.by_site) EXPECT_NEAR(force.z(), -0.1 * 0.08 * 0.001, 1e-12);
}

}  // namespace
}  // namespace volcontact::pressure_faces_test
