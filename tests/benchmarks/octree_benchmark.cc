// SPDX-License-Identifier: Apache-2.0

// Time of the octree on one pair, to a certified bound, for 1 and 2 threads in one run. The
// counters tell the bound that was reached, relative to V, and the contact sites.
#include <benchmark/benchmark.h>

#include <vector>

#include "core/support/random.h"
#include "volcontact/pair/interference.h"

namespace volcontact {
namespace {

void run(benchmark::State& state, const Shape& a, const Shape& b, const std::vector<Pose>& poses,
         double tolerance) {
  InterferenceWorkspace workspace;
  Interference result;
  const InterferenceOptions options{tolerance, Engine::kOctree, static_cast<int>(state.range(0))};
  double bound = 0.0, sites = 0.0;
  std::size_t i = 0;
  for (auto _ : state) {
    interference(a, b, poses[i++ % poses.size()], options, workspace, result);
    benchmark::DoNotOptimize(result.total);
    bound = std::max(bound, result.total.volume_error / result.total.volume);
    sites = static_cast<double>(result.sites.size());
  }
  state.counters["bound"] = bound;
  state.counters["sites"] = sites;
}

// A bore of radius 10 mm through a block of 20 mm.
Shape bored_block() {
  return Csg(Csg::Operation::kDifference, Csg(Box({.half_sizes = Vec3(0.02, 0.02, 0.01)})),
             Csg(Cylinder({.radius = 0.01, .half_length = 0.02})));
}

// A peg that leans on the bore's two rims.
void peg_in_bore(benchmark::State& state, double clearance, double tilt) {
  const Shape block = bored_block();
  const Shape peg = Cylinder({.radius = 0.01 - clearance, .half_length = 0.02});
  test::Random random(4);
  std::vector<Pose> poses;
  for (int k = 0; k < 16; ++k) {
    const double towards = random.uniform(0.0, 2.0 * kPi);
    poses.push_back({test::turn(Vec3(std::cos(towards), std::sin(towards), 0.0), tilt),
                     random.in_box(0.1 * clearance)});
  }
  run(state, block, peg, poses, 1e-2);
}
void peg_in_bore_clearance_3_percent(benchmark::State& state) { peg_in_bore(state, 3e-4, 0.035); }
void peg_in_bore_clearance_20_um(benchmark::State& state) { peg_in_bore(state, 2e-5, 0.003); }

void cylinder_edge_in_box(benchmark::State& state) {
  test::Random random(5);
  std::vector<Pose> poses;
  for (int k = 0; k < 16; ++k) {
    const Mat3 r = test::turn(Vec3::UnitX(), random.uniform(0.3, 0.6)) *
                   test::turn(Vec3::UnitZ(), random.uniform(0.0, 6.0));
    const double reach = 0.3 * r(2, 2) + 0.2 * std::hypot(r(2, 0), r(2, 1));
    poses.push_back({r, Vec3(0.1, 0.05, 0.5 + reach - 0.02)});
  }
  run(state, Box({.half_sizes = Vec3(1.0, 1.0, 0.5)}),
      Cylinder({.radius = 0.2, .half_length = 0.3}), poses, 1e-3);
}

BENCHMARK(peg_in_bore_clearance_3_percent)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK(peg_in_bore_clearance_20_um)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK(cylinder_edge_in_box)->Arg(1)->Arg(2)->UseRealTime();

}  // namespace
}  // namespace volcontact

BENCHMARK_MAIN();
