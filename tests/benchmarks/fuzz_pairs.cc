// SPDX-License-Identifier: Apache-2.0

// Searches all pairs for failures:
//   fuzz_pairs RANDOM_POSES DEGENERATE_POSES OCTREE_SHARE REFERENCE_SHARE [SEED] [A-B]
// Prints a table in Markdown, then the failures with their poses.
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "core/support/fuzz.h"

int main(int argc, char** argv) {
  using namespace volcontact;
  using namespace volcontact::test;
  FuzzPlan plan;
  plan.random_poses = argc > 1 ? std::atoi(argv[1]) : 10000;
  plan.degenerate_poses = argc > 2 ? std::atoi(argv[2]) : 1000;
  plan.octree_share = argc > 3 ? std::atof(argv[3]) : 0.01;
  plan.reference_share = argc > 4 ? std::atof(argv[4]) : 1.0;
  plan.seed = argc > 5 ? static_cast<std::uint64_t>(std::atoll(argv[5])) : 1;
  plan.only = argc > 6 ? argv[6] : "";
  FuzzReport report = fuzz(plan);
  std::printf("| engine | poses | overlapping | median | 99 %% | 99.9 %% | worst |\n");
  std::printf("| --- | --- | --- | --- | --- | --- | --- |\n");
  for (FuzzCount& count : report.counts) {
    if (count.errors.empty()) continue;
    std::sort(count.errors.begin(), count.errors.end());
    const auto part = [&](double share) {
      const auto last = static_cast<double>(count.errors.size() - 1);
      return static_cast<double>(count.errors[static_cast<std::size_t>(share * last)]);
    };
    std::printf("| %s | %d | %d | %.1e | %.1e | %.1e | %.1e |\n", to_string(count.engine),
                count.poses, count.overlapping, part(0.5), part(0.99), part(0.999), part(1.0));
  }
  std::printf("\n%zu failures; %d overlaps on which the reference disagrees with itself.\n",
              report.failures.size(), report.undecided);
  for (const FuzzFailure& f : report.failures) {
    std::printf("\n* %s, %s - %s: %s, V = %.6e, expected %.6e; X_AB = %s\n", to_string(f.engine),
                f.a.c_str(), f.b.c_str(), f.what.c_str(), f.volume, f.expected,
                literal(f.X_AB).c_str());
  }
}
