// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/octree/octree.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "core/support/sanitized.h"
#include "volcontact/pair/interference.h"

namespace volcontact::octree_test {
namespace {

Pose random_pose(std::mt19937& random, double reach) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> number(-reach, reach);
  Vector<4> q;
  for (int i = 4; i-- > 0;) q[i] = normal(random);
  q.normalize();
  return {rotation_of(q[0], q[1], q[2], q[3]), {number(random), number(random), number(random)}};
}

// Bodies of a few tenths of a metre.
std::vector<Shape> solids() {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> number(-0.3, 0.3);
  std::vector<Vec3> points;
  for (int i = 0; i < 14; ++i) points.emplace_back(number(random), number(random), number(random));
  return {HalfSpace(),
          Sphere({.radius = 0.25}),
          Ellipsoid({.semi_axes = {0.3, 0.2, 0.12}}),
          Capsule({.radius = 0.12, .half_length = 0.2}),
          Cylinder({.radius = 0.2, .half_length = 0.15}),
          Frustum({.bottom_radius = 0.25, .top_radius = 0.1, .half_length = 0.2}),
          Box({.half_sizes = {0.3, 0.2, 0.1}}),
          ConvexPolytope(points)};
}

// Independent method: exact intervals of n x n lines along z of b's frame, midpoint rule.
double columns(const Shape& a, const Shape& b, const Pose& X_AB, int n) {
  const Pose X_BA = X_AB.inverse();
  return std::visit(
      [&](const auto& solid_a, const auto& solid_b) {
        const Aabb box = solid_b.bounds();
        Vec2 low = box.min.head<2>(), high = box.max.head<2>();
        double volume = 0.0;
        if constexpr (ConvexSolid<std::decay_t<decltype(solid_a)>> &&
                      ConvexSolid<std::decay_t<decltype(solid_b)>>) {
          for (int i = 0; i < 2; ++i) {  // the window of a in b's frame
            const Vec3 axis = X_BA.rotation.row(i);
            low[i] = std::max(low[i], X_BA.translation[i] - solid_a.support_height(-axis));
            high[i] = std::min(high[i], X_BA.translation[i] + solid_a.support_height(axis));
            if (!(low[i] < high[i])) return 0.0;
          }
          const Vec2 step = (high - low) / n;
          const Vec3 direction_A = X_AB.rotation.col(2);
          for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n; ++j) {
              const Vec3 o(low.x() + (i + 0.5) * step.x(), low.y() + (j + 0.5) * step.y(), 0.0);
              const RayInterval in_b = solid_b.ray(o, Vec3::UnitZ());
              if (in_b.empty()) continue;
              const RayInterval in_a = solid_a.ray(X_AB * o, direction_A);
              volume += std::max(
                  0.0, std::min(in_a.leave, in_b.leave) - std::max(in_a.enter, in_b.enter));
            }
          }
          volume *= step.prod();
        }
        return volume;
      },
      a, b);
}

struct Reference {
  double volume;
  double doubt;
};

// Clipping where all faces are plane: exact, and tested by itself. Else columns, whose error is
// judged by halving them; two lucky sums may agree, hence 1e-5 of V and, for a sliver that only a
// few columns meet, a ten-millionth of a body.
Reference reference(const Shape& a, const Shape& b, const Pose& X_AB) {
  if (serves(Engine::kClip, a, b)) {
    InterferenceWorkspace workspace;
    Interference out;
    interference(a, b, X_AB, {.engine = Engine::kClip}, workspace, out);
    return {out.total.volume, 1e-12};
  }
  const double fine = columns(a, b, X_AB, 256), coarse = columns(a, b, X_AB, 128);
  return {fine, 2.0 * std::abs(fine - coarse) + 1e-5 * fine + 3e-9};
}

Interference octree(const Shape& a, const Shape& b, const Pose& X_AB, double tolerance,
                    int threads = 1) {
  static InterferenceWorkspace workspace;
  Interference out;
  interference(a, b, X_AB, {.tolerance = tolerance, .engine = Engine::kOctree, .threads = threads},
               workspace, out);
  return out;
}

const int kPosesPerPair = test::cases(29, 12, 2);

TEST(Octree, MeetsTheToleranceAndItsBoundsHoldTheTruth) {
  constexpr double kTolerance = 1e-2;
  std::mt19937 random(12);
  const std::vector<Shape> all = solids();
  int poses = 0, touching = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = std::max<std::size_t>(i, 1); j < all.size(); ++j) {
      for (int k = 0; k < kPosesPerPair; ++k, ++poses) {
        const Pose X_AB = random_pose(random, 0.35);
        const auto [fine, doubt] = reference(all[i], all[j], X_AB);
        const Interference out = octree(all[i], all[j], X_AB, kTolerance);
        const double error = std::abs(out.total.volume - fine);
        EXPECT_LE(error, out.total.volume_error + doubt)
            << name_of(all[i]) << " - " << name_of(all[j]) << ", V = " << fine;
        if (fine > 1e-9) {
          EXPECT_LE(error, kTolerance * fine + doubt) << name_of(all[i]) << name_of(all[j]);
          EXPECT_EQ(out.sites.size(), 1u);
          ++touching;
        }
        EXPECT_TRUE(is_finite(out.total));
      }
    }
  }
  EXPECT_EQ(poses, 35 * kPosesPerPair);
  EXPECT_GT(2 * touching, poses);
}

// The exact engines answer what the octree must tend to.
TEST(Octree, AgreesWithTheExactEngines) {
  std::mt19937 random(13);
  const Shape box = Box({.half_sizes = {0.3, 0.2, 0.1}}), ball = Sphere({.radius = 0.25});
  const Shape ellipsoid = Ellipsoid({.semi_axes = {0.3, 0.2, 0.12}}), ground = HalfSpace();
  const std::pair<const Shape*, const Shape*> pairs[] = {
      {&box, &box}, {&ground, &box}, {&ground, &ball}, {&ball, &ball}, {&ground, &ellipsoid}};
  InterferenceWorkspace workspace;
  for (const auto& [a, b] : pairs) {
    for (int k = 0; k < 8; ++k) {
      const Pose X_AB = random_pose(random, 0.25);
      Interference exact;
      interference(*a, *b, X_AB, {}, workspace, exact);
      ASSERT_NE(exact.engine, Engine::kOctree);
      if (exact.total.volume < 1e-5 || exact.total.status != Status::kOk) continue;
      const double tolerance = 1e-3;
      const VolumeMetrics m = octree(*a, *b, X_AB, tolerance).total, &e = exact.total;
      EXPECT_NEAR(m.volume, e.volume, m.volume_error + 1e-15);
      EXPECT_NEAR(m.volume / e.volume, 1.0, tolerance);
      const double size = std::cbrt(e.volume);
      EXPECT_NEAR((m.centroid - e.centroid).norm(), 0.0, 10.0 * tolerance * size);
      EXPECT_NEAR((m.inertia - e.inertia).norm(), 0.0, 20.0 * tolerance * e.inertia.norm());
      EXPECT_NEAR((m.area_vector - e.area_vector).norm(), 0.0, 30.0 * tolerance * size * size);
    }
  }
}

TEST(Octree, GivesTheSameBitsForAnyNumberOfThreads) {
  const Shape peg = Cylinder({.radius = 0.2, .half_length = 0.3});
  const Shape block = Box({.half_sizes = {0.3, 0.2, 0.1}});
  std::mt19937 random(14);
  for (int k = 0; k < 5; ++k) {
    const Pose X_AB = random_pose(random, 0.2);
    const VolumeMetrics one = octree(peg, block, X_AB, 1e-3, 1).total;
    for (const int threads : {2, 3, 4, 8, 16}) {
      const VolumeMetrics many = octree(peg, block, X_AB, 1e-3, threads).total;
      EXPECT_EQ(std::memcmp(&one.volume, &many.volume, sizeof(double)), 0);
      EXPECT_EQ(one.centroid, many.centroid);
      EXPECT_EQ(one.inertia, many.inertia);
      EXPECT_EQ(one.area_vector, many.area_vector);
      EXPECT_EQ(one.depth_moment, many.depth_moment);
    }
  }
}

// A caller that shares pairs among threads of its own finds each of them serving one pair.
TEST(Octree, GivesTheSameBitsInsideOfAParallelRegion) {
  const Shape peg = Cylinder({.radius = 0.2, .half_length = 0.3});
  const Shape block = Box({.half_sizes = {0.3, 0.2, 0.1}});
  std::mt19937 random(17);
  constexpr int kPairs = 12;
  std::vector<Pose> poses;
  std::vector<double> alone(kPairs), shared(kPairs);
  for (int k = 0; k < kPairs; ++k) {
    poses.push_back(random_pose(random, 0.2));
    alone[k] = octree(peg, block, poses[k], 1e-3).total.volume;
  }
#pragma omp parallel num_threads(4)
  {
    InterferenceWorkspace workspace;
    Interference out;
#pragma omp for schedule(dynamic, 1)
    for (int k = 0; k < kPairs; ++k) {
      interference(peg, block, poses[k],
                   {.tolerance = 1e-3, .engine = Engine::kOctree, .threads = 0}, workspace, out);
      shared[k] = out.total.volume;
    }
  }
  EXPECT_EQ(alone, shared);
}

TEST(Octree, BoundShrinksWithTheTolerance) {
  const Shape peg = Cylinder({.radius = 0.2, .half_length = 0.3});
  const Shape block = Box({.half_sizes = {0.3, 0.2, 0.1}});
  std::mt19937 random(15);
  const Pose X_AB = random_pose(random, 0.15);
  for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-4}) {
    const VolumeMetrics m = octree(peg, block, X_AB, tolerance).total;
    EXPECT_EQ(m.status, Status::kOk);
    EXPECT_LE(m.volume_error, tolerance * m.volume);
  }
}

TEST(Octree, MirrorsWhenTheBodiesChangeRoles) {
  const Shape peg = Capsule({.radius = 0.12, .half_length = 0.2});
  const Shape block = Box({.half_sizes = {0.3, 0.2, 0.1}});
  std::mt19937 random(16);
  for (int k = 0; k < 5; ++k) {
    const Pose X_AB = random_pose(random, 0.2);
    const VolumeMetrics forth = octree(peg, block, X_AB, 1e-3).total;
    const VolumeMetrics back =
        reversed(transformed(octree(block, peg, X_AB.inverse(), 1e-3).total, X_AB));
    if (!forth.touching()) continue;
    EXPECT_NEAR(forth.volume, back.volume, forth.volume_error + back.volume_error);
    EXPECT_NEAR((forth.area_vector - back.area_vector).norm(), 0.0,
                1e-2 * std::max(1e-6, forth.area_vector.norm()));
  }
}

TEST(Octree, AnswersDegenerateInputWithAStatus) {
  const Shape ball = Sphere({.radius = 0.25}), block = Box({.half_sizes = {0.3, 0.2, 0.1}});
  Pose nowhere;
  nowhere.translation.x() = std::nan("");
  EXPECT_EQ(octree(ball, block, nowhere, 1e-2).total.status, Status::kInvalid);
  const Interference contained = octree(block, Sphere({.radius = 0.05}), Pose{}, 1e-2);
  EXPECT_EQ(contained.total.status, Status::kContained);
  EXPECT_NEAR(contained.total.volume, 4.0 / 3.0 * kPi * 1.25e-4, 1e-2 * 5.3e-4);
  const Interference flat = octree(Cylinder({.radius = 0.2, .half_length = 0.0}), block, {}, 1e-2);
  EXPECT_EQ(flat.total.volume, 0.0);
  Pose far;
  far.translation.x() = 100.0;
  EXPECT_FALSE(octree(ball, block, far, 1e-2).total.touching());
}

}  // namespace
}  // namespace volcontact::octree_test
