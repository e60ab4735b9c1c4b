// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/pressure/pressure_layers.h"

#include <gtest/gtest.h>

#include "core/support/csg_solids.h"
#include "core/support/gradient.h"
#include "core/support/meshes.h"
#include "core/support/random_shapes.h"
#include "core/support/sanitized.h"

namespace volcontact::pressure_layers_test {
namespace {

using test::Random;

const Shape kBox = Box({.half_sizes = {0.1, 0.08, 0.06}});
const Shape kTable = Box({.half_sizes = {1.0, 1.0, 0.5}});
const Shape kFloor = HalfSpace();
const Shape kBall = Sphere({.radius = 0.09});
const Shape kEgg = Ellipsoid({.semi_axes = {0.1, 0.07, 0.05}});
const Shape kPill = Capsule({.radius = 0.05, .half_length = 0.08});
const Shape kRod = Cylinder({.radius = 0.06, .half_length = 0.08});
const Shape kCone = Frustum({.bottom_radius = 0.08, .top_radius = 0.03, .half_length = 0.07});
const Shape kRing = Torus({.major_radius = 0.1, .minor_radius = 0.03});
const Shape kWedge = ConvexPolytope(std::vector<Vec3>{{0.1, 0.1, -0.1},
                                                      {-0.1, 0.1, -0.1},
                                                      {0.1, -0.1, -0.1},
                                                      {-0.1, -0.1, -0.1},
                                                      {0.02, 0.0, 0.12},
                                                      {0.05, 0.03, 0.1}});
const Shape kBored = testing::box(.15, .15, .1) - testing::tube(.05, .2);

constexpr double kClosed = 1e-7;  // where every engine and the rule are good to many digits
constexpr double kRule = 2e-3;    // of the energy, where faces and edges put kinks into the levels
constexpr double kSlope = 1e-4;   // of the force against differences of the energy

/// The overlap of a pair with its sites, and the sum of the fields of all sites.
struct Sum {
  Interference overlap;
  PressureField field;  // couple about A's origin
  std::vector<Vec3> by_site;
};

Sum sum_of(const Shape& a, const Shape& b, const Pose& X_AB, double share = 0.4) {
  static InterferenceWorkspace workspace;
  static PressureScratch scratch;
  Sum sum;
  interference(a, b, X_AB, {.tolerance = 1e-5}, workspace, sum.overlap);
  const std::vector<VolumeMetrics>& sites = sum.overlap.sites;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const PressureField field = pressure_layers(a, b, X_AB, {sites, i, share, {}}, scratch);
    sum.field.energy += field.energy;
    sum.field.force += field.force;
    sum.field.couple += field.couple + sites[i].centroid.cross(field.force);
    sum.by_site.push_back(field.force);
  }
  return sum;
}

Pose tilted(double height) { return {test::turn({1.0, 2.0, 0.5}, 0.7), Vec3(0.1, -0.2, height)}; }

TEST(PressureLayers, FaceThatCarriesAllOfItIsAHalfSpace) {
  // Archimedes under the top of a large box, whatever the other solid is.
  for (const Shape& b : {kBall, kEgg, kPill, kRod, kCone, kRing, kWedge, kBored}) {
    // Corners put kinks into the levels.
    const bool corners = name_of(b) == name_of(kWedge) || name_of(b) == name_of(kBored);
    const double tolerance = corners ? kRule : 3e-5;
    const double height = bounds_of(b).half_sizes().norm() * 0.3;
    const Sum table = sum_of(kTable, b, tilted(0.5 + height), 1.0);
    PressureScratch scratch;
    Sum floor = sum_of(kFloor, b, tilted(height));
    ASSERT_EQ(floor.overlap.sites.size(), 1u) << name_of(b);
    const PressureField field =
        pressure_field(kFloor, b, tilted(height), {floor.overlap.sites, 0, 0.5, {}}, scratch);
    ASSERT_GT(field.energy, 0.0);
    const double size = field.force.norm();
    EXPECT_NEAR(table.field.energy, field.energy, tolerance * field.energy) << name_of(b);
    EXPECT_LT((table.field.force - field.force).norm(), tolerance * size) << name_of(b);
  }
}

TEST(PressureLayers, BallThatCarriesAllOfIt) {
  // int over the cap of the depth below the ball's surface: dU/dh = pi (R h^2 - 2 h^3 / 3).
  constexpr double kRadius = 0.09, kDepth = 0.01;
  const Pose X{Mat3::Identity(), Vec3(0.1, -0.2, 0.5 + kRadius - kDepth)};
  const Sum sum = sum_of(kTable, kBall, X, 0.0);
  const double h2 = kDepth * kDepth, h3 = h2 * kDepth;
  const double force = kPi * (kRadius * h2 - 2.0 / 3.0 * h3);
  EXPECT_NEAR(sum.field.force.z(), -force, kClosed * force);
  const double energy = kPi * (kRadius * h3 / 3.0 - h3 * kDepth / 6.0);
  EXPECT_NEAR(sum.field.energy, energy, kClosed * energy);
}

TEST(PressureLayers, TwoBallsShareTheLens) {
  // Equal layers: twice the integral of 2 (R - r) over a cap of height h, r from R - h to R.
  constexpr double kRadius = 0.09, kHeight = 0.012, kLow = kRadius - kHeight;
  const auto primitive = [](double r) {
    return kRadius * r * r * r / 3.0 - r * r * r * r / 4.0 - kLow * (kRadius * r * r / 2.0) +
           kLow * r * r * r / 3.0;
  };
  const double energy = 8.0 * kPi * (primitive(kRadius) - primitive(kLow));
  const Sum sum = sum_of(kBall, kBall, {Mat3::Identity(), Vec3(0.0, 0.0, 2.0 * kLow)}, 0.5);
  EXPECT_NEAR(sum.field.energy, energy, kClosed * energy);
}

TEST(PressureLayers, RodOnItsFaceIsAWinklerBed) {
  // The table carries all: U = A h^2 / 2, F = A h.
  constexpr double kDepth = 0.004;
  const double area = kPi * 0.06 * 0.06;
  const Sum sum = sum_of(kTable, kRod, {Mat3::Identity(), Vec3(0.3, 0.2, 0.58 - kDepth)}, 1.0);
  EXPECT_NEAR(sum.field.energy, 0.5 * area * kDepth * kDepth, kClosed * sum.field.energy);
  EXPECT_NEAR(sum.field.force.z(), -area * kDepth, kClosed * area * kDepth);
}

TEST(PressureLayers, EnergyIsTheIntegralOfTheSofterLayer) {
  // The middles of a fine grid, with the distances of the shapes.
  const auto psi = [](const Shape& shape, const Vec3& x) {
    return -std::visit([&](const auto& solid) { return solid.signed_distance(x); }, shape);
  };
  const Pose X{test::turn({1.0, 0.3, -0.4}, 0.9), Vec3(0.07, 0.06, 0.09)};
  for (const Shape& b : {kRod, kCone, kRing, kPill}) {
    const Sum sum = sum_of(kBox, b, X);
    ASSERT_GT(sum.field.energy, 0.0) << name_of(b);
    const VolumeMetrics& total = sum.overlap.total;
    constexpr int kCells = 100;
    const Vec3 variance = total.second_moment().diagonal() / total.volume;
    const Vec3 reach = 4.0 * variance.cwiseSqrt(), h = 2.0 / kCells * reach;
    const Pose X_BA = X.inverse();
    double grid = 0.0;
    for (int i = 0; i < kCells * kCells * kCells; ++i) {
      const Vec3 place(i % kCells + 0.5, i / kCells % kCells + 0.5, i / kCells / kCells + 0.5);
      const Vec3 x = total.centroid + place.cwiseProduct(h) - reach;
      grid += std::max(0.0, std::min(psi(kBox, x) / 0.4, psi(b, X_BA * x) / 0.6)) * h.prod();
    }
    EXPECT_NEAR(sum.field.energy, grid, kRule * grid) << name_of(b);
  }
}

// Work over a closed path round an edge, over the largest energy.
double loop_work(const Shape& a, const Shape& b, const Pose& X_AB, int samples = 60) {
  const Vec3 u(0.004, 0.002, -0.003), v(-0.001, 0.004, 0.002), axis(0.05, -0.03, 0.06);
  double work = 0.0, most = 0.0;
  for (int i = 0; i < samples; ++i) {
    const double s = 2.0 * kPi * i / samples;
    const Pose X = test::moved({X_AB.rotation, Vec3::Zero()}, Vec3::Zero(), std::sin(s) * axis);
    const Vec3 place = X_AB.translation + std::cos(s) * u + std::sin(2.0 * s) * v;
    const Vec3 velocity = -std::sin(s) * u + 2.0 * std::cos(2.0 * s) * v;
    const Vec3 rotation = std::cos(s) * axis;
    const Sum sum = sum_of(a, b, {X.rotation, place});
    const Vec3 couple = sum.field.couple - place.cross(sum.field.force);  // about B's origin
    work -= 2.0 * kPi / samples * (sum.field.force.dot(velocity) + couple.dot(rotation));
    most = std::max(most, sum.field.energy);
  }
  EXPECT_GT(most, 0.0) << name_of(a) << " " << name_of(b);
  return std::abs(work) / most;
}

TEST(PressureLayers, ClosedLoopsTakeNoWork) {
  const Pose corner{test::turn({1.0, 0.3, -0.4}, 0.9), Vec3(0.1, 0.08, 0.1)};
  for (const Shape& b : {kBall, kEgg, kCone, kRod}) {
    // Edges of both need more samples of the path.
    const bool edges = name_of(b) == name_of(kCone) || name_of(b) == name_of(kRod);
    if (edges && test::kSanitized) continue;
    EXPECT_LT(loop_work(kBox, b, corner, edges ? 300 : 60), 1e-6) << name_of(b);
  }
  if (test::kSanitized) return;
  // Where lines leave some hundred-thousandths of the area vector in places.
  EXPECT_LT(loop_work(kBox, kPill, corner), 3e-5);
  EXPECT_LT(loop_work(kWedge, kBall, corner), 3e-5);
  const Pose beside{test::turn({1.0, 0.3, -0.4}, 0.9), Vec3(0.05, 0.04, 0.06)};
  EXPECT_LT(loop_work(kRod, kPill, beside), 1e-6);
  EXPECT_LT(loop_work(kRing, kRod, beside), 4e-5);
  const Pose over_rim{Mat3::Identity(), Vec3(0.06, 0.01, 0.16)};
  EXPECT_LT(loop_work(kBored, kBall, over_rim), 5e-6);
}

TEST(PressureLayers, MeshesAreServedByColumns) {
  // The same block as a mesh, which carries nothing, and as a polytope, which does not either.
  const Shape mesh = test::mesh_of(test::box_soup({0.1, 0.08, 0.06}, 3));
  const Shape block = test::polytope_of(Box({.half_sizes = {0.1, 0.08, 0.06}}));
  const Pose corner{test::turn({1.0, 0.3, -0.4}, 0.9), Vec3(0.1, 0.08, 0.1)};
  for (const Shape& b : {kRod, kBall}) {
    const Sum one = sum_of(mesh, b, corner), other = sum_of(block, b, corner);
    const double size = other.field.force.norm();
    EXPECT_NEAR(one.field.energy, other.field.energy, kSlope * other.field.energy) << name_of(b);
    EXPECT_LT((one.field.force - other.field.force).norm(), 10.0 * kSlope * size) << name_of(b);
  }
  EXPECT_LT(loop_work(mesh, kBox, corner), 1e-6);
}

TEST(PressureLayers, ComposedSolidsShareLikeTheirMembers) {
  // A rod with a small bore that the other one does not reach is the rod, but for its layer there.
  const Shape plain = testing::tube(.06, .08), block = testing::box(.1, .08, .06);
  const Pose corner{test::turn({1.0, 0.3, -0.4}, 0.9), Vec3(0.1, 0.08, 0.1)};
  const Sum one = sum_of(block, plain, corner), other = sum_of(kBox, kRod, corner);
  const double size = other.field.force.norm();
  ASSERT_GT(size, 0.0);
  EXPECT_NEAR(one.field.energy, other.field.energy, kSlope * other.field.energy);
  EXPECT_LT((one.field.force - other.field.force).norm(), 10.0 * kSlope * size);
  // The other one rigid: an ellipsoid on a face far from the bore is on a box.
  const Pose on_top{Mat3::Identity(), Vec3(0.1, 0.1, 0.148)};
  const Shape block_top = Box({.half_sizes = {.15, .15, .1}});
  const Sum bored = sum_of(kBored, kEgg, on_top), solid = sum_of(block_top, kEgg, on_top);
  ASSERT_GT(solid.field.energy, 0.0);
  EXPECT_NEAR(bored.field.energy, solid.field.energy, kSlope * solid.field.energy);
}

TEST(PressureLayers, PegInABoreHasTwoSites) {
  const Shape peg = Cylinder({.radius = 0.049, .half_length = 0.12});
  const Pose X{test::turn({0.0, 1.0, 0.0}, 0.02), Vec3(0.0001, 0.0, 0.0)};
  const Sum sum = sum_of(kBored, peg, X);
  ASSERT_EQ(sum.by_site.size(), 2u);
  // They push against each other, and together turn the peg back.
  EXPECT_LT(sum.by_site[0].dot(sum.by_site[1]), 0.0);
  const auto energy = [&](const Pose& Y) { return sum_of(kBored, peg, Y).field.energy; };
  const test::Gradient gradient = test::gradient_of_A(energy, X, 1e-6);
  EXPECT_LT((sum.field.couple + gradient.turn).norm(), 1e-3 * gradient.turn.norm());
}

TEST(PressureLayers, ActionIsReaction) {
  const Pose X{test::turn({1.0, 0.3, -0.4}, 0.9), Vec3(0.1, 0.08, 0.1)};
  for (const Shape& b : {kBall, kEgg, kRod, kCone, kRing}) {
    const Sum on_a = sum_of(kBox, b, X, 0.3), on_b = sum_of(b, kBox, X.inverse(), 0.7);
    const double size = on_a.field.force.norm();
    ASSERT_GT(size, 0.0) << name_of(b);
    EXPECT_LT((on_a.field.force + X.rotation * on_b.field.force).norm(), kSlope * size)
        << name_of(b);
    EXPECT_NEAR(on_a.field.energy, on_b.field.energy, 1e-5 * on_a.field.energy);
  }
}

TEST(PressureLayers, RodThatLiesDeepInsideIsPushedOut) {
  // Contained: no direction for k V, but the layers of the box still press on one side.
  const Shape rod = Cylinder({.radius = 0.01, .half_length = 0.02});
  const Sum sum = sum_of(kBox, rod, {Mat3::Identity(), Vec3(0.0, 0.0, 0.035)}, 1.0);
  EXPECT_EQ(sum.overlap.total.status, Status::kContained);
  const double volume = kPi * 0.01 * 0.01 * 0.04;
  EXPECT_NEAR(sum.field.force.z(), -volume, 2e-2 * volume);  // Archimedes below the top
}

}  // namespace
}  // namespace volcontact::pressure_layers_test
