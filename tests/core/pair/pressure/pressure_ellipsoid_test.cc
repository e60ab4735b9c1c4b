// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/pressure/pressure_ellipsoid.h"

#include <gtest/gtest.h>

#include "core/support/field_loops.h"
#include "core/support/meshes.h"
#include "core/support/sanitized.h"
#include "volcontact/pair/pressure/pressure_columns.h"

namespace volcontact::pressure_ellipsoid_test {
namespace {

using test::field_sum;
using test::FieldSum;

constexpr double kExact = 1e-8;

const Shape kTable = test::mesh_of(test::box_soup({0.5, 0.5, 0.1}, 2));
const Shape kBlock = test::mesh_of(test::box_soup({0.1, 0.08, 0.06}, 3));
const Ellipsoid kSolid({.semi_axes = {0.1, 0.07, 0.05}});
const Shape kEgg = kSolid;
const Shape kBall = Ellipsoid({.semi_axes = {0.09, 0.09, 0.09}});
const Pose kCorner{test::turn({1.0, 0.3, -0.4}, 0.9), Vec3(0.09, 0.07, 0.08)};

TEST(PressureEllipsoid, BallOnAFace) {
  // int over the cap of the depth below the ball's surface: dU/dh = pi (R h^2 - 2 h^3 / 3).
  constexpr double kRadius = 0.09;
  const Shape fine = test::mesh_of(test::box_soup({0.5, 0.5, 0.1}, 25));
  for (const double h : {1e-4, 0.01, 0.08}) {
    // The depth has a cone at the ball's middle, from which the face is not far at last.
    const double tolerance = h < 0.05 ? 1e-7 : 1e-5;
    const Pose X{Mat3::Identity(), Vec3(0.03, -0.02, 0.1 + kRadius - h)};
    const double force = kPi * (kRadius * h * h - 2.0 / 3.0 * h * h * h);
    const double energy = kPi * (kRadius * h * h * h / 3.0 - h * h * h * h / 6.0);
    for (const Shape& table : {kTable, fine}) {
      const FieldSum sum = field_sum(table, kBall, X);
      EXPECT_NEAR(sum.field.force.z(), -force, tolerance * force) << h;
      EXPECT_NEAR(sum.field.energy, energy, tolerance * energy) << h;
    }
  }
}

TEST(PressureEllipsoid, EnergyIsTheIntegralOfTheDepth) {
  // The middles of a fine grid over the block.
  const FieldSum sum = field_sum(kEgg, kBlock, kCorner);
  ASSERT_GT(sum.field.energy, 0.0);
  constexpr int kCells = 120;
  const Vec3 half(0.1, 0.08, 0.06), h = 2.0 / kCells * half;
  double grid = 0.0;
  for (int i = 0; i < kCells * kCells * kCells; ++i) {
    const Vec3 place(i % kCells + 0.5, i / kCells % kCells + 0.5, i / kCells / kCells + 0.5);
    const double depth = -kSolid.signed_distance(kCorner * Vec3(place.cwiseProduct(h) - half));
    grid += std::max(0.0, depth) * h.prod();
  }
  EXPECT_NEAR(sum.field.energy, grid, 3e-3 * grid);
}

TEST(PressureEllipsoid, ForceIsTheGradientOfTheEnergy) {
  // From light contact to a mesh that holds the middle of the ellipsoid.
  const Shape bumpy = [] {
    test::Soup soup = test::bumpy_soup(3, 1);
    for (Vec3& v : soup.vertices) v *= 0.1;
    return test::mesh_of(soup);
  }();
  // The site only says where the couple is and which way is out: one of them serves all poses.
  PressureScratch scratch;
  for (const Shape& mesh : {kBlock, bumpy}) {
    const FieldSum light = field_sum(kEgg, mesh, kCorner);
    const PressureSite site{light.overlap.sites, 0, 0.5, {}};
    const Vec3 middle = site.metrics().centroid;
    for (const double way : {1.0, 0.7, 0.3}) {
      const Pose X{kCorner.rotation, way * kCorner.translation};
      const auto field_at = [&](const Pose& Y) {
        return pressure_ellipsoid(kEgg, mesh, Y, site, scratch);
      };
      const PressureField field = field_at(X);
      ASSERT_GT(field.energy, 0.0);
      const auto energy = [&](const Pose& Y) { return field_at(Y).energy; };
      const test::Gradient gradient = test::gradient_of_A(energy, X, 2e-5);
      const Vec3 couple = field.couple + middle.cross(field.force);
      EXPECT_LT((field.force + gradient.shift).norm(), 1e-4 * gradient.shift.norm()) << way;
      EXPECT_LT((couple + gradient.turn).norm(), 1e-3 * gradient.turn.norm()) << way;
    }
  }
}

TEST(PressureEllipsoid, ClosedLoopsTakeNoWork) {
  EXPECT_LT(test::loop_work(kEgg, kBlock, kCorner, test::cases(200, 50)), 1e-6);
}

TEST(PressureEllipsoid, ActionIsReaction) {
  const FieldSum on_a = field_sum(kEgg, kBlock, kCorner),
                 on_b = field_sum(kBlock, kEgg, kCorner.inverse());
  const double size = on_a.field.force.norm();
  EXPECT_LT((on_a.field.force + kCorner.rotation * on_b.field.force).norm(), kExact * size);
  EXPECT_NEAR(on_a.field.energy, on_b.field.energy, kExact * on_a.field.energy);
}

TEST(PressureEllipsoid, InsideOfAMeshItHasAllItsEnergyAndNoForce) {
  // Of a ball in shells: int (R - r) 4 pi r^2 dr = pi R^4 / 3.
  const Shape small = Ellipsoid({.semi_axes = {0.02, 0.02, 0.02}});
  const FieldSum sum = field_sum(small, kTable, {Mat3::Identity(), Vec3(0.01, 0.02, 0.0)});
  EXPECT_EQ(sum.overlap.total.status, Status::kContained);
  EXPECT_NEAR(sum.field.energy, kPi * std::pow(0.02, 4) / 3.0, 1e-6 * sum.field.energy);
  EXPECT_TRUE(sum.field.force.isZero(0.0));
}

}  // namespace
}  // namespace volcontact::pressure_ellipsoid_test
