// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/pressure/pressure_layers.h"

#include <algorithm>
#include <type_traits>

#include "volcontact/pair/quadrature/outer_rule.h"
#include "volcontact/shape/parallel_solid.h"

namespace volcontact {
namespace {

// Asked of the overlap at each level; of lines more, which work twice as long then at most.
constexpr double kLayerTolerance = 1e-5;
constexpr double kTighter = 1e-8;
constexpr double kColumnTolerance = 1e-4;  // over round solids, which are better than they say
// Where another engine leaves a pose to the octree, every level must be cheap. Columns over round
// solids count their triangles against the same budget.
constexpr int kMostCellsOfLevel = 500;
constexpr int kMostTrianglesOfLevel = 3000;
constexpr double kNearTop = 1e-6;     // where the search for the top ends, per height
constexpr int kMostSteps = 12;        // of that search
constexpr double kFirstStep = 0.9;    // of the least distance to the top
constexpr double kFurtherStep = 0.9;  // of the distance to the top as it seems now
constexpr double kMostPower = 3.0;    // V^(1/3) is concave between convex solids

/// The overlap of the solids under the layers.
struct Level {
  double volume = 0.0;
  double fall = 0.0;          ///< -d volume / d t
  Vec3 shift = Vec3::Zero();  ///< d volume / d x_A
  Vec3 turn = Vec3::Zero();   ///< d volume / d theta_A, about A's origin
  double error = 0.0;         ///< of |shift|, where a budget ended the refinement

  /// Nearly (top - t) over the power with which the volume vanishes there.
  double reach() const { return volume / fall; }
};

class LayerSum {
 public:
  LayerSum(const Shape& a, const Shape& b, const Pose& X_AB, const PressureSite& site,
           PressureScratch& scratch)
      : a_(a), b_(b), X_AB_(X_AB), site_(site), s_(scratch), options_(site.options) {
    bool layer_a = has_parallel_solids(a), layer_b = has_parallel_solids(b);
    if (!layer_a && !layer_b) {
      layer_a = has_composed_parallels(a), layer_b = has_composed_parallels(b);
    }
    share_a_ = layer_a && layer_b ? site.share_of_a : layer_a ? 1.0 : 0.0;
    share_b_ = 1.0 - share_a_;
    // Octrees are not asked for more than they can do in a step.
    const Engine engine = options_.engine == Engine::kAuto ? engine_for(a, b) : options_.engine;
    if (engine != Engine::kOctree) ask_of_levels(engine);
    ceiling_ = std::min(share_a_ > 0.0 ? greatest_depth(a) / share_a_ : kInfinity,
                        share_b_ > 0.0 ? greatest_depth(b) / share_b_ : kInfinity);
  }

  PressureField integrate() {
    using Rule = GaussRule<8>;
    PressureField field;
    const double top = find_top();
    if (!(top > 0.0)) return field;
    Vec3 turn = Vec3::Zero();  // -d energy / d theta_A about A's origin
    double drift = 0.0;        // d energy / d top: what the rule is in error
    Level last;
    for (int i = 0; i < 8; ++i) {
      // Volumes vanish with half-integer powers at the top: t = top (1 - s^2) makes them smooth.
      const double s = 1.0 - Rule::kNodes[i];
      const double place = 1.0 - s * s, weight = 2.0 * s * Rule::kWeights[i];
      const Level at = level(place * top);
      field.energy += top * weight * at.volume;
      field.force -= top * weight * at.shift;
      turn -= top * weight * at.turn;
      field.error += top * weight * at.error;
      drift += weight * (at.volume - place * top * at.fall);
      if (at.volume > 0.0 && at.fall > 0.0) last = at;
    }
    // The levels move with the top, which moves with A.
    if (last.fall > 0.0) {
      field.force -= drift / last.fall * last.shift;
      turn -= drift / last.fall * last.turn;
    }
    field.couple = turn - site_.metrics().centroid.cross(field.force);
    return field;
  }

 private:
  void ask_of_levels(Engine engine) {
    const auto one_is = [&]<typename S>(std::type_identity<S>) {
      return std::holds_alternative<S>(a_) || std::holds_alternative<S>(b_);
    };
    const bool composed = one_is(std::type_identity<Csg>{});
    const bool clipped = one_is(std::type_identity<Box>{});
    double tolerance = kLayerTolerance;
    const bool estimated = engine == Engine::kLines || engine == Engine::kSurfaceSweep;
    if (estimated && !composed) tolerance = kTighter;
    if (estimated && composed) limit_cells(kMostCellsOfLevel);
    if (engine == Engine::kColumns && !clipped) {
      tolerance = kColumnTolerance;
      limit_cells(kMostTrianglesOfLevel);
    }
    options_.tolerance = std::min(options_.tolerance, tolerance);
  }

  void limit_cells(int most) { options_.most_cells = std::min(options_.most_cells, most); }

  // Where the last of the overlap vanishes.
  double find_top() {
    Level low = level(0.0);
    if (!(low.volume > 0.0)) return 0.0;
    double t_low = 0.0, t = low.fall > 0.0 ? kFirstStep * low.reach() : kInfinity;
    t = std::min(t, 0.5 * ceiling_);
    double above = ceiling_, top = ceiling_;  // certainly above it; where it seems to be
    for (int step = 0; step < kMostSteps; ++step) {
      const Level at = level(t);
      if (!(at.volume > 0.0)) {
        above = top = t;
        t = 0.5 * (t_low + t);
        continue;
      }
      const double nearer = low.fall > 0.0 ? low.reach() - at.reach() : 0.0, before = top;
      const double power =
          nearer > 0.0 ? std::clamp((t - t_low) / nearer, 1.0, kMostPower) : kMostPower;
      top = at.fall > 0.0 ? std::min(t + power * at.reach(), above) : above;
      if (step > 0 && std::abs(top - before) <= kNearTop * top) break;
      t_low = t, low = at;
      t += kFurtherStep * (top - t);
    }
    return top;
  }

  Level level(double t) {
    Pose X_AI, X_BJ;
    const Shape *a = &a_, *b = &b_;
    if (share_a_ > 0.0) {
      if (!parallel_solid(a_, share_a_ * t, s_.inner_a, X_AI)) return {};
      a = &s_.inner_a;
    }
    if (share_b_ > 0.0) {
      if (!parallel_solid(b_, share_b_ * t, s_.inner_b, X_BJ)) return {};
      b = &s_.inner_b;
    }
    interference(*a, *b, X_AI.inverse() * X_AB_ * X_BJ, options_, *s_.engines, s_.level);
    // Left to the octree, without having chosen it.
    if (options_.engine != Engine::kOctree && s_.level.engine == Engine::kOctree) {
      limit_cells(kMostCellsOfLevel);
    }
    if (s_.level.total.status == Status::kContained) return inside(*a, *b);
    if (site_.sites.size() < 2) return level_of(transformed(s_.level.total, X_AI));
    Level sum;
    for (const VolumeMetrics& part : s_.level.sites) {
      const VolumeMetrics metrics = transformed(part, X_AI);
      if (site_.nearest(metrics.centroid) != site_.index) continue;
      const Level at = level_of(metrics);
      sum.volume += at.volume, sum.fall += at.fall;
      sum.shift += at.shift, sum.turn += at.turn, sum.error += at.error;
    }
    return sum;
  }

  Level level_of(const VolumeMetrics& metrics) const {
    const bool is_rough = metrics.status == Status::kApproximate && metrics.volume > 0.0;
    const double error = is_rough ? metrics.volume_error / metrics.volume : 0.0;
    return {metrics.volume, share_a_ * metrics.area + share_b_ * metrics.counter_area,
            metrics.area_vector, metrics.area_moment, error * metrics.area_vector.norm()};
  }

  // All of one solid. Its surface alone counts, and does not feel the other one.
  Level inside(const Shape& a, const Shape& b) const {
    const double volume_a = own_metrics_of(a).volume, volume = s_.level.total.volume;
    const bool is_a = std::abs(volume - volume_a) < 1e-6 * volume;
    return {volume, is_a ? share_a_ * surface_area(a) : share_b_ * surface_area(b), Vec3::Zero(),
            Vec3::Zero(), 0.0};
  }

  const Shape& a_;
  const Shape& b_;
  const Pose& X_AB_;
  const PressureSite& site_;
  PressureScratch& s_;
  InterferenceOptions options_;
  double share_a_, share_b_;
  double ceiling_;  // of psi in either solid
};

}  // namespace

PressureField pressure_layers(const Shape& a, const Shape& b, const Pose& X_AB,
                              const PressureSite& site, PressureScratch& scratch) {
  if (!scratch.engines) scratch.engines = std::make_unique<InterferenceWorkspace>();
  return LayerSum(a, b, X_AB, site, scratch).integrate();
}

}  // namespace volcontact
