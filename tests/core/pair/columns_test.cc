// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/columns.h"

#include <gtest/gtest.h>

#include "core/support/evaluated.h"
#include "core/support/gradient.h"
#include "core/support/matchers.h"
#include "core/support/meshes.h"

namespace volcontact {
namespace {

using test::box_soup;
using test::evaluated;
using test::mesh_of;
using test::Random;
using test::shifted;
using test::Soup;

double sum_of_sites(const Interference& out) {
  double sum = 0.0;
  for (const VolumeMetrics& site : out.sites) sum += site.volume;
  return sum;
}

// Two bodies that touch each other by `depth` along a direction that nothing is aligned with.
struct Touching {
  Mesh a, b;
  Pose X_AB;
};
Touching bumpy_pair(int levels, double depth) {
  const Soup a = test::bumpy_soup(levels, 1), b = test::bumpy_soup(levels, 2);
  const Vec3 n = Vec3(0.3, -0.5, 0.8).normalized();
  const Mat3 turned = test::turn(Vec3(1.0, 2.0, 3.0), 0.7);
  Touching pair{mesh_of(a), mesh_of(b), {turned, Vec3::Zero()}};
  double apart = 3.0, together = 1.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (apart + together);
    pair.X_AB.translation = middle * n;
    (evaluated(pair.a, pair.b, pair.X_AB).total.touching() ? together : apart) = middle;
  }
  pair.X_AB.translation = (together - depth) * n;
  return pair;
}

// Clipping of the boxes themselves is the oracle; fields that do not depend on how a surface that
// is folded along the normal is counted.
TEST(Columns, MeshesOfBoxesMeetAsTheBoxes) {
  Random random(1);
  int touching = 0;
  for (int i = 0; i < 400; ++i) {
    const Vec3 half_a = Vec3::Constant(0.8) + random.in_box(0.4),
               half_b = Vec3::Constant(0.5) + random.in_box(0.3);
    const Box box_a({.half_sizes = half_a}), box_b({.half_sizes = half_b});
    const Mesh a = mesh_of(box_soup(half_a, 1 + i % 4)), b = mesh_of(box_soup(half_b, 1 + i % 3));
    const Pose X_AB = random.pose(1.2);
    VolumeMetrics expected = evaluated(box_a, box_b, X_AB).total;
    if (expected.volume > 0.0 && expected.volume < 1e-9) continue;
    touching += expected.touching();
    for (const Interference& out : {evaluated(a, b, X_AB), evaluated(a, Shape(box_b), X_AB),
                                    evaluated(Shape(box_a), b, X_AB)}) {
      EXPECT_EQ(out.engine, Engine::kColumns);
      VolumeMetrics found = out.total;
      found.depth_moment = expected.depth_moment;
      found.depth = expected.depth;
      EXPECT_TRUE(test::same(found, expected, {1e-10, 2.0})) << i;
      EXPECT_LE(std::abs(found.volume - expected.volume),
                found.volume_error + expected.volume_error);
    }
  }
  EXPECT_GT(touching, 200);
}

TEST(Columns, ShallowBoxesHaveTheDepthOfTheBoxes) {
  const Vec3 half(0.5, 0.4, 0.3);
  const Mesh mesh = mesh_of(box_soup(half, 3));
  const Box box({.half_sizes = half}), ground({.half_sizes = Vec3(2.0, 2.0, 1.0)});
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    Pose X_AB = random.pose(0.3);
    const double reach = box.support_height(-X_AB.rotation.row(2).transpose());
    X_AB.translation.z() = 1.0 + reach - 0.01;
    EXPECT_TRUE(test::same(evaluated(Shape(ground), mesh, X_AB).total,
                           evaluated(ground, box, X_AB).total, {1e-9, 1.0}));
  }
}

TEST(Columns, HalfSpaceCutsAMeshAsItCutsTheBox) {
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    const Vec3 half = Vec3::Constant(0.6) + random.in_box(0.4);
    const Box box({.half_sizes = half});
    const Mesh mesh = mesh_of(box_soup(half, 1 + i % 5));
    const Pose X_AB = random.pose(0.9);
    const VolumeMetrics expected = evaluated(HalfSpace(), box, X_AB).total;
    const Interference out = evaluated(HalfSpace(), mesh, X_AB);
    if (expected.volume > 0.0 && expected.volume < 1e-9) continue;
    if (expected.status == Status::kContained) {
      EXPECT_NEAR(out.total.volume, expected.volume, 1e-13);
      EXPECT_NEAR(out.total.depth_moment, expected.depth_moment, 1e-12);
      EXPECT_LE(out.total.area_vector.norm(), 1e-13);
      continue;
    }
    EXPECT_TRUE(test::same(out.total, expected, {1e-10, 2.0})) << i;
  }
}

TEST(Columns, AreaVectorAndMomentAreTheGradientOfTheVolume) {
  const Touching pair = bumpy_pair(3, 0.03);
  const VolumeMetrics m = evaluated(pair.a, pair.b, pair.X_AB).total;
  const auto volume = [&](const Pose& X_AB) {
    return evaluated(pair.a, pair.b, X_AB).total.volume;
  };
  const test::Gradient gradient = test::gradient_of_A(volume, pair.X_AB, 1e-4);
  EXPECT_LE((gradient.shift - m.area_vector).norm(), 1e-8);
  EXPECT_LE((gradient.turn - m.area_moment).norm(), 1e-8);
}

TEST(Columns, ValueDependsNeitherOnTheOrderNorOnThePlace) {
  const Touching pair = bumpy_pair(3, 0.02);
  const VolumeMetrics m = evaluated(pair.a, pair.b, pair.X_AB).total;
  VolumeMetrics other = evaluated(pair.b, pair.a, pair.X_AB.inverse()).total;
  EXPECT_TRUE(test::same(reversed(transformed(other, pair.X_AB)), m, {1e-11, 1.0}));
  // The same solid from a mesh written in another frame.
  Random random(4);
  const Pose X_BM = random.pose(1.0);
  const Soup turned = test::bumpy_soup(3, 2).moved(X_BM.inverse());
  other = evaluated(pair.a, mesh_of(turned), pair.X_AB * X_BM).total;
  EXPECT_TRUE(test::same(other, m, {1e-10, 1.0}));
}

TEST(Columns, DeepOverlapOfABodyWithItselfIsTheBody) {
  const Mesh mesh = mesh_of(test::bumpy_soup(2, 5));
  const Interference out = evaluated(mesh, mesh, Pose{});
  EXPECT_NEAR(out.total.volume, mesh.own_metrics().volume, 1e-13);
  EXPECT_LE((out.total.centroid - mesh.own_metrics().centroid).norm(), 1e-13);
  EXPECT_LE((out.total.inertia - mesh.own_metrics().inertia).norm(), 1e-12);
}

TEST(Columns, FlushFacesDoNotDisturb) {
  const Mesh mesh = mesh_of(box_soup(Vec3::Ones(), 3)), other = mesh_of(box_soup(Vec3::Ones(), 2));
  for (double overlap : {1e-3, 1e-6, 1e-9, 0.0, -1e-9}) {
    const Interference out = evaluated(mesh, other, shifted(0.0, 0.0, 2.0 - overlap));
    EXPECT_NEAR(out.total.volume, 4.0 * std::max(0.0, overlap), 8e-14) << overlap;
    if (overlap >= 1e-6) {
      EXPECT_LE((out.total.area_vector - Vec3(0.0, 0.0, 4.0)).norm(), 1e-9) << overlap;
      EXPECT_EQ(out.sites.size(), 1u);
    }
  }
}

TEST(Columns, ABodyInsideOfAnotherIsContained) {
  const Mesh outer = mesh_of(test::bumpy_soup(3, 1)),
             inner = mesh_of(box_soup(Vec3(0.2, 0.3, 0.1)));
  const Pose X_AB = shifted(0.1, 0.2, -0.1);
  const Interference out = evaluated(outer, inner, X_AB);
  EXPECT_EQ(out.total.status, Status::kContained);
  EXPECT_NEAR(out.total.volume, 0.048, 1e-15);
  EXPECT_LE((out.total.centroid - X_AB.translation).norm(), 1e-14);
  EXPECT_EQ(out.total.area_vector, Vec3::Zero());
  EXPECT_NEAR(out.total.counter_area, inner.surface_area(), 1e-13);
  EXPECT_EQ(evaluated(inner, outer, X_AB.inverse()).total.status, Status::kContained);
}

TEST(Columns, LinkedRingsThatDoNotTouchHaveNoOverlap) {
  const Mesh ring = mesh_of(test::ring_soup(0.7, 1.0, 0.15, 60));
  const Pose X_AB{test::turn(Vec3::UnitX(), 0.5 * kPi), Vec3(0.85, 0.0, 0.0)};
  const Interference out = evaluated(ring, ring, X_AB);
  EXPECT_EQ(out.total.volume, 0.0);
  EXPECT_TRUE(out.sites.empty());
}

TEST(Columns, CavitiesHoldNothing) {
  const Mesh hollow = mesh_of(test::ball_soup(3).with(
      test::ball_soup(2).moved({0.6 * Mat3::Identity(), Vec3::Zero()}).inside_out()));
  const double wall = hollow.own_metrics().volume;
  const Mesh ball = mesh_of(test::ball_soup(1).moved({0.2 * Mat3::Identity(), Vec3::Zero()}));
  EXPECT_EQ(evaluated(hollow, ball, Pose{}).total.volume, 0.0);
  // A ball around it, and one that cuts the outer surface only.
  const Mesh large = mesh_of(box_soup(Vec3::Constant(1.5)));
  EXPECT_NEAR(evaluated(hollow, large, Pose{}).total.volume, wall, 1e-13);
  const Interference cut = evaluated(hollow, large, shifted(0.7, 0.0, 0.0));
  const Mesh full = mesh_of(test::ball_soup(3)),
             core = mesh_of(test::ball_soup(2).moved({0.6 * Mat3::Identity(), Vec3::Zero()}));
  EXPECT_NEAR(
      cut.total.volume,
      evaluated(full, large, shifted(0.7, 0.0, 0.0)).total.volume - core.own_metrics().volume,
      1e-13);
  EXPECT_NEAR(sum_of_sites(cut), cut.total.volume, 1e-15);
  // A ball that touches the wall from within.
  const Interference touching = evaluated(hollow, ball, shifted(0.0, 0.0, 0.42));
  EXPECT_GT(touching.total.volume, 0.0);
  EXPECT_LT(touching.total.volume, 2e-3);
  EXPECT_GT(std::abs(touching.total.normal().z()), 0.99);
}

TEST(Columns, EachFootIsASite) {
  Soup table = box_soup(Vec3(1.0, 1.0, 0.1));
  for (double x : {-0.8, 0.8}) {
    for (double y : {-0.8, 0.8}) {
      table = table.with(box_soup(Vec3(0.1, 0.1, 0.3)).moved(shifted(x, y, -0.5)));
    }
  }
  const Mesh mesh = mesh_of(table), plate = mesh_of(box_soup(Vec3(2.0, 2.0, 0.1)));
  const Pose X_AB = shifted(0.0, 0.0, -0.9 + 0.004);
  for (const Interference& out :
       {evaluated(mesh, plate, X_AB), evaluated(mesh, HalfSpace(), shifted(0.0, 0.0, -0.796))}) {
    ASSERT_EQ(out.sites.size(), 4u);
    for (const VolumeMetrics& site : out.sites) {
      EXPECT_NEAR(site.volume, 0.04 * 0.004, 1e-15);
      EXPECT_NEAR(std::abs(site.centroid.x()), 0.8, 1e-13);
      EXPECT_NEAR(site.depth, 0.004, 1e-13);
      EXPECT_NEAR(site.depth_moment, 0.5 * 0.04 * 0.004 * 0.004, 1e-16);
      EXPECT_NEAR(site.normal().z(), 1.0, 1e-13);
      EXPECT_NEAR(site.area, 0.04 + 0.8 * 0.004, 1e-13);
      EXPECT_NEAR(site.counter_area, 0.04, 1e-13);
    }
  }
}

TEST(Columns, ATiltedPegTouchesItsHoleAtTwoSites) {
  const Mesh sleeve = mesh_of(test::ring_soup(1.0, 2.0, 1.0, 64));
  const Mesh peg = mesh_of(test::ring_soup(0.5, 0.97, 2.0, 64));
  EXPECT_EQ(evaluated(sleeve, peg, Pose{}).total.volume, 0.0);
  const Interference out = evaluated(sleeve, peg, {test::turn(Vec3::UnitY(), 0.05), Vec3::Zero()});
  ASSERT_EQ(out.sites.size(), 2u);
  EXPECT_NEAR(out.sites[0].volume, out.sites[1].volume, 1e-12);
  EXPECT_LT(out.sites[0].normal().dot(out.sites[1].normal()), -0.99);
  EXPECT_LE(out.total.area_vector.norm(), 1e-12);
}

// A polygon with few sides has several patches side by side on one wall: each is summed through a
// window that holds cells of its neighbours.
TEST(Columns, PatchesSideBySideNeedNoMoreColumns) {
  const Mesh sleeve = mesh_of(test::ring_soup(1.0, 2.0, 1.0, 96));
  const Mesh peg = mesh_of(test::ring_soup(0.5, 0.998, 2.0, 32));
  const Pose X_AB{test::turn(Vec3::UnitZ(), 0.37) * test::turn(Vec3::UnitX(), 0.002),
                  Vec3(0.0015, 0.0005, 0.0)};
  const Interference all = evaluated(sleeve, peg, X_AB, {.most_cells = 10000000});
  ASSERT_GT(all.sites.size(), 4u);
  const Interference few = evaluated(sleeve, peg, X_AB, {.most_cells = 1500});
  EXPECT_EQ(few.total.status, Status::kOk);
  EXPECT_NEAR(few.total.volume, all.total.volume, 1e-12 * all.total.volume);
}

TEST(Columns, SamplesThatSeeNothingAreNoProof) {
  // A thin overlap of two surfaces in nearly the same place, beyond any budget.
  const Mesh outer = mesh_of(test::ball_soup(3)),
             inner = mesh_of(test::ball_soup(3).inside_out().with(
                 test::ball_soup(2).moved({1.2 * Mat3::Identity(), Vec3::Zero()})));
  const Interference out =
      evaluated(outer, inner, {test::turn(Vec3(1.0, 2.0, 3.0), 1e-6), Vec3::Constant(1e-9)},
                {.most_cells = 20});
  EXPECT_EQ(out.total.status, Status::kApproximate);
  EXPECT_GT(out.total.volume_error, 0.0);
}

TEST(Columns, BeyondItsBudgetItSamplesAndSaysSo) {
  const Mesh mesh = mesh_of(test::ball_soup(4));
  const Pose X_AB{test::turn(Vec3(1.0, 2.0, 3.0), 0.4), Vec3(1e-3, 2e-3, 1e-3)};
  const Interference exact = evaluated(mesh, mesh, X_AB, {.most_cells = 1000000});
  const Interference sampled = evaluated(mesh, mesh, X_AB, {.most_cells = 100});
  EXPECT_EQ(exact.total.status, Status::kOk);
  EXPECT_EQ(sampled.total.status, Status::kApproximate);
  EXPECT_LE(std::abs(sampled.total.volume - exact.total.volume), sampled.total.volume_error);
  EXPECT_LE(sampled.total.volume_error, 0.05 * exact.total.volume);
  EXPECT_LE((sampled.total.centroid - exact.total.centroid).norm(), 1e-2);
}

TEST(Columns, EveryInstructionSetMakesTheSameBits) {
  const Touching pair = bumpy_pair(3, 0.02);
  ObbTree unused;
  std::vector<VolumeMetrics> results;
  for (SimdPath path : {SimdPath::kPortable, SimdPath::kAvx2, SimdPath::kAvx512}) {
    if (!can_run(path)) continue;
    ColumnsScratch scratch;
    scratch.crossing.path = path;
    scratch.cells.path = path;
    Interference out;
    columns_interference(surface_of(pair.a, unused), surface_of(pair.b, unused), pair.X_AB, {},
                         scratch, out);
    results.push_back(out.total);
  }
  for (const VolumeMetrics& m : results) {
    EXPECT_TRUE(test::same(m, results[0], {0.0, 0.0}));
  }
}

}  // namespace
}  // namespace volcontact
