// SPDX-License-Identifier: Apache-2.0
#include "core/support/fuzz.h"

#include <algorithm>
#include <cstdio>

namespace volcontact::test {
namespace {

constexpr double kLeast = 1e-9;        // of the smaller body: below it a missed overlap is nothing
constexpr double kSuspicious = 1e-5;   // difference to the coarse reference that asks for the fine
constexpr double kWorstCurved = 0.05;  // an error of V that is listed as a failure
constexpr double kWorstExact = 1e-5;

class Search {
 public:
  explicit Search(const FuzzPlan& plan) : plan_(plan), random_(plan.seed) {
    for (const Engine engine : kEngines) {
      report_.counts.push_back({});
      report_.counts.back().engine = engine;
    }
  }

  FuzzReport run() {
    std::vector<std::pair<const Example*, const Example*>> pairs;
    for (const Example& a : examples()) {
      for (const Example& b : examples()) {
        if (!is_pair(a, b)) continue;
        if (!plan_.only.empty() && plan_.only != a.name + "-" + b.name) continue;
        if (plan_.octree_share == 0.0 && may_need_octree(a, b)) continue;
        pairs.emplace_back(&a, &b);
      }
    }
    const int total = plan_.random_poses + plan_.degenerate_poses;
    if (pairs.empty()) return report_;
    for (int i = 0; i < total; ++i) {
      const auto& [a, b] = pairs[static_cast<std::size_t>(i) % pairs.size()];
      if (may_need_octree(*a, *b) && random_.uniform() >= plan_.octree_share) continue;
      check(*a, *b, i < plan_.random_poses ? any_pose(*a, *b) : degenerate_pose(*a, *b));
    }
    return report_;
  }

 private:
  static bool may_need_octree(const Example& a, const Example& b) {
    const auto composed = [](const Example& e) { return std::holds_alternative<Csg>(e.shape); };
    return composed(a) || composed(b) || engine_for(a.shape, b.shape) == Engine::kOctree;
  }

  ContactPose any_pose(const Example& a, const Example& b) {
    if (random_.uniform() < 0.3) return random_overlap(a, b, random_);
    const double depth = random_.log_uniform(1e-6, 0.1) * std::min(a.size, b.size);
    return shallow_overlap(a, b, depth, random_.log_uniform(1e-6, 1.0), random_);
  }
  ContactPose degenerate_pose(const Example& a, const Example& b) {
    const double kind = random_.uniform();
    if (kind < 0.6) return aligned_overlap(a, b, random_);
    constexpr double kDepths[] = {0.0, 1e-15, -1e-15, 1e-12, 1e-9, 1e-3, 0.125};
    const double depth = kDepths[static_cast<int>(random_.uniform(0.0, 7.0))];
    const double tilt = kind < 0.8 ? 0.0 : random_.log_uniform(1e-15, 1e-6);
    return shallow_overlap(a, b, depth, tilt, random_);
  }

  void check(const Example& a, const Example& b, ContactPose pose) {
    InterferenceOptions options;
    if (engine_for(a.shape, b.shape) == Engine::kOctree) {
      options.tolerance = plan_.octree_tolerance;
    }
    interference(a.shape, b.shape, pose.X_AB, options, workspace_, result_);
    const VolumeMetrics& m = result_.total;
    FuzzCount& count = report_.counts[static_cast<std::size_t>(result_.engine)];
    ++count.poses;
    const double body = std::min(a.own_volume, b.own_volume);
    const auto fail = [&](const char* what, double expected) {
      report_.failures.push_back(
          {a.name, b.name, what, result_.engine, pose.X_AB, m.volume, expected});
    };
    bool finite = is_finite(m);
    for (const VolumeMetrics& site : result_.sites) finite = finite && is_finite(site);
    if (!finite) return fail("not finite", 0.0);
    if (m.volume < 0.0) return fail("negative volume", 0.0);
    if (m.volume > 1.05 * body) return fail("larger than a body", body);

    const double volume = m.volume, bound = m.volume_error;
    interference(b.shape, a.shape, pose.X_AB.inverse(), options, workspace_, mirrored_);
    const bool is_exact = result_.engine == Engine::kClosedForm || result_.engine == Engine::kClip;
    const double allowed = is_exact ? 1e-9 * volume + 1e-3 * kLeast * body
                                    : kWorstCurved * volume + bound + kLeast * body;
    if (!(std::abs(mirrored_.total.volume - volume) <= allowed)) {
      fail("another volume in the other order", mirrored_.total.volume);
    }
    if (volume > 0.0 && random_.uniform() >= plan_.reference_share) {
      ++count.overlapping;
      return;
    }
    pose.lookout.all_axes = false;
    pose.lookout.tolerance = 1e-4;
    const auto reference = [&] {
      return reference_integral(a.reference, b.reference, pose.X_AB, pose.lookout);
    };
    double expected = reference().metrics.volume;
    const auto differs = [&] {
      return std::abs(m.volume - expected) > kSuspicious * expected + 1e-3 * kLeast * body;
    };
    if (differs()) {
      pose.lookout = {pose.lookout.X_AF, pose.lookout.half_range};
      const Reference fine = reference();
      expected = fine.metrics.volume;
      const bool exact = fine.volume_error <= 1e-4 * expected + 1e-3 * kLeast * body;
      if (differs() && !exact) {
        ++report_.undecided;
        return;
      }
    }
    if (!(expected > kLeast * body)) {
      if (m.volume > 10.0 * kLeast * body + m.volume_error) fail("overlap where none is", expected);
      return;
    }
    ++count.overlapping;
    const double error = std::abs(m.volume - expected) / expected;
    count.errors.push_back(static_cast<float>(error));
    if (m.volume == 0.0) return fail("missed", expected);
    // Of a sliver, a thousand-millionth of a body, the reference knows a thousandth.
    const double doubt = 1e-3 * kLeast * body / expected;
    if (error > (is_exact ? kWorstExact * 10.0 : kWorstCurved) + doubt) {
      fail("wrong volume", expected);
    }
  }

  const FuzzPlan plan_;
  Random random_;
  FuzzReport report_;
  InterferenceWorkspace workspace_;
  Interference result_, mirrored_;
};

}  // namespace

FuzzReport fuzz(const FuzzPlan& plan) { return Search(plan).run(); }

std::string literal(const Pose& pose) {
  std::string text = "Pose{(Mat3() << ";
  char number[40];
  for (int i = 0; i < 9; ++i) {
    std::snprintf(number, sizeof number, "%.17g%s", pose.rotation(i / 3, i % 3), i < 8 ? ", " : "");
    text += number;
  }
  text += ").finished(), Vec3(";
  for (int i = 0; i < 3; ++i) {
    std::snprintf(number, sizeof number, "%.17g%s", pose.translation[i], i < 2 ? ", " : ")}");
    text += number;
  }
  return text;
}

}  // namespace volcontact::test
