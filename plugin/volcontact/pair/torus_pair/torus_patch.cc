// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/torus_pair/torus_patch.h"

#include <algorithm>
#include <cmath>

#include "volcontact/pair/quadrature/even_steps.h"
#include "volcontact/pair/quadrature/outer_rule.h"
#include "volcontact/pair/torus_pair/torus_events.h"
#include "volcontact/pair/torus_pair/torus_flux.h"

namespace volcontact {
namespace {

constexpr int kSamples = 11;            // of a range of circles, besides the ends
constexpr int kTurnSamples = 32;        // of a whole turn
constexpr int kMostTurn = 64;           // even steps of it
constexpr int kMostDepth = 24;          // of divisions of a range
constexpr int kMostMoreCircles = 1000;  // besides samples: then the surface stays open
constexpr int kMostEven = 32;           // steps over a range
constexpr double kOneEvent = 3e-6;      // of a range of circles: events this near are one
constexpr double kOpenShare = 0.1;
constexpr int kMostRetries = 6;  // when a slice shows a change that no sample has shown

class PatchSearch {
 public:
  PatchSearch(const TorusSize& ring, const Pose& X, const TorusSize& other, PatchEffort effort,
              TorusPatchScratch& scratch)
      : ring_(ring), X_(X), other_(other), effort_(effort), s_(scratch), out_(scratch.patch) {}

  void run() {
    out_.slices.clear();
    out_.arcs.clear();
    out_.joints.clear();
    out_.nearest.clear();
    out_.chains = 0;
    out_.incomplete = false;
    out_.error = out_.volume_scale = 0.0;
    // A ring is a union of balls about its circle: where they meet the other ring.
    const Circle middle{X_.translation, X_.rotation.col(0), X_.rotation.col(1), ring_.major};
    CircleArcs near;
    find_arcs(middle, {other_.major, other_.minor + ring_.minor}, ArcSearch::kWithMinima,
              effort_.fine, near);
    out_.apart = near.none();
    out_.nearest.assign(near.nearest, near.nearest + near.minima);
    if (near.whole) take_range(0.0, 2.0 * kPi, true);
    for (int i = 0; i < near.count; ++i) take_range(near.low[i], near.high[i], false);
  }

 private:
  using Sample = TorusPatchScratch::Sample;

  CircleArcs arcs_at(double angle) const {
    CircleArcs arcs;
    find_arcs(section_circle(ring_, X_, angle), other_, ArcSearch::kCount, effort_.fine, arcs);
    return arcs;
  }
  Sample sample(double angle) const { return {angle, arc_count(arcs_at(angle))}; }

  void take_range(double low, double high, bool whole) {
    whole_ = whole;
    s_.samples.clear();
    const int parts = (whole ? kTurnSamples : kSamples + 1) * (effort_.fine ? 2 : 1);
    if (!whole) s_.samples.push_back({low, 0});
    for (int i = 1; i < parts; ++i) s_.samples.push_back(sample(low + (high - low) * i / parts));
    const auto add = [&](double angle) {
      angle -= 2.0 * kPi * std::floor((angle - low) / (2.0 * kPi));
      if (angle > low && angle < high) s_.samples.push_back(sample(angle));
    };
    for (double angle : out_.nearest) add(angle);
    for (double angle : s_.hints) add(angle);
    if (whole) {
      s_.samples.push_back(sample(low));
      s_.samples.push_back({high, s_.samples.back().count});
    } else {
      s_.samples.push_back({high, 0});
    }
    mark();
    for (int retry = 0; !take_samples(whole); ++retry) {
      back();
      if (retry < kMostRetries) continue;
      out_.incomplete = true;
      return;
    }
  }

  // What a range has added is dropped when it begins anew.
  void mark() {
    slices_ = out_.slices.size();
    arcs_ = out_.arcs.size();
    joints_ = out_.joints.size();
    chains_ = out_.chains;
    error_ = out_.error;
  }
  void back() {
    out_.slices.resize(slices_);
    out_.arcs.resize(arcs_);
    out_.joints.resize(joints_);
    out_.chains = chains_;
    out_.error = error_;
  }

  // False when a slice had other arcs than the samples beside it: it is a sample now.
  bool take_samples(bool whole) {
    std::sort(s_.samples.begin(), s_.samples.end(),
              [](const Sample& a, const Sample& b) { return a.angle < b.angle; });
    find_torus_events(ring_, X_, other_, effort_.fine, s_.samples, s_.events);
    merge_events();
    if (whole && s_.events.empty()) {
      if (s_.samples[0].count == 0) return true;
      const int taken = take_turn(s_.samples[0].count);
      if (taken != 0) return taken > 0;
      back();
      for (int i = 0; i < 4; ++i) s_.events.push_back(0.5 * kPi * i);
    }
    const std::size_t n = s_.events.size();
    if (n < (whole ? 1 : 2)) return true;
    last_slice_ = -1;
    for (std::size_t i = 0; i + 1 < n + (whole ? 1 : 0); ++i) {
      const double from = s_.events[i],
                   to = i + 1 < n ? s_.events[i + 1] : s_.events[0] + 2.0 * kPi;
      if (!take_between(from, to)) return false;
    }
    if (whole && last_slice_ >= 0 && first_range_filled_) {
      join(last_slice_, static_cast<int>(slices_));
    }
    return true;
  }

  // Where two circles coincide but for rounding, arcs come and go as chance will have it.
  void merge_events() {
    one_event_ = kOneEvent * (s_.samples.back().angle - s_.samples.front().angle);
    s_.events.erase(std::unique(s_.events.begin(), s_.events.end(),
                                [&](double a, double b) { return b - a < one_event_; }),
                    s_.events.end());
  }

  // Of the sample nearest to the middle.
  int count_between(double from, double to) const {
    const double middle = 0.5 * (from + to);
    double least = 0.5 * (to - from);
    int count = kWholeCircle - 1;
    for (const Sample& s : s_.samples) {
      const double way = std::abs(std::remainder(s.angle - middle, 2.0 * kPi));
      if (way < least) {
        least = way;
        count = s.count;
      }
    }
    return count >= kWholeCircle ? count : arc_count(arcs_at(middle));
  }

  bool take_between(double from, double to) {
    const int count = count_between(from, to);
    const bool first = out_.slices.size() == slices_ && from == s_.events[0];
    if (first) first_range_filled_ = count != 0;
    if (count == 0) {
      last_slice_ = -1;
      return true;
    }
    range_from_ = from;
    range_to_ = to;
    lever_ = ring_.minor + 0.5 * (to - from) * ring_.major;
    set_origin(0.5 * (from + to));
    chain_ = out_.chains;
    out_.chains += std::max(count, 1);
    const int begin = static_cast<int>(out_.slices.size());
    if (ends_in_nothing(to) && last_slice_ < 0 && count == 1) {
      const int taken = take_even();
      if (taken < 0) return false;
      if (taken > 0) {
        last_slice_ = static_cast<int>(out_.slices.size()) - 1;
        return true;
      }
    }
    if (!take_part(0.0, kPi, count, 0)) return false;
    if (last_slice_ >= 0) join(last_slice_, begin);
    last_slice_ = static_cast<int>(out_.slices.size()) - 1;
    return true;
  }

  // Whether circles beyond an event have no arcs.
  bool ends_in_nothing(double event) const {
    const std::vector<double>& events = s_.events;
    if (event == events.back()) return !whole_;
    // A whole turn ends where it began.
    const auto found = std::find(events.begin(), events.end(), event);
    const auto here = found == events.end() ? events.begin() : found;
    return here + 1 != events.end() && count_between(*here, *(here + 1)) == 0;
  }

  // One arc that comes from nothing and ends in nothing: as a function of t, see take_part, its
  // share is even and periodic, and equal steps converge fastest. 1 when they do, 0 when they do
  // not, -1 when a circle has other arcs.
  int take_even() {
    const std::size_t slices = out_.slices.size(), arcs = out_.arcs.size();
    double volume[kLanes], area[kLanes], sum[2];
    for (int i = 0; i < kLanes; ++i) {
      if (!add_even(kPi * (i + 0.5) / kLanes, kLanes, volume[i], area[i])) return -1;
    }
    double error = even_steps().error(volume, sum[0]), open = even_steps().error(area, sum[1]);
    for (int steps = kLanes, offset = 0;; offset = 1) {
      const double other = kOpenShare * lever_ * open;
      const double scale = std::max(out_.volume_scale, std::abs(sum[0]));
      if (std::max(error, other) <= effort_.target * scale && steps >= effort_.least_steps) {
        out_.volume_scale = scale;
        out_.error += error;
        return 1;
      }
      if (steps == kMostEven) break;
      // As many steps again, between those before, make a rule with twice as many.
      double more[2] = {0.0, 0.0}, v, a;
      for (int i = 1 - offset; i < steps; ++i) {
        if (!add_even(kPi * (i + 0.5 * offset) / steps, steps, v, a)) return -1;
        more[0] += v;
        more[1] += a;
      }
      for (std::size_t i = slices; i < out_.slices.size(); ++i) out_.slices[i].weight *= 0.5;
      error = 0.5 * even_error(std::abs(sum[0]), std::abs(more[0]));
      open = 0.5 * even_error(sum[1], more[1]);
      for (int i = 0; i < 2; ++i) sum[i] = 0.5 * (sum[i] + more[i]);
      steps *= 2;
    }
    out_.slices.resize(slices);
    out_.arcs.resize(arcs);
    return 0;
  }
  bool add_even(double t, int steps, double& volume, double& area) {
    const double half = 0.5 * (range_to_ - range_from_);
    return add_slice(range_from_ + half - half * std::cos(t), half * kPi / steps * std::sin(t), 1,
                     volume, area);
  }

  // angle = middle - half cos t: integrands like the root of the way from an end are smooth in t.
  bool take_part(double t_from, double t_to, int count, int depth) {
    const double half = 0.5 * (range_to_ - range_from_), middle = range_from_ + half;
    const std::size_t slices = out_.slices.size(), arcs = out_.arcs.size();
    double terms[kLanes], areas[kLanes];
    double volume = 0.0;
    for (int i = 0; i < kLanes; ++i) {
      const double t = t_from + (t_to - t_from) * OuterRule::kNodes[i];
      const double weight = OuterRule::kWeights[i] * (t_to - t_from) * half * std::sin(t);
      if (!add_slice(middle - half * std::cos(t), weight, count, terms[i], areas[i])) return false;
      volume += terms[i];
    }
    const double error = legendre_error(terms);
    out_.volume_scale = std::max(out_.volume_scale, std::abs(volume));
    // Where the surface looks at the place that the flux is about, the area alone shows an error.
    const double other = kOpenShare * lever_ * legendre_error(areas);
    if (std::max(error, other) > effort_.target * out_.volume_scale
            ? depth < kMostDepth && spent_ < kMostMoreCircles
            : depth < (effort_.least_steps > kLanes ? 2 : 0)) {
      out_.slices.resize(slices);
      out_.arcs.resize(arcs);
      const double t = 0.5 * (t_from + t_to);
      return take_part(t_from, t, count, depth + 1) && take_part(t, t_to, count, depth + 1);
    }
    out_.error += error;
    return true;
  }

  // A whole turn without events, by equal steps: 1 when they converge, 0 when they do not, -1 when
  // a circle has other arcs.
  int take_turn(int count) {
    set_origin(0.0);
    lever_ = ring_.major + ring_.minor;
    range_from_ = -kPi;  // no event near any circle
    range_to_ = 3.0 * kPi;
    chain_ = out_.chains;
    out_.chains += std::max(count, 1);
    double sum[2] = {0.0, 0.0}, more[2];
    const auto add_steps = [&](int steps, double offset, double* to) {
      to[0] = to[1] = 0.0;
      for (int i = 0; i < steps; ++i) {
        double volume, area;
        if (!add_slice(2.0 * kPi * (i + offset) / steps, 2.0 * kPi / steps, count, volume, area)) {
          return false;
        }
        to[0] += volume;
        to[1] += area;
      }
      return true;
    };
    if (!add_steps(kLanes, 0.0, sum)) return -1;
    for (int steps = kLanes; 2 * steps <= kMostTurn; steps *= 2) {
      if (!add_steps(steps, 0.5, more)) return -1;
      const double error = 0.5 * even_error(std::abs(sum[0]), std::abs(more[0]));
      const double other = kOpenShare * lever_ * 0.5 * even_error(sum[1], more[1]);
      for (int i = 0; i < 2; ++i) sum[i] = 0.5 * (sum[i] + more[i]);
      const double scale = std::max(out_.volume_scale, std::abs(sum[0]));
      if (!(std::max(error, other) <= effort_.target * scale)) continue;
      out_.volume_scale = scale;
      out_.error += error;
      for (std::size_t i = slices_; i < out_.slices.size(); ++i) {
        out_.slices[i].weight = kPi / steps;
      }
      return 1;
    }
    return 0;
  }

  // Adds the circle at an angle; false when it has not `count` arcs. `term` is its share of V.
  bool add_slice(double angle, double weight, int count, double& term, double& area) {
    term = area = 0.0;
    ++spent_;
    const Circle circle = section_circle(ring_, X_, angle);
    CircleArcs arcs;
    find_arcs(circle, other_, ArcSearch::kArcs, effort_.fine, arcs);
    if (arc_count(arcs) != count) {
      if (std::min(angle - range_from_, range_to_ - angle) < one_event_) return true;
      s_.samples.push_back({angle, arc_count(arcs)});
      return false;
    }
    TorusPatch::Slice slice{angle, weight, static_cast<int>(out_.arcs.size()), 0};
    if (arcs.whole) {
      out_.arcs.push_back({0.0, 2.0 * kPi, chain_});
    }
    const int shift = arcs.count > 1 ? shift_to_last(arcs) : 0;
    for (int k = 0; k < arcs.count; ++k) {
      out_.arcs.push_back({arcs.low[k], arcs.high[k], chain_ + (k + shift) % arcs.count});
    }
    slice.last = static_cast<int>(out_.arcs.size());
    for (int k = slice.first; k < slice.last; ++k) {
      term += weight * arc_flux(ring_, circle, origin_, out_.arcs[k].low, out_.arcs[k].high);
      area += weight * ring_.minor * ring_.major * (out_.arcs[k].high - out_.arcs[k].low);
    }
    out_.slices.push_back(slice);
    return true;
  }

  // By how much the arcs of a slice are turned against those of the slice before.
  int shift_to_last(const CircleArcs& arcs) const {
    if (out_.slices.empty()) return 0;
    const TorusPatch::Slice& last = out_.slices.back();
    int best = 0;
    double least = kInfinity;
    for (int shift = 0; shift < arcs.count; ++shift) {
      double sum = 0.0;
      for (int k = 0; k < arcs.count; ++k) {
        for (int j = last.first; j < last.last; ++j) {
          if (out_.arcs[j].chain != chain_ + (k + shift) % arcs.count) continue;
          const double way =
              0.5 * (arcs.low[k] + arcs.high[k] - out_.arcs[j].low - out_.arcs[j].high);
          sum += std::abs(std::remainder(way, 2.0 * kPi));
        }
      }
      if (sum < least) {
        least = sum;
        best = shift;
      }
    }
    return best;
  }

  // The place of deepest touch nearest to an angle.
  void set_origin(double angle) {
    double least = kInfinity, at = angle;
    for (double near : out_.nearest) {
      const double way = std::abs(std::remainder(near - angle, 2.0 * kPi));
      if (way < least) {
        least = way;
        at = near;
      }
    }
    origin_ = touch_of(ring_, X_, other_, at).middle;
  }

  // Joins the chains of two slices whose arcs have angles in common.
  void join(int one, int other) {
    const TorusPatch::Slice &a = out_.slices[one], &b = out_.slices[other];
    for (int i = a.first; i < a.last; ++i) {
      for (int k = b.first; k < b.last; ++k) {
        const TorusPatch::Arc &p = out_.arcs[i], &q = out_.arcs[k];
        const double way = std::remainder(0.5 * (p.low + p.high - q.low - q.high), 2.0 * kPi);
        const double sum = 0.5 * (p.high - p.low + q.high - q.low);
        if (std::abs(way) < sum) out_.joints.push_back({p.chain, q.chain});
      }
    }
  }

  const TorusSize& ring_;
  const Pose& X_;
  const TorusSize& other_;
  PatchEffort effort_;
  TorusPatchScratch& s_;
  TorusPatch& out_;
  std::size_t slices_ = 0, arcs_ = 0, joints_ = 0;
  int chains_ = 0, chain_ = 0, last_slice_ = -1;
  double lever_ = 0.0;  // size of a range, from its middle
  double error_ = 0.0, range_from_ = 0.0, range_to_ = 0.0;
  double one_event_ = 0.0;
  int spent_ = 0;
  bool first_range_filled_ = false, whole_ = false;
  Vec3 origin_ = Vec3::Zero();  // a place within the overlap near by
};

}  // namespace

void find_patch(const TorusSize& ring, const Pose& X, const TorusSize& other, PatchEffort effort,
                TorusPatchScratch& scratch) {
  PatchSearch(ring, X, other, effort, scratch).run();
}

}  // namespace volcontact
