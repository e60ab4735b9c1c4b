// SPDX-License-Identifier: Apache-2.0
#include "core/search/fuzz.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <tuple>

#include "core/search/overlap_checks.h"

namespace volcontact::test {
namespace {

constexpr double kLeast = 1e-9;        // of the smaller body: below it a missed overlap is nothing
constexpr double kSuspicious = 1e-5;   // difference to the coarse reference that asks for a finer
constexpr double kWorstCurved = 0.05;  // an error of V that is listed as a failure
constexpr double kWorstExact = 1e-4;   // likewise; the reference has its share in it
constexpr double kFlat = 0.02, kNotANumber = 0.02;  // shares of the degenerate poses

bool has_cone_or_ring(const Example& e) {
  if (std::holds_alternative<Mesh>(e.shape)) return false;
  for (const Csg::Member& member : composed(e.shape).members()) {
    if (std::holds_alternative<Frustum>(member.shape)) return true;
    if (std::holds_alternative<Torus>(member.shape)) return true;
  }
  return false;
}

// Turns through the pairs, each in proportion to its weight.
class Turns {
 public:
  Turns(const FuzzPlan& plan, Random& random) {
    for (const Example& a : examples()) {
      for (const Example& b : examples()) {
        if (!is_pair(a, b)) continue;
        if (!plan.only.empty() && plan.only != a.name + "-" + b.name) continue;
        const double weight = plan.weights[static_cast<int>(cost_of(a, b))];
        if (weight > 0.0) turns_.push_back({&a, &b, weight, random.uniform()});
      }
    }
  }
  bool empty() const { return turns_.empty(); }
  std::pair<const Example*, const Example*> next() {
    for (;;) {
      Turn& turn = turns_[index_++ % turns_.size()];
      turn.credit += turn.weight;
      if (turn.credit < 1.0) continue;
      turn.credit -= 1.0;
      return {turn.a, turn.b};
    }
  }

 private:
  struct Turn {
    const Example *a, *b;
    double weight, credit;
  };
  std::vector<Turn> turns_;
  std::size_t index_ = 0;
};

class Search {
 public:
  explicit Search(const FuzzPlan& plan) : plan_(plan), random_(plan.seed), turns_(plan, random_) {
    for (const Engine engine : kEngines) {
      for (const bool degenerate : {false, true}) {
        report_.counts.push_back({.engine = engine, .degenerate = degenerate, .errors = {}});
      }
    }
  }

  FuzzReport run() {
    if (turns_.empty()) return report_;
    for (int i = 0; i < plan_.random_poses + plan_.degenerate_poses; ++i) {
      std::tie(a_, b_) = turns_.next();
      degenerate_ = i >= plan_.random_poses;
      const double kind = degenerate_ ? random_.uniform() : 1.0;
      if (kind < kFlat) {
        check_flat();
      } else if (kind < kFlat + kNotANumber) {
        check_not_a_number();
      } else {
        check(degenerate_ ? degenerate_pose() : any_pose());
      }
    }
    return report_;
  }

 private:
  ContactPose any_pose() {
    if (random_.uniform() < 0.3) return random_overlap(*a_, *b_, random_);
    const double depth = random_.log_uniform(1e-6, 0.1) * std::min(a_->size, b_->size);
    return shallow_overlap(*a_, *b_, depth, random_.log_uniform(1e-6, 1.0), random_);
  }
  ContactPose degenerate_pose() {
    const double kind = random_.uniform();
    if (kind < 0.6) return aligned_overlap(*a_, *b_, random_);
    constexpr double kDepths[] = {0.0, 1e-15, -1e-15, 1e-12, 1e-9, 1e-3, 0.125};
    const double depth = kDepths[static_cast<int>(random_.uniform(0.0, 7.0))];
    const double tilt = kind < 0.8 ? 0.0 : random_.log_uniform(1e-15, 1e-6);
    return shallow_overlap(*a_, *b_, depth, tilt, random_);
  }

  void fail(const char* what, double expected) {
    report_.failures.push_back(
        {a_->name, b_->name, what, result_.engine, X_AB_, result_.total.volume, expected});
  }
  FuzzCount& count() {
    return *std::find_if(report_.counts.begin(), report_.counts.end(),
                         [this](const FuzzCount& count) {
                           return count.engine == result_.engine && count.degenerate == degenerate_;
                         });
  }
  InterferenceOptions options() const {
    InterferenceOptions options;
    if (cost_of(*a_, *b_) == Cost::kHigh) options.tolerance = plan_.octree_tolerance;
    return options;
  }

  // B's place is taken by a solid of no volume.
  void check_flat() {
    const auto index = static_cast<std::size_t>(random_.uniform(0.0, flat_solids().size()));
    const Shape& flat = flat_solids()[index];
    X_AB_ = aligned_overlap(*a_, *b_, random_).X_AB;
    if (random_.uniform() < 0.5) X_AB_ = random_.pose(a_->size);
    for (const bool swap : {false, true}) {
      interference(swap ? flat : a_->shape, swap ? a_->shape : flat, X_AB_, {.tolerance = 0.1},
                   workspace_, result_);
      ++count().poses;
      if (!is_finite(result_.total)) return fail("not finite, with a flat solid", 0.0);
      if (result_.total.volume > kLeast) return fail("volume of a flat solid", 0.0);
    }
  }

  void check_not_a_number() {
    constexpr double kBad[] = {std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity};
    X_AB_ = aligned_overlap(*a_, *b_, random_).X_AB;
    const int where = static_cast<int>(random_.uniform(0.0, 12.0));
    double& number =
        where < 9 ? X_AB_.rotation(where / 3, where % 3) : X_AB_.translation[where - 9];
    number = kBad[static_cast<int>(random_.uniform(0.0, 3.0))];
    interference(a_->shape, b_->shape, X_AB_, options(), workspace_, result_);
    ++count().poses;
    if (result_.total.status != Status::kInvalid || result_.total.touching()) {
      fail("a pose that is no number is answered", 0.0);
    }
  }

  void check(const ContactPose& pose) {
    X_AB_ = pose.X_AB;
    interference(a_->shape, b_->shape, X_AB_, options(), workspace_, result_);
    ++count().poses;
    const double volume = result_.total.volume;
    const Vec3 inside = pose.lookout.X_AF.translation;
    if (const char* what = fault_of(result_, *a_, *b_, X_AB_, inside)) return fail(what, 0.0);

    const Pose X_BA = X_AB_.inverse();
    interference(b_->shape, a_->shape, X_BA, options(), workspace_, mirrored_);
    const VolumeMetrics& other = mirrored_.total;
    if (const char* what = fault_of(mirrored_, *b_, *a_, X_BA, X_BA * inside)) {
      std::swap(a_, b_);
      std::swap(result_, mirrored_);
      X_AB_ = X_BA;
      return fail(what, other.volume);
    }
    if (const char* what = disagreement_of(result_.total, other, X_AB_, smaller_body(), is_exact(),
                                           !degenerate_)) {
      fail(what, other.volume);
    }
    const double share = plan_.reference[static_cast<int>(cost_of(*a_, *b_))];
    if (volume == 0.0 && is_apart(pose.lookout.X_AF.rotation.col(2))) return;
    if (volume == 0.0 || random_.uniform() < share) return compare(pose.lookout);
    ++count().overlapping;
  }

  // Whether a plane across the direction, or across an axis of either solid, proves that there is
  // no overlap worth the name.
  bool is_apart(const Vec3& direction) const {
    const auto height = [](const Example& e, const Vec3& d) {
      return std::visit([&d](const auto& solid) { return solid.support_height(d); }, e.shape);
    };
    const auto separates = [&](const Vec3& e) {
      const double reach = height(*a_, e) + height(*b_, -(X_AB_.rotation.transpose() * e));
      return reach - e.dot(X_AB_.translation) < 1e-12;
    };
    const auto parts = [&](const Vec3& e) {
      const double length = e.norm();
      return length > 1e-9 && (separates(e / length) || separates(-e / length));
    };
    const Vec3 way = X_AB_ * b_->bounds.center() - a_->bounds.center();
    for (int i = 0; i < 6; ++i) {
      const Vec3 axis = i < 3 ? Vec3(Vec3::Unit(i)) : Vec3(X_AB_.rotation.col(i - 3));
      if (parts(axis) || parts(way - way.dot(axis) * axis)) return true;
    }
    return parts(direction) || parts(way);
  }

  double smaller_body() const { return std::min(a_->own_volume, b_->own_volume); }
  bool is_exact() const {
    return result_.engine == Engine::kClosedForm || result_.engine == Engine::kClip;
  }

  void compare(Lookout lookout) {
    const VolumeMetrics& m = result_.total;
    const double body = smaller_body();
    const bool certified = result_.engine == Engine::kOctree;
    const Lookout fine_lookout{lookout.X_AF, lookout.half_range};
    lookout.all_axes = false;
    const auto integral = [this](const Lookout& where) {
      return reference_integral(a_->reference, b_->reference, X_AB_, where);
    };
    double expected = 0.0;
    const auto differs = [&] {
      const double expectable = certified ? std::min(0.5 * m.volume_error, 1e-2 * expected) : 0.0;
      return std::abs(m.volume - expected) >
             std::max(expectable, kSuspicious * expected) + 1e-3 * kLeast * body;
    };
    double doubt = 1e-3 * kLeast * body;  // of a sliver the reference knows a thousandth
    for (const double tolerance : {1e-4, 1e-6}) {
      lookout.tolerance = tolerance;
      expected = integral(lookout).metrics.volume;
      if (!differs()) break;
    }
    // Where the answer is another engine's, the certified bound of the octree is cheaper than a
    // fine reference. An answer within twice the bound has about the error that it has to its
    // middle.
    const bool bounded = differs() && !certified && m.touching();
    if (bounded) {
      interference(a_->shape, b_->shape, X_AB_, {.tolerance = 1e-4, .engine = Engine::kOctree},
                   workspace_, mirrored_);
      const VolumeMetrics& bound = mirrored_.total;
      const bool close = bound.volume_error <= 2e-4 * bound.volume;
      if (close && std::abs(m.volume - bound.volume) <= 2.0 * bound.volume_error) {
        return judge(bound.volume, doubt + bound.volume_error);
      }
    }
    if (differs()) {
      const Reference fine = integral(fine_lookout);
      expected = fine.metrics.volume;
      // Lines may all miss a small second site far away.
      const VolumeMetrics& bound = mirrored_.total;
      const bool refuted = bounded && std::abs(expected - bound.volume) >
                                          bound.volume_error + fine.volume_error + doubt;
      if (differs() && (refuted || fine.volume_error > 1e-4 * expected + doubt)) {
        ++report_.undecided;
        return;
      }
      doubt += fine.volume_error;
    }
    judge(expected, doubt);
  }

  // The answer against what is expected to within the doubt.
  void judge(double expected, double doubt) {
    const VolumeMetrics& m = result_.total;
    const double body = smaller_body();
    if (!(expected > kLeast * body)) {
      if (m.volume > 10.0 * kLeast * body + m.volume_error) fail("overlap where none is", expected);
      return;
    }
    ++count().overlapping;
    const double error = std::abs(m.volume - expected);
    count().errors.push_back(static_cast<float>(error / expected));
    if (m.volume == 0.0) return fail("missed", expected);
    if (result_.engine == Engine::kOctree &&
        error > m.volume_error + doubt + kSuspicious * expected) {
      return fail("outside of the certified bound", expected);
    }
    if (error > (is_exact() ? kWorstExact : kWorstCurved) * expected + doubt) {
      fail("wrong volume", expected);
    }
  }

  const FuzzPlan plan_;
  Random random_;
  Turns turns_;
  FuzzReport report_;
  InterferenceWorkspace workspace_;
  const Example *a_ = nullptr, *b_ = nullptr;
  bool degenerate_ = false;
  Pose X_AB_;
  Interference result_, mirrored_;
};

}  // namespace

Cost cost_of(const Example& a, const Example& b) {
  const auto composed = [](const Example& e) { return std::holds_alternative<Csg>(e.shape); };
  const auto mesh = [](const Example& e) { return std::holds_alternative<Mesh>(e.shape); };
  if (mesh(a) || mesh(b)) return composed(a) || composed(b) ? Cost::kHigh : Cost::kMiddle;
  if (composed(a) || composed(b)) {
    return has_cone_or_ring(a) || has_cone_or_ring(b) ? Cost::kHigh : Cost::kMiddle;
  }
  return engine_for(a.shape, b.shape) == Engine::kOctree ? Cost::kHigh : Cost::kLow;
}

const std::vector<Shape>& flat_solids() {
  static const std::vector<Shape> all = {Sphere({.radius = 0.0}),
                                         Ellipsoid({.semi_axes = Vec3(0.3, 0.2, 0.0)}),
                                         Capsule({.radius = 0.0, .half_length = 0.3}),
                                         Cylinder({.radius = 0.3, .half_length = 0.0}),
                                         Box({.half_sizes = Vec3(0.3, 0.2, 0.0)}),
                                         Torus({.major_radius = 0.3, .minor_radius = 0.0})};
  return all;
}

FuzzReport fuzz(const FuzzPlan& plan) { return Search(plan).run(); }

std::string literal(const Pose& pose) {
  std::string text = "Pose{Mat3(";
  char number[40];
  for (int i = 0; i < 9; ++i) {
    std::snprintf(number, sizeof number, "%.17g%s", pose.rotation(i / 3, i % 3), i < 8 ? ", " : "");
    text += number;
  }
  text += "), Vec3(";
  for (int i = 0; i < 3; ++i) {
    std::snprintf(number, sizeof number, "%.17g%s", pose.translation[i], i < 2 ? ", " : ")}");
    text += number;
  }
  return text;
}

}  // namespace volcontact::test
