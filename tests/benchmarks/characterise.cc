// SPDX-License-Identifier: Apache-2.0

// Measures every engine on every pair and prints a table as CSV: characterise [POSES_A_PAIR].
#include <cstdio>
#include <cstdlib>

#include "core/support/characterisation.h"

namespace volcontact::test {
namespace {

void print(const Characterisation& row) {
  std::printf("%s,%s,%s,%d", row.a->name.c_str(), row.b->name.c_str(), to_string(row.engine),
              row.poses);
  for (const Spread& s : {row.volume, row.centroid, row.inertia, row.area_vector, row.area_moment,
                          row.gradient, row.turn}) {
    std::printf(",%.2e,%.2e", s.median, s.worst);
  }
  std::printf(",%.2e,%d,%d,%.2e,%.3g\n", row.noise, row.bounds_held, row.missed, row.reference,
              row.microseconds);
  std::fflush(stdout);
}

}  // namespace
}  // namespace volcontact::test

int main(int argc, char** argv) {
  using namespace volcontact::test;
  Effort effort;
  effort.poses = argc > 1 ? std::atoi(argv[1]) : 60;
  effort.gradient_poses = 3;
  effort.motion_steps = 21;
  effort.octree_poses = 6;
  std::printf(
      "a,b,engine,poses,volume_median,volume_worst,centroid_median,centroid_worst,inertia_median,"
      "inertia_worst,area_vector_median,area_vector_worst,area_moment_median,area_moment_worst,"
      "gradient_median,gradient_worst,turn_median,turn_worst,noise,bounds_held,missed,reference,"
      "microseconds\n");
  for (std::size_t i = 0; i < examples().size(); ++i) {
    for (std::size_t j = i; j < examples().size(); ++j) {
      const Example &a = examples()[i], &b = examples()[j];
      if (!is_pair(a, b)) continue;
      for (const Characterisation& row : characterise(a, b, effort)) print(row);
    }
  }
}
