// SPDX-License-Identifier: Apache-2.0

// Searches all pairs for failures: fuzz_pairs RANDOM_POSES DEGENERATE_POSES SEED [A-B]
// Prints lines that tests/benchmarks/search_for_failures.py adds up over many seeds:
//   count,ENGINE,random or degenerate,POSES,OVERLAPPING   error,ENGINE,random or degenerate,ERROR
//   failure,ENGINE,A,B,WHAT,V,EXPECTED,X_AB   undecided,N   seconds,OF ONE PROCESSOR
//   plan,WEIGHTS,REFERENCE SHARES: of pairs of low, middle and high cost
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "core/search/fuzz.h"

int main(int argc, char** argv) {
  using namespace volcontact;
  using namespace volcontact::test;
  // Pairs of simple convex solids do most poses, the others as many as the time allows.
  const FuzzPlan plan{.random_poses = argc > 1 ? std::atoi(argv[1]) : 10000,
                      .degenerate_poses = argc > 2 ? std::atoi(argv[2]) : 1000,
                      .weights = {1.0, 0.03, 0.0006},
                      .reference = {0.004, 0.03, 0.2},
                      .seed = argc > 3 ? static_cast<std::uint64_t>(std::atoll(argv[3])) : 1,
                      .only = argc > 4 ? argv[4] : ""};
  const FuzzReport report = fuzz(plan);
  std::printf("plan,%g,%g,%g,%g,%g,%g\n", plan.weights[0], plan.weights[1], plan.weights[2],
              plan.reference[0], plan.reference[1], plan.reference[2]);
  for (const FuzzCount& count : report.counts) {
    const char* kind = count.degenerate ? "degenerate" : "random";
    const char* engine = to_string(count.engine);
    std::printf("count,%s,%s,%d,%d\n", engine, kind, count.poses, count.overlapping);
    for (const float error : count.errors) {
      std::printf("error,%s,%s,%.2e\n", engine, kind, static_cast<double>(error));
    }
  }
  std::printf("undecided,%d\n", report.undecided);
  for (const FuzzFailure& f : report.failures) {
    std::printf("failure,%s,%s,%s,%s,%.6e,%.6e,%s\n", to_string(f.engine), f.a.c_str(), f.b.c_str(),
                f.what.c_str(), f.volume, f.expected, literal(f.X_AB).c_str());
  }
  std::printf("seconds,%.1f\n", static_cast<double>(std::clock()) / CLOCKS_PER_SEC);
}
