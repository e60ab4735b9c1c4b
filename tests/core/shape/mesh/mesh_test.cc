// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/mesh/mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "core/support/matchers.h"
#include "core/support/meshes.h"
#include "volcontact/shape/box.h"

namespace volcontact::mesh_test {
namespace {

using test::mesh_of;
using test::Random;
using test::Soup;

const Vec3 kHalf(0.3, 0.5, 0.2);

TEST(Mesh, OfABoxIsTheBox) {
  const Mesh mesh = mesh_of(test::box_soup(kHalf, 4));
  const Box box({.half_sizes = kHalf});
  EXPECT_TRUE(test::same(mesh.own_metrics(), box.own_metrics(), {1e-14, 1.0}));
  EXPECT_NEAR(mesh.surface_area(), 8.0 * (0.15 + 0.1 + 0.06), 1e-14);
  EXPECT_EQ(mesh.bounds().max, kHalf);
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = random.in_box(0.8), e = random.direction();
    EXPECT_NEAR(mesh.signed_distance(p), box.signed_distance(p), 1e-15) << p;
    EXPECT_NEAR(mesh.support_height(e), box.support_height(e), 1e-15);
    EXPECT_NEAR(mesh.gradient(p).norm(), 1.0, 1e-12);
  }
}

TEST(Mesh, DistanceGrowsAlongItsGradient) {
  const Mesh mesh = mesh_of(test::bumpy_soup(3, 1));
  Random random(2);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = random.in_box(1.5);
    const double distance = mesh.signed_distance(p);
    // Towards the surface the nearest point stays the nearest.
    const Vec3 step = -0.5 * distance * mesh.gradient(p);
    EXPECT_NEAR(mesh.signed_distance(p + step), 0.5 * distance, 1e-12);
  }
}

TEST(Mesh, HollowBodyKnowsItsCavity) {
  const Mesh mesh =
      mesh_of(test::box_soup(Vec3::Constant(2.0)).with(test::box_soup(Vec3::Ones()).inside_out()));
  EXPECT_NEAR(mesh.own_metrics().volume, 64.0 - 8.0, 1e-13);
  EXPECT_GT(mesh.signed_distance(Vec3(0.9, 0.0, 0.0)), 0.0);
  EXPECT_NEAR(mesh.signed_distance(Vec3(1.5, 0.2, 0.0)), -0.5, 1e-15);
  ASSERT_EQ(mesh.components().size(), 2u);
  EXPECT_FALSE(mesh.components().list[0].cavity);
  EXPECT_TRUE(mesh.components().list[1].cavity);
  EXPECT_NEAR(mesh.components().list[1].own.volume, 8.0, 1e-14);
}

// What is no point has no distance, one at infinity an infinite one, and the far one its own.
TEST(Mesh, PointsThatAreNoneHaveADistance) {
  const Mesh mesh = mesh_of(test::box_soup(kHalf, 4));
  const double nan = std::nan("");
  for (int i = 0; i < 3; ++i) {
    Vec3 p = 0.1 * Vec3::Ones();
    p[i] = nan;
    EXPECT_TRUE(std::isnan(mesh.signed_distance(p)));
    EXPECT_TRUE(!mesh.gradient(p).allFinite() || std::abs(mesh.gradient(p).norm() - 1.0) < 1e-12);
    p[i] = kInfinity;
    EXPECT_EQ(mesh.signed_distance(p), kInfinity);
    mesh.gradient(p);
    p[i] = -1e200;
    EXPECT_DOUBLE_EQ(mesh.signed_distance(p), 1e200);
    EXPECT_NEAR(mesh.gradient(p)[i], -1.0, 1e-12);
  }
}

TEST(Mesh, RefusesASurfaceThatBoundsNothing) {
  Soup open = test::box_soup(kHalf);
  open.triangles.pop_back();
  EXPECT_THROW(mesh_of(open), std::invalid_argument);
  EXPECT_THROW(mesh_of(test::box_soup(Vec3(1.0, 1.0, 0.0))), std::invalid_argument);
}

}  // namespace
}  // namespace volcontact::mesh_test
