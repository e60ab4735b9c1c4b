// SPDX-License-Identifier: Apache-2.0

// Time of one interference query of the exact engines, over 256 random poses of each kind, warm.
// For the generic x86-64 build.
#include <benchmark/benchmark.h>

#include <vector>

#include "core/support/random.h"
#include "volcontact/pair/interference.h"

namespace volcontact {
namespace {

using test::Random;

constexpr int kPoses = 256;

// Poses of B at a distance along a random direction in A, turned at random, that overlap as wanted.
template <typename Wanted>
std::vector<Pose> find_poses(const Shape& a, const Shape& b, double near, double far,
                             Wanted&& wanted) {
  Random random(1);
  InterferenceWorkspace workspace;
  Interference result;
  std::vector<Pose> poses;
  while (static_cast<int>(poses.size()) < kPoses) {
    const Mat3 r = random.rotation();
    const Vec3 e = random.direction();
    const Pose X_AB{r, random.uniform(near, far) * e};
    interference(a, b, X_AB, {}, workspace, result);
    if (wanted(result.total)) poses.push_back(X_AB);
  }
  return poses;
}

bool is_apart(const VolumeMetrics& m) { return !m.touching(); }
auto is_between(double low, double high) {
  return [=](const VolumeMetrics& m) { return m.volume > low && m.volume < high; };
}

void run(benchmark::State& state, const Shape& a, const Shape& b, const std::vector<Pose>& poses) {
  InterferenceWorkspace workspace;
  Interference result;
  const InterferenceOptions options;
  std::size_t i = 0;
  for (auto _ : state) {
    interference(a, b, poses[i++ % poses.size()], options, workspace, result);
    benchmark::DoNotOptimize(result.total);
  }
}

const Shape kGround = HalfSpace();
const Shape kBall = Sphere({.radius = 0.5});
const Shape kEgg = Ellipsoid({.semi_axes = Vec3(0.5, 0.35, 0.2)});
const Shape kBox = Box({.half_sizes = Vec3(0.5, 0.4, 0.3)});
const Shape kPlate = Box({.half_sizes = Vec3(2.0, 2.0, 0.1)});

const Shape kCan = Cylinder({.radius = 0.3, .half_length = 0.4});
const Shape kPill = Capsule({.radius = 0.3, .half_length = 0.4});
const Shape kCup = Frustum({.bottom_radius = 0.3, .top_radius = 0.5, .half_length = 0.4});
const Shape kRing = Torus({.major_radius = 0.4, .minor_radius = 0.1});

Shape polytope(int vertices) {
  Random random(3);
  std::vector<Vec3> points;
  for (int i = 0; i < vertices; ++i) points.push_back(random.direction());
  return ConvexPolytope(points);
}
// 18 points on a sphere: a hull of 32 triangles.
const Shape kGem = polytope(18);

void ground_ball(benchmark::State& state) {
  run(state, kGround, kBall, find_poses(kGround, kBall, 0.0, 0.6, is_between(1e-9, 0.5)));
}
void ball_ground(benchmark::State& state) {
  run(state, kBall, kGround, find_poses(kBall, kGround, 0.0, 0.6, is_between(1e-9, 0.5)));
}
void ground_ball_apart(benchmark::State& state) {
  run(state, kGround, kBall, find_poses(kGround, kBall, 1.0, 3.0, is_apart));
}
void ground_ellipsoid(benchmark::State& state) {
  run(state, kGround, kEgg, find_poses(kGround, kEgg, 0.0, 0.4, is_between(1e-9, 0.1)));
}
void ellipsoid_ground(benchmark::State& state) {
  run(state, kEgg, kGround, find_poses(kEgg, kGround, 0.0, 0.4, is_between(1e-9, 0.1)));
}
// Round solids at any tilt and depth, and lying on the ground, a hair tilted.
void ground_can(benchmark::State& state) {
  run(state, kGround, kCan, find_poses(kGround, kCan, 0.0, 0.5, is_between(1e-9, 0.2)));
}
void can_ground(benchmark::State& state) {
  run(state, kCan, kGround, find_poses(kCan, kGround, 0.0, 0.5, is_between(1e-9, 0.2)));
}
std::vector<Pose> lying_poses(double height) {
  Random random(4);
  std::vector<Pose> poses;
  for (int i = 0; i < kPoses; ++i) {
    const Mat3 r = test::turn(Vec3::UnitZ(), random.uniform(0.0, 6.0)) *
                   test::turn(Vec3::UnitX(), kPi / 2 + random.uniform(-0.002, 0.002));
    poses.push_back({r, Vec3(0.1, 0.2, height)});
  }
  return poses;
}
void ground_can_lying(benchmark::State& state) { run(state, kGround, kCan, lying_poses(0.298)); }
void ground_pill(benchmark::State& state) {
  run(state, kGround, kPill, find_poses(kGround, kPill, 0.0, 0.7, is_between(1e-9, 0.3)));
}
void ground_pill_lying(benchmark::State& state) { run(state, kGround, kPill, lying_poses(0.298)); }
void ground_cup(benchmark::State& state) {
  run(state, kGround, kCup, find_poses(kGround, kCup, 0.0, 0.6, is_between(1e-9, 0.3)));
}
void ground_ring(benchmark::State& state) {
  run(state, kGround, kRing, find_poses(kGround, kRing, 0.0, 0.5, is_between(1e-9, 0.07)));
}
void ball_ball(benchmark::State& state) {
  run(state, kBall, kBall, find_poses(kBall, kBall, 0.95, 1.0, is_between(1e-12, 1.0)));
}
void ground_box(benchmark::State& state) {
  run(state, kGround, kBox, find_poses(kGround, kBox, 0.0, 0.7, is_between(1e-6, 0.2)));
}
void box_ground(benchmark::State& state) {
  run(state, kBox, kGround, find_poses(kBox, kGround, 0.0, 0.7, is_between(1e-6, 0.2)));
}
void ground_box_apart(benchmark::State& state) {
  run(state, kGround, kBox, find_poses(kGround, kBox, 1.0, 3.0, is_apart));
}
void box_ground_apart(benchmark::State& state) {
  run(state, kBox, kGround, find_poses(kBox, kGround, 1.0, 3.0, is_apart));
}

// A box that rests on a face of the plate, slightly tilted: the contact of assemblies and piles.
std::vector<Pose> resting_poses(double off_edge) {
  Random random(2);
  std::vector<Pose> poses;
  for (int i = 0; i < kPoses; ++i) {
    const Mat3 r = test::turn(random.direction(), random.uniform(0.0, 0.002)) *
                   test::turn(Vec3::UnitZ(), random.uniform(0.0, 6.0));
    const double x = random.uniform(-1.0, 1.0) + off_edge, y = random.uniform(-1.0, 1.0);
    poses.push_back({r, Vec3(x, y, 0.4 - 0.002)});
  }
  return poses;
}
void box_box_face(benchmark::State& state) { run(state, kPlate, kBox, resting_poses(0.0)); }
void box_box_over_edge(benchmark::State& state) { run(state, kPlate, kBox, resting_poses(2.0)); }
void box_box_shallow(benchmark::State& state) {
  run(state, kBox, kBox, find_poses(kBox, kBox, 0.5, 1.2, is_between(1e-7, 1e-3)));
}
void box_box_deep(benchmark::State& state) {
  run(state, kBox, kBox, find_poses(kBox, kBox, 0.0, 0.5, is_between(0.05, 1.0)));
}
void box_box_apart(benchmark::State& state) {
  run(state, kBox, kBox, find_poses(kBox, kBox, 0.7, 2.0, is_apart));
}
void ground_gem(benchmark::State& state) {
  run(state, kGround, kGem, find_poses(kGround, kGem, 0.7, 1.0, is_between(1e-7, 1e-1)));
}
void box_gem(benchmark::State& state) {
  run(state, kBox, kGem, find_poses(kBox, kGem, 1.0, 2.0, is_between(1e-7, 1e-2)));
}
void gem_gem_shallow(benchmark::State& state) {
  run(state, kGem, kGem, find_poses(kGem, kGem, 1.6, 2.0, is_between(1e-7, 1e-2)));
}
void gem_gem_deep(benchmark::State& state) {
  run(state, kGem, kGem, find_poses(kGem, kGem, 0.0, 1.0, is_between(0.5, 4.0)));
}
void gem_gem_apart(benchmark::State& state) {
  run(state, kGem, kGem, find_poses(kGem, kGem, 2.0, 4.0, is_apart));
}

BENCHMARK(ground_ball);
BENCHMARK(ball_ground);
BENCHMARK(ground_ball_apart);
BENCHMARK(ground_ellipsoid);
BENCHMARK(ellipsoid_ground);
BENCHMARK(ground_can);
BENCHMARK(can_ground);
BENCHMARK(ground_can_lying);
BENCHMARK(ground_pill);
BENCHMARK(ground_pill_lying);
BENCHMARK(ground_cup);
BENCHMARK(ground_ring);
BENCHMARK(ball_ball);
BENCHMARK(ground_box);
BENCHMARK(box_ground);
BENCHMARK(ground_box_apart);
BENCHMARK(box_ground_apart);
BENCHMARK(box_box_face);
BENCHMARK(box_box_over_edge);
BENCHMARK(box_box_shallow);
BENCHMARK(box_box_deep);
BENCHMARK(box_box_apart);
BENCHMARK(ground_gem);
BENCHMARK(box_gem);
BENCHMARK(gem_gem_shallow);
BENCHMARK(gem_gem_deep);
BENCHMARK(gem_gem_apart);

}  // namespace
}  // namespace volcontact

BENCHMARK_MAIN();
