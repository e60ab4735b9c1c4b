// SPDX-License-Identifier: Apache-2.0

// Time of one interference query of the lines engine, warm, over 64 poses each of which is a little
// beside the one that the row is named after.
#include <benchmark/benchmark.h>

#include <vector>

#include "core/support/random.h"
#include "volcontact/pair/interference.h"

namespace volcontact {
namespace {

using test::Random;

constexpr int kPoses = 64;

void run(benchmark::State& state, const Shape& a, const Shape& b, const Pose& X_AB, double shift,
         double turn, std::size_t sites) {
  Random random(1);
  std::vector<Pose> poses;
  for (int i = 0; i < kPoses; ++i) {
    const Mat3 r = test::turn(random.direction(), random.uniform(0.0, turn));
    poses.push_back({r * X_AB.rotation, X_AB.translation + random.in_box(shift)});
  }
  InterferenceWorkspace workspace;
  Interference result;
  const InterferenceOptions options{.engine = Engine::kLines};
  for (const Pose& X : poses) {
    interference(a, b, X, options, workspace, result);
    if (result.engine != Engine::kLines || result.sites.size() != sites) {
      return state.SkipWithError("not the contact that the row is named after");
    }
  }
  std::size_t i = 0;
  for (auto _ : state) {
    interference(a, b, poses[i++ % poses.size()], options, workspace, result);
    benchmark::DoNotOptimize(result.total);
  }
}

const Shape kBox = Box({.half_sizes = {1.0, 1.0, 0.5}});
const Shape kEgg = Ellipsoid({.semi_axes = {0.5, 0.35, 0.2}});
const Shape kCan = Cylinder({.radius = 0.2, .half_length = 0.4});
const Shape kPill = Capsule({.radius = 0.2, .half_length = 0.4});
const Shape kRing = Torus({.major_radius = 0.35, .minor_radius = 0.12});

// A block with a bore of 10 mm radius.
Shape bored_block() {
  return Csg(Csg::Operation::kDifference, Csg(Box({.half_sizes = {0.03, 0.03, 0.02}})),
             Csg(Cylinder({.radius = 0.01, .half_length = 0.03})));
}
Shape peg(double clearance) { return Cylinder({.radius = 0.01 - clearance, .half_length = 0.03}); }

void ellipsoid_over_box_edge(benchmark::State& state) {
  run(state, kBox, kEgg, {test::turn({1.0, 0.4, 0.3}, 0.5), {0.93, 0.1, 0.73}}, 1e-3, 1e-2, 1);
}
void can_cap_edge_into_box_face(benchmark::State& state) {
  const double tilt = 0.35, depth = 0.02;
  const Vec3 axis(std::cos(tilt), 0.0, std::sin(tilt));
  const double height = 0.5 + 0.4 * std::sin(tilt) + 0.2 * std::cos(tilt) - depth;
  run(state, kBox, kCan, {basis_with_z(axis), {0.1, 0.05, height}}, 1e-3, 1e-2, 1);
}
void can_on_can_crossed(benchmark::State& state) {
  run(state, kCan, kCan, {test::turn(Vec3::UnitX(), 1.5), {0.38, 0.05, 0.1}}, 1e-3, 1e-2, 1);
}
void pill_on_pill(benchmark::State& state) {
  run(state, kPill, kPill, {test::turn({1.0, 0.3, 0.0}, 0.9), {0.3, 0.05, 0.62}}, 1e-3, 1e-2, 1);
}
void ball_on_rim_of_bore(benchmark::State& state) {
  const Shape ball = Sphere({.radius = 0.015});
  run(state, bored_block(), ball, {Mat3::Identity(), {0.0, 0.0, 0.031}}, 1e-6, 0.0, 1);
}
void ball_at_wall_of_bore(benchmark::State& state) {
  const Shape ball = Sphere({.radius = 0.008});
  run(state, bored_block(), ball, {Mat3::Identity(), {0.00202, 0.0, 0.005}}, 1e-6, 0.0, 1);
}
void peg_in_bore_300um(benchmark::State& state) {
  run(state, bored_block(), peg(3e-4), {test::turn(Vec3::UnitX(), 0.03), Vec3::Zero()}, 1e-6, 1e-4,
      2);
}
void peg_in_bore_20um(benchmark::State& state) {
  run(state, bored_block(), peg(2e-5), {test::turn(Vec3::UnitX(), 0.002), Vec3::Zero()}, 1e-6, 1e-5,
      2);
}
void peg_free_in_bore_20um(benchmark::State& state) {
  run(state, bored_block(), peg(2e-5), {Mat3::Identity(), Vec3::Zero()}, 1e-6, 0.0, 0);
}
void ring_stands_on_box_face(benchmark::State& state) {
  run(state, kBox, kRing, {test::turn(Vec3::UnitX(), 1.3), {0.1, 0.05, 0.94}}, 1e-3, 1e-2, 1);
}
void can_beside_ring(benchmark::State& state) {
  run(state, kRing, kCan, {test::turn(Vec3::UnitX(), 0.4), {0.66, 0.0, 0.05}}, 1e-3, 1e-2, 1);
}
void ball_in_hole_of_ring(benchmark::State& state) {
  const Shape ball = Sphere({.radius = 0.3});
  run(state, kRing, ball, {Mat3::Identity(), {0.0, 0.0, 0.2}}, 1e-3, 0.0, 1);
}
void bar_across_ring(benchmark::State& state) {
  const Shape bar = Box({.half_sizes = {1.0, 0.1, 0.05}});
  run(state, kRing, bar, {Mat3::Identity(), {0.0, 0.0, 0.16}}, 1e-3, 1e-3, 2);
}

BENCHMARK(ellipsoid_over_box_edge);
BENCHMARK(can_cap_edge_into_box_face);
BENCHMARK(can_on_can_crossed);
BENCHMARK(pill_on_pill);
BENCHMARK(ball_on_rim_of_bore);
BENCHMARK(ball_at_wall_of_bore);
BENCHMARK(peg_in_bore_300um);
BENCHMARK(peg_in_bore_20um);
BENCHMARK(peg_free_in_bore_20um);
BENCHMARK(ring_stands_on_box_face);
BENCHMARK(can_beside_ring);
BENCHMARK(ball_in_hole_of_ring);
BENCHMARK(bar_across_ring);

}  // namespace
}  // namespace volcontact

BENCHMARK_MAIN();
