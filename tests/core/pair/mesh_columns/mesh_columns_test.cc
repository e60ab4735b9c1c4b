// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/mesh_columns.h"

#include <gtest/gtest.h>

#include "core/support/evaluated.h"
#include "core/support/gradient.h"
#include "core/support/matchers.h"
#include "core/support/meshes.h"
#include "core/support/random_shapes.h"
#include "core/support/sanitized.h"

namespace volcontact::mesh_columns_test {
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
  for (int i = 0; i < test::cases(400, 60); ++i) {
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
  EXPECT_GT(touching, test::cases(200, 30));
}

TEST(Columns, ShallowBoxesHaveTheDepthOfTheBoxes) {
  const Vec3 half(0.5, 0.4, 0.3);
  const Mesh mesh = mesh_of(box_soup(half, 3));
  const Box box({.half_sizes = half}), ground({.half_sizes = Vec3(2.0, 2.0, 1.0)});
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    Pose X_AB = random.pose(0.3);
    const double reach = box.support_height(-X_AB.rotation.row(2));
    X_AB.translation.z() = 1.0 + reach - 0.01;
    EXPECT_TRUE(test::same(evaluated(Shape(ground), mesh, X_AB).total,
                           evaluated(ground, box, X_AB).total, {1e-9, 1.0}));
  }
}

TEST(Columns, HalfSpaceCutsAMeshAsItCutsTheBox) {
  Random random(3);
  for (int i = 0; i < test::cases(300, 50); ++i) {
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

// How far off a flush place bodies are put: from nothing through rounding to what is seen.
constexpr double kOffsets[] = {0.0, 1e-17, 1e-16, 1e-15, 1e-13, 1e-11, 1e-9, 1e-7, 1e-6};

// A block between two planes: of its height what lies between them is left.
TEST(Columns, AMeshFlushWithTwoOppositeFacesCountsOnce) {
  const double h = 0.03, r = 0.034;
  Random random(31);
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 half(0.05, 0.05, 0.05);
    half[axis] = h;
    half[(axis + 1) % 3] = 0.04;
    const Box box({.half_sizes = half});
    const std::vector<Shape> others = {box, test::polytope_of(box), mesh_of(box_soup(half)),
                                       mesh_of(box_soup(half, 3))};
    for (int sides = 3; sides <= 8; ++sides) {
      // A prism of that many sides from face to face; in its plane it stays away from the others.
      const double base = 0.5 * sides * r * r * std::sin(2.0 * kPi / sides);
      const Pose up{basis_with_z(Vec3::Unit(axis)), Vec3::Zero()};
      const Mesh prism = mesh_of(test::regular_prism_soup(sides, r, h).moved(up));
      for (const Shape& other : others) {
        for (double off : kOffsets) {
          for (double sign : {-1.0, 0.0, 1.0}) {
            Vec3 shift = random.in_box(1.0).cwiseProduct(half - Vec3::Constant(1.1 * r));
            if (sign == 0.0) shift.setZero();
            shift[axis] = sign * off;
            const double expected = base * (2.0 * h - std::abs(shift[axis]));
            for (const Interference& out : {evaluated(prism, other, {Mat3::Identity(), shift}),
                                            evaluated(other, prism, {Mat3::Identity(), -shift})}) {
              EXPECT_NEAR(out.total.volume, expected, 1e-13 * expected) << axis << sides << off;
              EXPECT_NEAR(sum_of_sites(out), out.total.volume, 1e-15 * expected);
            }
          }
        }
      }
    }
  }
}

// The octahedron lies in the box, some of its corners on the walls: all of it counts, once.
TEST(Columns, ABodyThatTouchesOppositeWallsFromWithinCountsOnce) {
  Soup soup;
  for (int i = 0; i < 6; ++i) soup.vertices.push_back((i & 1 ? -0.14 : 0.14) * Vec3::Unit(i / 2));
  for (int i = 0; i < 8; ++i) {
    const int x = i & 1, y = 2 + (i >> 1 & 1), z = 4 + (i >> 2 & 1);
    const bool turned = (x + y + z) % 2 != 0;
    soup.triangles.push_back({x, turned ? z : y, turned ? y : z});
  }
  const double expected = 4.0 / 3.0 * 0.14 * 0.14 * 0.14;
  Random random(32);
  for (int walls = 0; walls < 8; ++walls) {
    Vec3 half;
    for (int k = 0; k < 3; ++k) half[k] = (walls >> k & 1) != 0 ? 0.14 : 0.21;
    for (int turn = 0; turn < 20; ++turn) {
      const Pose X_WM{turn == 0 ? Mat3(Mat3::Identity()) : random.pose(0.0).rotation, Vec3::Zero()};
      const Mesh a = mesh_of(box_soup(half).moved(X_WM)), b = mesh_of(soup.moved(X_WM));
      for (double off : {0.0, 1e-17, 1e-16, 1e-15}) {
        const Pose X_AB = shifted(-off, 0.0, off);
        EXPECT_NEAR(evaluated(a, b, X_AB).total.volume, expected, 1e-12 * expected) << walls;
        EXPECT_NEAR(evaluated(b, a, X_AB).total.volume, expected, 1e-12 * expected) << walls;
      }
    }
  }
}

// Clipping of its three boxes is the oracle. Tilts and shifts from rounding on: faces of the two
// bodies that nearly coincide, seen nearly edge on.
TEST(Columns, ABlockFlushInAChannelMeetsItAsItsBoxes) {
  const double unit = 0.1, depth = 0.2;
  const Soup channel = test::channel_soup(unit, depth);
  Random random(33);
  const auto one_of = [&](std::initializer_list<double> list) {
    return list
        .begin()[static_cast<int>(random.uniform(0.0, 0.999) * static_cast<double>(list.size()))];
  };
  int touching = 0;
  for (int i = 0; i < test::cases(1500, 250); ++i) {
    Vec3 size, shift;
    for (int k = 0; k < 3; ++k) {
      size[k] = unit * one_of({1.0, 2.0, 3.0, 4.0, 5.0, 6.0});
      shift[k] = (k == 0   ? 0.3
                  : k == 1 ? 0.25
                           : 0.2) *
                     one_of({-1.0, 0.0, 1.0}) +
                 0.5 * size[k] * one_of({-1.0, 0.0, 1.0}) +
                 one_of({0.0, 1e-15, 1e-12, 1e-9, 1e-7}) * one_of({-1.0, 0.0, 1.0});
    }
    const Pose X_AB{test::turn(random.direction(), std::pow(10.0, random.uniform(-15.0, -3.0))),
                    shift};
    double expected = 0.0, doubt = 5e-16;
    for (const auto& [middle, half] : test::channel_boxes(unit, depth)) {
      const Pose X{X_AB.rotation, X_AB.translation - middle};
      const VolumeMetrics m =
          evaluated(Box({.half_sizes = half}), Box({.half_sizes = 0.5 * size}), X).total;
      expected += m.volume;
      doubt += m.volume_error;
    }
    touching += expected > 0.0;
    // In frames that nothing is aligned with.
    const Pose X_WM{random.pose(0.0).rotation, Vec3::Zero()};
    const Mesh a = mesh_of(channel.moved(X_WM)), b = mesh_of(box_soup(0.5 * size).moved(X_WM));
    const Pose X = X_WM * X_AB * X_WM.inverse();
    for (const Interference& out : {evaluated(a, b, X), evaluated(b, a, X.inverse())}) {
      EXPECT_NEAR(out.total.volume, expected, doubt + out.total.volume_error) << i;
      EXPECT_LE(out.total.volume_error, 1e-12) << i;
    }
  }
  EXPECT_GT(touching, test::cases(500, 80));
}

// The window on the patch holds the arm of the channel in part, below what it looks at.
TEST(Columns, AnArmBelowTheWindowIsNoPartOfThePatch) {
  const double unit = 0.07, depth = 0.07;
  const Mesh channel = mesh_of(test::channel_soup(unit, depth));
  Soup soup = box_soup(Vec3(0.21, 0.21, 0.21));
  Random random(34);
  for (int i = 0; i < test::cases(400, 60); ++i) {
    const double off = std::pow(10.0, random.uniform(-17.0, -1.0));
    const Pose X_AB{
        test::turn(random.direction(), off * random.uniform(-1.0, 1.0)) *
            test::turn(Vec3::UnitZ(), 0.25 * kPi * static_cast<int>(random.uniform(0.0, 7.999))),
        Vec3(-0.105, -0.035, 0.0) + off * random.in_box(0.1)};
    double expected = 0.0;
    for (const auto& [middle, half] : test::channel_boxes(unit, depth)) {
      const Pose X{X_AB.rotation, X_AB.translation - middle};
      expected +=
          evaluated(Box({.half_sizes = half}), Box({.half_sizes = Vec3(0.21, 0.21, 0.21)}), X)
              .total.volume;
    }
    EXPECT_NEAR(evaluated(channel, mesh_of(soup), X_AB).total.volume, expected, 1e-11 * expected)
        << i;
  }
}

TEST(Columns, TheSameSurfaceTwiceIsExactWhateverItsSize) {
  const Soup soup = test::bumpy_soup(test::cases(6, 4), 5);  // 81,920 triangles, or 5,120
  const Mesh mesh = mesh_of(soup);
  Random random(35);
  const Pose X_AB = random.pose(0.4);
  for (const Interference& out : {evaluated(mesh, mesh, Pose{}),
                                  evaluated(mesh, mesh_of(soup.moved(X_AB.inverse())), X_AB)}) {
    const VolumeMetrics own = mesh.own_metrics();
    EXPECT_EQ(out.total.status, Status::kContained);
    EXPECT_NEAR(out.total.volume, own.volume, 1e-13 * own.volume);
    EXPECT_LE((out.total.centroid - own.centroid).norm(), 1e-13);
    EXPECT_LE(std::abs(out.total.volume - own.volume), out.total.volume_error);
    EXPECT_LE(out.total.volume_error, 1e-11 * own.volume);
    EXPECT_EQ(out.sites.size(), 1u);
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

// Beside a patch that goes 70 degrees to either side of a pin, the hole reaches below its window.
TEST(Columns, PatchesFarAroundAPinNeedNoMoreColumns) {
  const Mesh sleeve = mesh_of(test::ring_soup(1.0, 2.0, 1.0, 64));
  const Mesh peg = mesh_of(test::ring_soup(0.5, 0.98, 2.0, 60));
  const Pose X_AB{test::turn(Vec3::UnitX(), 0.002) * test::turn(Vec3::UnitY(), -0.02),
                  Vec3(0.089, 0.001, 2.2)};
  const Interference all = evaluated(sleeve, peg, X_AB, {.most_cells = 10000000});
  const Interference few = evaluated(sleeve, peg, X_AB, {.most_cells = 600});
  EXPECT_EQ(few.total.status, Status::kOk);
  EXPECT_NEAR(few.total.volume, all.total.volume, 1e-12 * all.total.volume);
  EXPECT_LE((few.total.area_vector - all.total.area_vector).norm(), 1e-12);
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

// How far a mesh reaches along a direction.
double reach_of(const Mesh& mesh, const Vec3& e) {
  double reach = -kInfinity;
  for (const Vec3& p : mesh.topology().vertices) reach = std::max(reach, e.dot(p));
  return reach;
}

// The middle of a face of a convex solid, given the corners of all.
Vec3 middle_of(const SurfacePlane& face, const std::vector<Vec3>& corners) {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (const Vec3& p : corners) {
    if (std::abs(face.normal.dot(p) - face.offset) < 1e-9) sum += p, ++count;
  }
  return sum / count;
}

// Where a mesh meets one face of a convex solid only, it is cut as by a half-space; elsewhere as by
// the solid's triangles, which must always come to the same.
void expect_cut_as_by_triangles(const ConvexPolytope& solid) {
  const Mesh mesh = mesh_of(test::bumpy_soup(3, 6));
  SurfaceStore stores[2];
  const SurfaceView a = surface_of(mesh, stores[0]), faces = surface_of(solid, stores[1]);
  SurfaceView triangles = faces;
  triangles.planes = nullptr;
  ColumnsScratch scratch;
  Interference out, expected;
  Random random(9);
  int on_one = 0, on_more = 0;
  for (int i = 0; i < test::cases(300, 50); ++i) {
    const SurfacePlane& face = (*faces.planes)[static_cast<std::size_t>(i) % faces.planes->size()];
    const Pose turned = random.pose(0.0);
    const double height = reach_of(mesh, -turned.rotation.transpose() * face.normal);
    const double depth = i % 2 == 0 ? 0.02 : 0.2;
    const Vec3 at = middle_of(face, solid.vertices()) + (height - depth) * face.normal;
    const Pose X_AB = Pose{turned.rotation, at}.inverse();
    columns_interference(a, faces, X_AB, {}, scratch, out);
    const bool below = !scratch.cells.cells.empty() && scratch.cells.cells[0].g < 0;
    columns_interference(a, triangles, X_AB, {}, scratch, expected);
    ASSERT_TRUE(out.total.touching()) << i;
    (below ? on_one : on_more)++;
    ASSERT_TRUE(test::same(out.total, expected.total, {1e-9, 1.0})) << i;
  }
  EXPECT_GT(on_one, test::cases(80, 12));
  EXPECT_GT(on_more, test::cases(20, 3));
}

TEST(Columns, ConvexSolidsCutAsTheirTrianglesDo) {
  expect_cut_as_by_triangles(test::polytope_of(Box({.half_sizes = Vec3(1.2, 0.9, 0.4)})));
  std::vector<Vec3> corners;
  for (int i = 0; i < 6; ++i) {
    const double angle = i * kPi / 3.0;
    corners.emplace_back(1.5 * std::cos(angle), 1.5 * std::sin(angle), -0.5);
    corners.emplace_back(0.9 * std::cos(angle), 0.9 * std::sin(angle), 0.5);
  }
  expect_cut_as_by_triangles(ConvexPolytope(corners));
}

TEST(Columns, AMeshOnABoxIsCutAsByAHalfSpace) {
  const Mesh mesh = mesh_of(test::bumpy_soup(3, 6));
  const Box box({.half_sizes = Vec3(3.0, 3.0, 0.5)});
  Random random(10);
  for (int i = 0; i < 30; ++i) {
    const Mat3 turned = random.pose(0.0).rotation;
    const double height = reach_of(mesh, -turned.transpose().col(2));
    const Vec3 aside(random.in_box(1.0).x(), random.in_box(1.0).y(), 0.0);
    const Pose X_HA{turned, aside + (height - 0.02) * Vec3::UnitZ()};
    const Pose X_BA{turned, X_HA.translation + 0.5 * Vec3::UnitZ()};
    const VolumeMetrics expected = evaluated(mesh, HalfSpace(), X_HA.inverse()).total;
    ASSERT_TRUE(expected.touching());
    EXPECT_TRUE(test::same(evaluated(mesh, box, X_BA.inverse()).total, expected, {1e-10, 1.0}));
    const Pose X_BH = shifted(0.0, 0.0, 0.5);
    EXPECT_TRUE(test::same(evaluated(box, mesh, X_BA).total,
                           transformed(evaluated(HalfSpace(), mesh, X_HA).total, X_BH),
                           {1e-10, 1.0}));
  }
}

TEST(Columns, EveryInstructionSetMakesTheSameBits) {
  const Touching pair = bumpy_pair(3, 0.02);
  const Mesh& a = pair.a;
  const Box box({.half_sizes = Vec3(3.0, 3.0, 1.0)});
  const Pose X_AB = shifted(0.0, 0.0, -0.98 - reach_of(a, -Vec3::UnitZ()));
  SurfaceStore stores[2];
  std::vector<VolumeMetrics> on_mesh, on_box;
  for (SimdPath path : {SimdPath::kPortable, SimdPath::kAvx2, SimdPath::kAvx512}) {
    if (!can_run(path)) continue;
    ColumnsScratch scratch;
    scratch.crossing.path = path;
    scratch.cells.path = path;
    Interference out;
    const SurfaceView view = surface_of(a, stores[0]);
    columns_interference(view, surface_of(pair.b, stores[1]), pair.X_AB, {}, scratch, out);
    on_mesh.push_back(out.total);
    columns_interference(view, surface_of(box, stores[1]), X_AB, {}, scratch, out);
    on_box.push_back(out.total);
  }
  for (const auto& results : {on_mesh, on_box}) {
    ASSERT_TRUE(results[0].touching());
    for (const VolumeMetrics& m : results) EXPECT_TRUE(test::same(m, results[0], {0.0, 0.0}));
  }
}

// Flush faces on all sides: one of the regions shows nothing but walls to the columns.
TEST(Columns, ARegionOfWallsAloneHasNoDepthAndIsFinite) {
  const Mesh block = mesh_of(box_soup(Vec3(0.35, 0.3, 0.25), 8));
  Mat3 turned = {0, -1, 0, 0, 0, 1, -1, 0, 0};
  const Pose X_AB{turned, Vec3(0.0, -0.099999999999999978, 0.15000000000000002)};
  const Interference out = evaluated(block, Box({.half_sizes = Vec3(0.4, 0.3, 0.2)}), X_AB);
  ASSERT_TRUE(out.total.touching());
  for (const VolumeMetrics& site : out.sites) EXPECT_TRUE(is_finite(site));
}

// Bodies pressed into each other deep enough that several threads get cells to make.
TEST(Columns, AnyNumberOfThreadsMakesTheSameBits) {
  const Mesh one = mesh_of(test::bumpy_soup(4, 1)), two = mesh_of(test::bumpy_soup(4, 2));
  const Pose X_AB{test::turn(Vec3(1.0, 2.0, 3.0), 0.5), Vec3(0.3, 0.2, 0.9)};
  const Interference serial = evaluated(one, two, X_AB);
  ASSERT_EQ(serial.engine, Engine::kColumns);
  ASSERT_TRUE(serial.total.touching());
  for (const int threads : {2, 3, 4, 8, 16, 0}) {
    const Interference many = evaluated(one, two, X_AB, {.threads = threads});
    EXPECT_TRUE(test::same(many.total, serial.total, {0.0, 0.0})) << threads;
    EXPECT_EQ(many.sites.size(), serial.sites.size());
  }
}

}  // namespace
}  // namespace volcontact::mesh_columns_test
