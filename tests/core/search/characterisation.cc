// SPDX-License-Identifier: Apache-2.0
#include "core/search/characterisation.h"

#include <algorithm>
#include <chrono>

#include "core/support/gradient.h"

namespace volcontact::test {
namespace {

struct Case {
  Pose X_AB;
  Lookout lookout;
  Reference reference;
};

constexpr double kDoubt = 1e-5;  // of V: worse references are dropped
constexpr double kWorstDoubt =
    1e-3;  // ... where one of the three directions is far off, two may be

bool is_sure(const Reference& r) {
  const double volume = r.metrics.volume;
  return r.volume_error <= kDoubt * volume && r.worst_error <= kWorstDoubt * volume;
}

// The overlaps of one pair that are worth a comparison.
std::vector<Case> cases_of(const Example& a, const Example& b, const Effort& effort) {
  constexpr double kLeast = 1e-9;  // of the smaller body
  std::vector<Case> cases;
  Random random(20 + 97 * static_cast<std::uint64_t>(&a - examples().data()) +
                static_cast<std::uint64_t>(&b - examples().data()));
  const double size = std::min(a.size, b.size);
  for (int i = 0; i < effort.poses; ++i) {
    for (int attempt = 0; attempt < 20; ++attempt) {
      ContactPose pose;
      if (i % 3 == 0) pose = random_overlap(a, b, random);
      if (i % 3 == 1) {
        const double depth = random.log_uniform(1e-3, 0.1) * size;
        pose = shallow_overlap(a, b, depth, i % 2 * random.uniform(0.0, 0.2), random);
      }
      if (i % 3 == 2) pose = aligned_overlap(a, b, random);
      const Reference r = reference_integral(a.reference, b.reference, pose.X_AB, pose.lookout);
      const double volume = r.metrics.volume;
      if (!(volume > kLeast * std::min(a.own_volume, b.own_volume))) continue;
      if (!is_sure(r)) continue;
      cases.push_back({pose.X_AB, pose.lookout, r});
      break;
    }
  }
  return cases;
}

double length_of(const VolumeMetrics& m) { return std::sqrt(m.second_moment().trace() / m.volume); }

class EngineJudge {
 public:
  EngineJudge(const Example& a, const Example& b, Engine engine, const Effort& effort)
      : a_(a), b_(b), effort_(effort) {
    options_.engine = engine;
    if (engine == Engine::kOctree) options_.tolerance = effort.octree_tolerance;
    row_.a = &a;
    row_.b = &b;
    row_.engine = engine;
  }

  void compare(const Pose& X_AB, const Reference& reference) {
    if (!serves_pose(X_AB)) {
      ++row_.handed_on;
      return;
    }
    const VolumeMetrics m = timed(X_AB);
    const VolumeMetrics& r = reference.metrics;
    ++row_.poses;
    if (!m.touching()) ++row_.missed;
    const double error = std::abs(m.volume - r.volume), length = length_of(r);
    volume_.push_back(error / r.volume);
    centroid_.push_back((m.centroid - r.centroid).norm() / length);
    inertia_.push_back((m.inertia - r.inertia).norm() / r.inertia.norm());
    const double doubt = 2.0 * reference.volume_error + 2e-8 * r.volume;
    row_.volume_beyond = std::max(row_.volume_beyond, (error - doubt) / r.volume);
    if (error <= m.volume_error + doubt) ++row_.bounds_held;
    row_.reference_error = std::max(row_.reference_error, reference.volume_error / r.volume);
    const bool areas_known = reference.worst_error <= kDoubt * r.volume;
    const bool shared = reference.shared_area > kShared * (r.area + r.counter_area);
    if (r.area > 0.0 && areas_known && !shared) compare_areas(X_AB, m, r);
  }

  /// V along a smooth motion, one value a pose, against the same of the reference.
  void compare_motion(const std::vector<Pose>& poses, const std::vector<double>& volumes) {
    if (!std::all_of(poses.begin(), poses.end(),
                     [this](const Pose& X_AB) { return serves_pose(X_AB); })) {
      return;
    }
    double error = 0.0, size = 0.0, before = 0.0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const double volume = evaluate(poses[i]).volume;
      if (i > 0) {
        const double expected = volumes[i] - volumes[i - 1];
        error += std::pow(volume - before - expected, 2);
        size += expected * expected;
      }
      before = volume;
    }
    if (size > 0.0) row_.noise = std::sqrt(error / size);
  }

  Characterisation row() {
    row_.volume = spread_of(volume_);
    row_.centroid = spread_of(centroid_);
    row_.inertia = spread_of(inertia_);
    row_.area_vector = spread_of(area_vector_);
    row_.area_moment = spread_of(area_moment_);
    row_.gradient = spread_of(gradient_);
    row_.turn = spread_of(turn_);
    row_.microseconds = spread_of(times_).median;
    return row_;
  }

 private:
  static constexpr double kShared = 1e-6;  // of the areas: shared faces that do not matter

  // A rough answer tells which engine makes it: lines leave some composed solids to others.
  bool serves_pose(const Pose& X_AB) {
    InterferenceOptions rough = options_;
    rough.tolerance = 1.0;
    interference(a_.shape, b_.shape, X_AB, rough, workspace_, result_);
    return result_.engine == options_.engine;
  }

  VolumeMetrics evaluate(const Pose& X_AB) {
    interference(a_.shape, b_.shape, X_AB, options_, workspace_, result_);
    return result_.total;
  }

  VolumeMetrics timed(const Pose& X_AB) {
    const int calls = options_.engine == Engine::kOctree ? 1 : 8;
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < calls; ++i) evaluate(X_AB);
    const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - begin;
    times_.push_back(time.count() / calls);
    return result_.total;
  }

  void compare_areas(const Pose& X_AB, const VolumeMetrics& m, const VolumeMetrics& r) {
    const double arm = length_of(r) + r.centroid.norm();
    area_vector_.push_back((m.area_vector - r.area_vector).norm() / r.area);
    area_moment_.push_back((m.area_moment - r.area_moment).norm() / (r.area * arm));
    if (options_.engine == Engine::kOctree) return;
    if (static_cast<int>(gradient_.size()) >= effort_.gradient_poses) return;
    // Of the mean depth, or of the width of an overlap that is nearly all of a solid.
    const double step = 0.02 * std::min(r.volume / r.area, std::sqrt(r.area));
    const Gradient g = gradient_of_A([&](const Pose& X) { return evaluate(X).volume; }, X_AB, step);
    gradient_.push_back((g.shift - m.area_vector).norm() / r.area);
    turn_.push_back((g.turn - m.area_moment).norm() / (r.area * arm));
  }

  const Example &a_, &b_;
  const Effort& effort_;
  InterferenceOptions options_;
  InterferenceWorkspace workspace_;
  Interference result_;
  Characterisation row_;
  std::vector<double> volume_, centroid_, inertia_, area_vector_, area_moment_, gradient_, turn_;
  std::vector<double> times_;
};

Reference mirrored(const Reference& r, const Pose& X_AB) {
  return {reversed(transformed(r.metrics, X_AB.inverse())), r.volume_error, r.worst_error,
          r.shared_area};
}

// Where the octree takes its time.
bool is_slow_in_octree(const Example& e) {
  if (std::holds_alternative<Mesh>(e.shape)) return true;
  const auto is = [](const SimpleShape& s) {
    return std::holds_alternative<Frustum>(s) || std::holds_alternative<Torus>(s);
  };
  for (const Csg::Member& member : composed(e.shape).members()) {
    if (is(member.shape)) return true;
  }
  return false;
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  return {static_cast<int>(values.size()), values[values.size() / 2], values.back()};
}

std::vector<Characterisation> characterise(const Example& a, const Example& b,
                                           const Effort& effort) {
  const std::vector<Case> cases = cases_of(a, b, effort);
  // A slide with changing depth and tilt, from a tilted shallow pose.
  Random random(5);
  const double size = std::min(a.size, b.size);
  std::vector<Pose> motion;
  std::vector<double> volumes;
  bool volumes_are_sure = true;
  ContactPose start = shallow_overlap(a, b, 0.1 * size, 0.1, random);
  for (int i = 0; i < effort.motion_steps; ++i) {
    const double s = static_cast<double>(i) / effort.motion_steps;
    const Vec3 normal = start.lookout.X_AF.rotation.col(2);
    const Vec3 along = start.lookout.X_AF.rotation.col(0);
    const Vec3 shift = size * (0.03 * s * along - 0.02 * s * (1.0 + s) * normal);
    motion.push_back(moved(start.X_AB, shift, 0.02 * s * along));
    const Reference r = reference_integral(a.reference, b.reference, motion.back(), start.lookout);
    volumes.push_back(r.metrics.volume);
    volumes_are_sure = volumes_are_sure && is_sure(r);
  }
  const bool slow = is_slow_in_octree(a) || is_slow_in_octree(b);
  std::vector<Characterisation> rows;
  const auto judge = [&](const Example& first, const Example& second, Engine engine, bool mirror) {
    const bool octree = engine == Engine::kOctree;
    const auto most =
        static_cast<std::size_t>(slow ? effort.slow_octree_poses : effort.octree_poses);
    EngineJudge engine_judge(first, second, engine, effort);
    for (std::size_t i = 0; i < (octree ? std::min(cases.size(), most) : cases.size()); ++i) {
      const Case& c = cases[i];
      engine_judge.compare(mirror ? c.X_AB.inverse() : c.X_AB,
                           mirror ? mirrored(c.reference, c.X_AB) : c.reference);
    }
    std::vector<Pose> poses;
    for (const Pose& X : motion) poses.push_back(mirror ? X.inverse() : X);
    if (volumes_are_sure && !(octree && slow)) engine_judge.compare_motion(poses, volumes);
    rows.push_back(engine_judge.row());
  };
  for (const Engine engine : effort.engines) {
    if (engine == Engine::kAuto || !serves(engine, a.shape, b.shape)) continue;
    judge(a, b, engine, false);
    if (&a != &b) judge(b, a, engine, true);
  }
  return rows;
}

}  // namespace volcontact::test
