// SPDX-License-Identifier: Apache-2.0

// Measures engines, all or those named, on every pair and prints a table as CSV:
// characterise [POSES_A_PAIR] [ENGINE...].
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "core/search/characterisation.h"

namespace volcontact::test {
namespace {

constexpr const char* kSpreads[] = {"volume",      "centroid", "inertia", "area_vector",
                                    "area_moment", "gradient", "turn"};

void print_header() {
  std::printf("a,b,engine,poses,handed_on");
  for (const char* name : kSpreads) std::printf(",%s_median,%s_worst", name, name);
  std::printf(",noise,bounds_held,missed,reference_error,microseconds\n");
}

void print(const Characterisation& row) {
  std::printf("%s,%s,%s,%d,%d", row.a->name.c_str(), row.b->name.c_str(), to_string(row.engine),
              row.poses, row.handed_on);
  for (const Spread& s : {row.volume, row.centroid, row.inertia, row.area_vector, row.area_moment,
                          row.gradient, row.turn}) {
    if (s.count > 0) {
      std::printf(",%.1e,%.1e", s.median, s.worst);
    } else {
      std::printf(",,");
    }
  }
  row.noise ? std::printf(",%.1e", *row.noise) : std::printf(",");
  std::printf(",%d,%d,%.1e,%.2g\n", row.bounds_held, row.missed, row.reference_error,
              row.microseconds);
  std::fflush(stdout);
}

// How far the work has got, and how long the rest may take.
class Progress {
 public:
  explicit Progress(std::size_t pairs) : pairs_(pairs) {}

  void show(const Example& a, const Example& b) {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin_;
    const double left = done_ > 0 ? spent.count() / done_ * static_cast<double>(pairs_ - done_) : 0;
    std::fprintf(stderr, "\r%zu of %zu pairs, %.0f s, about %.0f s left: %s - %s          ", done_,
                 pairs_, spent.count(), left, a.name.c_str(), b.name.c_str());
    ++done_;
  }
  void end() const {
    const double cpu = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
    std::fprintf(stderr, "\r%zu pairs, %.0f s of one processor\n", pairs_, cpu);
  }

 private:
  std::size_t pairs_, done_ = 0;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace
}  // namespace volcontact::test

int main(int argc, char** argv) {
  using namespace volcontact::test;
  Effort effort{.poses = 12,
                .gradient_poses = 3,
                .motion_steps = 21,
                .octree_poses = 6,
                .slow_octree_poses = 2};
  std::vector<volcontact::Engine> named;
  for (int i = 1; i < argc; ++i) {
    if (const int poses = std::atoi(argv[i])) {
      effort.poses = poses;
    } else {
      named.push_back(volcontact::engine_from(argv[i]));
    }
  }
  if (!named.empty()) effort.engines = named;
  std::vector<std::pair<const Example*, const Example*>> pairs;
  for (const Example& a : examples()) {
    for (const Example& b : examples()) {
      if (&a <= &b && is_pair(a, b)) pairs.emplace_back(&a, &b);
    }
  }
  print_header();
  Progress progress(pairs.size());
  for (const auto& [a, b] : pairs) {
    progress.show(*a, *b);
    for (const Characterisation& row : characterise(*a, *b, effort)) print(row);
  }
  progress.end();
}
