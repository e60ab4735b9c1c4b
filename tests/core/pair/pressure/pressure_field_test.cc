// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/pressure/pressure_field.h"

#include <gtest/gtest.h>

#include "core/support/gradient.h"
#include "core/support/meshes.h"
#include "volcontact/pair/interference.h"

namespace volcontact::pressure_field_test {
namespace {

using test::Random;

const Shape kBox = Box({.half_sizes = {0.1, 0.08, 0.06}});
const Shape kWedge = ConvexPolytope(std::vector<Vec3>{{0.1, 0.1, -0.1},
                                                      {-0.1, 0.1, -0.1},
                                                      {0.1, -0.1, -0.1},
                                                      {-0.1, -0.1, -0.1},
                                                      {0.02, 0.0, 0.12},
                                                      {0.05, 0.03, 0.1}});
const Shape kBall = Sphere({.radius = 0.09});
const Shape kEgg = Ellipsoid({.semi_axes = {0.1, 0.07, 0.05}});
const Shape kPill = Capsule({.radius = 0.05, .half_length = 0.08});
const Shape kFloor = HalfSpace();
const Shape kRing = Torus({.major_radius = 0.1, .minor_radius = 0.02});

constexpr double kExact = 1e-9;   // closed sums; the differences of the energy lose digits
constexpr double kRound = 1e-5;   // the rule of two ellipsoids
constexpr double kShare = 0.4;    // of A's layer
constexpr double kLength = 0.05;  // [m] of the overlaps, to compare torques with forces

struct Overlap {
  Pose X_AB;
  VolumeMetrics site;
};

VolumeMetrics site_of(const Shape& a, const Shape& b, const Pose& X_AB) {
  InterferenceWorkspace workspace;
  Interference out;
  interference(a, b, X_AB, {.tolerance = 1e-6}, workspace, out);
  return out.total;
}

PressureField field_of(const Shape& a, const Shape& b, const Pose& X_AB, double share = kShare) {
  PressureScratch scratch;
  const VolumeMetrics site = site_of(a, b, X_AB);
  return pressure_field(a, b, X_AB, {{&site, 1}, 0, share, {}}, scratch);
}

std::vector<Overlap> overlaps(const Shape& a, const Shape& b, int count) {
  Random random(5);
  std::vector<Overlap> found;
  while (static_cast<int>(found.size()) < count) {
    Pose X_AB{random.rotation(), random.in_box(0.16)};
    if (std::holds_alternative<HalfSpace>(b)) X_AB.translation *= 0.5;
    const VolumeMetrics site = site_of(a, b, X_AB);
    const bool shallow = site.volume > 1e-7 && site.volume < 2e-4;
    if (shallow && site.status == Status::kOk) found.push_back({X_AB, site});
  }
  return found;
}

// The force and the couple are the gradient of the energy, which is summed apart from them.
void expect_gradient(const Shape& a, const Shape& b, double tolerance) {
  for (const Overlap& at : overlaps(a, b, 8)) {
    const PressureField field = field_of(a, b, at.X_AB);
    const auto energy = [&](const Pose& X_AB) { return field_of(a, b, X_AB).energy; };
    const test::Gradient gradient = test::gradient_of_A(energy, at.X_AB, 1e-5);
    const double size = field.force.norm();
    const Vec3 moment = field.couple + at.site.centroid.cross(field.force);
    EXPECT_LT((field.force + gradient.shift).norm(), tolerance * size);
    EXPECT_LT((moment + gradient.turn).norm(), tolerance * size * kLength);
  }
}

// Summed over B's part of the overlap instead of A's.
void expect_reaction(const Shape& a, const Shape& b, double tolerance) {
  for (const Overlap& at : overlaps(a, b, 8)) {
    const PressureField on_a = field_of(a, b, at.X_AB);
    const PressureField on_b = field_of(b, a, at.X_AB.inverse(), 1.0 - kShare);
    const Mat3& R_AB = at.X_AB.rotation;
    const double size = on_a.force.norm();
    EXPECT_LT((on_a.force + R_AB * on_b.force).norm(), tolerance * size);
    EXPECT_LT((on_a.couple + R_AB * on_b.couple).norm(), tolerance * size * kLength);
    EXPECT_NEAR(on_a.energy, on_b.energy, tolerance * on_a.energy);
  }
}

TEST(PressureField, ForceIsTheGradientOfTheEnergy) {
  expect_gradient(kBox, kBox, kExact);
  expect_gradient(kBox, kWedge, kExact);
  expect_gradient(kWedge, kBox, kExact);
  expect_gradient(kWedge, kWedge, kExact);
  expect_gradient(kBox, kFloor, kExact);
  expect_gradient(kBall, kBall, kExact);
  expect_gradient(kEgg, kEgg, kRound);
}

TEST(PressureField, ActionIsReaction) {
  expect_reaction(kBox, kBox, kExact);
  expect_reaction(kBox, kWedge, kExact);
  expect_reaction(kBall, kBall, kExact);
  expect_reaction(kEgg, kEgg, kRound);
}

TEST(PressureField, RigidSolidGetsTheReaction) {
  // All of the field in one, either way round.
  for (const Shape& solid : {kBox, kWedge, kEgg}) {
    for (const Overlap& at : overlaps(solid, solid, 4)) {
      const PressureField on_a = field_of(solid, solid, at.X_AB, 0.0);
      const PressureField on_b = field_of(solid, solid, at.X_AB.inverse(), 1.0);
      const double size = on_b.force.norm();
      ASSERT_GT(size, 0.0);
      const double tolerance = name_of(solid) == name_of(kEgg) ? kRound : kExact;
      EXPECT_LT((on_a.force + at.X_AB.rotation * on_b.force).norm(), tolerance * size);
      EXPECT_NEAR(on_a.energy, on_b.energy, tolerance * on_a.energy);
    }
  }
}

TEST(PressureField, HalfSpaceCarriesAllOfIt) {
  // Archimedes: k V through the centroid, whatever the share.
  for (const Shape& solid : {kBox, kWedge, kBall, kEgg, kPill}) {
    for (const Overlap& at : overlaps(solid, kFloor, 4)) {
      const PressureField field = field_of(solid, kFloor, at.X_AB, 0.9);
      EXPECT_LT((field.force - at.site.volume * at.site.normal()).norm(), 1e-8 * at.site.volume);
      EXPECT_TRUE(field.couple.isZero(0.0));
      EXPECT_NEAR(field.energy, at.site.depth_moment, 1e-8 * field.energy);
    }
  }
}

TEST(PressureField, FaceThatCarriesAllOfItIsAHalfSpace) {
  // A small box with its corner in the top of a large one; the small one is rigid.
  const Shape table = Box({.half_sizes = {1.0, 1.0, 0.5}});
  Pose X{rotation_about(Vec3(1.0, 2.0, 0.5).normalized(), 0.7), Vec3(0.1, -0.2, 0.6)};
  const PressureField field = field_of(table, kBox, X, 1.0);
  X.translation.z() -= 0.5;
  const PressureField floor = field_of(kFloor, kBox, X);
  ASSERT_GT(floor.energy, 0.0);
  EXPECT_NEAR(field.energy, floor.energy, 1e-12 * floor.energy);
  EXPECT_LT((field.force - floor.force).norm(), 1e-12 * floor.force.norm());
  EXPECT_LT(field.couple.norm(), 1e-12 * floor.force.norm());
}

TEST(PressureField, EnergyIsTheIntegralOfTheSofterLayer) {
  // The middles of a fine grid, with the distances of the shapes.
  const auto psi = [](const Shape& shape, const Vec3& x) {
    return -std::visit([&](const auto& solid) { return solid.signed_distance(x); }, shape);
  };
  for (const Shape& b : {kBox, kWedge}) {
    const Overlap at = overlaps(kBox, b, 3).back();
    const Pose X_BA = at.X_AB.inverse();
    constexpr int kCells = 160;
    const Vec3 variance = at.site.second_moment().diagonal() / at.site.volume;
    const Vec3 reach = 4.0 * variance.cwiseSqrt(), h = 2.0 / kCells * reach;
    double sum = 0.0;
    for (int i = 0; i < kCells * kCells * kCells; ++i) {
      const Vec3 place(i % kCells + 0.5, i / kCells % kCells + 0.5, i / kCells / kCells + 0.5);
      const Vec3 x = at.site.centroid + place.cwiseProduct(h) - reach;
      const double least = std::min(psi(kBox, x) / kShare, psi(b, X_BA * x) / (1.0 - kShare));
      sum += std::max(0.0, least) * h.prod();
    }
    EXPECT_NEAR(field_of(kBox, b, at.X_AB).energy, sum, 2e-3 * sum);
  }
}

TEST(PressureField, TwoBallsShareTheLens) {
  // Equal layers: twice the integral of 2 (R - r) over a cap of height h, in shells.
  constexpr double kRadius = 0.09, kHeight = 0.012;
  double half = 0.0;
  constexpr int kShells = 20000;
  for (int i = 0; i < kShells; ++i) {
    const double r = kRadius - kHeight * (i + 0.5) / kShells;
    const double area = 2.0 * kPi * r * (r - (kRadius - kHeight));
    half += 2.0 * (kRadius - r) * area * kHeight / kShells;
  }
  const Pose X_AB{Mat3::Identity(), Vec3(0.0, 0.0, 2.0 * (kRadius - kHeight))};
  const PressureField field = field_of(kBall, kBall, X_AB, 0.5);
  EXPECT_NEAR(field.energy, 2.0 * half, 1e-8 * field.energy);
}

TEST(PressureField, IdenticalBoxesInOnePlaceHaveNoForce) {
  const PressureField field = field_of(kBox, kBox, Pose{}, 0.5);
  EXPECT_TRUE(std::isfinite(field.energy));
  EXPECT_NEAR(field.force.norm(), 0.0, 1e-12);
}

TEST(PressureField, SaysWhichPairsItTakes) {
  EXPECT_TRUE(has_pressure_field(kBox, kWedge));
  EXPECT_TRUE(has_pressure_field(kEgg, kEgg));
  EXPECT_TRUE(has_pressure_field(kRing, kFloor));
  EXPECT_TRUE(has_pressure_field(kRing, kPill));
  EXPECT_TRUE(has_pressure_field(kWedge, kBall));
  EXPECT_TRUE(has_pressure_field(kWedge, kEgg));
  const Shape mesh = test::mesh_of(test::box_soup({0.1, 0.1, 0.1}));
  for (const Shape& other : {kWedge, kEgg, mesh}) EXPECT_TRUE(has_pressure_field(mesh, other));
  EXPECT_FALSE(has_pressure_field(kFloor, kFloor));
}

TEST(PressureField, SaysWhyItDoesNotTakeAPair) {
  // A solid of the user's meets a box through the octree alone.
  struct Cube {
    Aabb bounds() const { return {Vec3::Constant(-0.1), Vec3::Constant(0.1)}; }
    double signed_distance(const Vec3& p) const { return p.cwiseAbs().maxCoeff() - 0.1; }
  };
  const Shape cube = SignedDistance(Cube{});
  EXPECT_NE(why_no_pressure_field(kBox, cube).find("octree"), std::string::npos);
  EXPECT_TRUE(has_pressure_field(kBox, cube, Engine::kOctree));
  EXPECT_NE(why_no_pressure_field(cube, kEgg).find("neither has layers"), std::string::npos);
  PressureScratch scratch;
  const Pose near{Mat3::Identity(), Vec3(0.12, 0.0, 0.0)};
  const VolumeMetrics site = site_of(cube, kEgg, near);
  ASSERT_TRUE(site.touching());
  EXPECT_EQ(pressure_field(cube, kEgg, near, {{&site, 1}, 0, 0.5, {}}, scratch).energy, 0.0);
}

}  // namespace
}  // namespace volcontact::pressure_field_test
