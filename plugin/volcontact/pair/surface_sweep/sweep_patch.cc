// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/surface_sweep/sweep_patch.h"

#include <algorithm>
#include <cmath>

#include "volcontact/base/interrupt.h"
#include "volcontact/pair/quadrature/outer_rule.h"

namespace volcontact {
namespace {

constexpr int kPlaces = 16;         // curves looked at first
constexpr double kOffset = 0.4137;  // of a step: no symmetric pose has one on its axes
constexpr int kMostCurves = 2000;   // of a face
constexpr int kMostDepth = 6;       // of divisions of a stretch
constexpr int kMostSweeps = 12;     // of sweeps that find another change
constexpr int kStrictRounds = 3;
constexpr double kSharp = 1e-10;            // of an event, per range
constexpr double kBeside = 1e-9;            // how far from an event to look, per range
constexpr int kMostSteps = 60;              // in search of one
constexpr double kStraightArc = 0.5 * kPi;  // the longest for one Gauss rule [rad]
constexpr double kRounding = 1e-15;         // of fluxes, per size

class FaceSweep {
 public:
  FaceSweep(const SweepSolids& solids, int face, const CurveFamily& family, double target,
            SweepPatchScratch& s, SweepPatch& patch)
      : solids_(solids),
        face_(face),
        family_(family),
        target_(target),
        range_(family.high() - family.low()),
        s_(s),
        patch_(patch),
        surface_(patch.surface) {}

  bool run() {
    if (patch_.swept && sweep_again()) return true;
    patch_.swept = sweep();
    if (patch_.swept) patch_.events = s_.events;
    return patch_.swept;
  }

 private:
  using Sample = SweepPatchScratch::Sample;

  // Between events that are known from a sweep for another target.
  bool sweep_again() {
    s_.samples.clear();
    s_.events = patch_.events;
    patch_.stretches.clear();
    surface_.clear();
    if (integrate()) return true;
    again_ = failed_ = false;
    curves_ = 0;
    return false;
  }

  bool sweep() {
    s_.samples.clear();
    for (int i = 0; i < kPlaces; ++i) {
      look(family_.low() + range_ * (i + kOffset) / kPlaces);
    }
    if (family_.turn() || solids_.faces[face_].kind == SweepFace::Kind::kBall) {
      look(family_.low());
      look(family_.high());
    } else {
      s_.samples.push_back({family_.low(), {}});
      s_.samples.push_back({family_.high(), {}});
    }
    for (const double u : patch_.hints) look(u);
    for (round_ = 0; round_ < kMostSweeps; ++round_) {
      patch_.stretches.clear();
      surface_.clear();
      again_ = false;
      if (!find_events()) return false;
      if (integrate()) return true;
      if (failed_) return false;
    }
    return false;
  }

  SweepSpans spans_at(double u) {
    SweepSpans spans;
    ++curves_;
    find_spans(solids_, family_.curve(u), face_, s_.curve, spans);
    if (spans.overflow || curves_ > kMostCurves) failed_ = true;
    return spans;
  }
  void look(double u) { s_.samples.push_back({u, spans_at(u)}); }

  bool find_events() {
    std::sort(s_.samples.begin(), s_.samples.end(),
              [](const Sample& a, const Sample& b) { return a.u < b.u; });
    s_.events.clear();
    for (std::size_t i = 0; i + 1 < s_.samples.size() && !failed_; ++i) {
      refine(s_.samples[i], s_.samples[i + 1]);
    }
    std::sort(s_.events.begin(), s_.events.end());
    return !failed_;
  }

  void refine(const Sample& a, const Sample& b) {
    if (failed_ || a.spans.same_as(b.spans)) return;
    if (b.u - a.u < kSharp * range_) {
      s_.events.push_back(0.5 * (a.u + b.u));
      return;
    }
    double u;
    if (find_meeting(a, b, u)) {
      const double beside = kBeside * range_;
      const double low = std::max(a.u, u - beside), high = std::min(b.u, u + beside);
      const Sample before{low, spans_at(low)}, after{high, spans_at(high)};
      if (!before.spans.same_as(after.spans)) {
        refine(a, before);
        s_.events.push_back(u);
        refine(after, b);
        return;
      }
    }
    const double middle = 0.5 * (a.u + b.u);
    const Sample between{middle, spans_at(middle)};
    refine(a, between);
    refine(between, b);
  }

  // Where two neighbouring ends meet, if that is what tells the two curves apart.
  bool find_meeting(const Sample& a, const Sample& b, double& u) const {
    SweepEnd ends_a[2 * SweepSpans::kMost], ends_b[2 * SweepSpans::kMost];
    const int count_a = list(a.spans, ends_a), count_b = list(b.spans, ends_b);
    int i = 0;
    while (i < count_a && i < count_b && ends_a[i].same_as(ends_b[i])) ++i;
    int k = 0;
    while (k < count_a - i && k < count_b - i &&
           ends_a[count_a - 1 - k].same_as(ends_b[count_b - 1 - k])) {
      ++k;
    }
    const int more_a = count_a - i - k, more_b = count_b - i - k;
    if (more_a >= 1 && more_b >= 1) {
      if (meeting(ends_a[i], ends_b[i], a.u, b.u, u)) return true;
      if (meeting(ends_a[i + more_a - 1], ends_b[i + more_b - 1], a.u, b.u, u)) return true;
    }
    if (more_a >= 2 && meeting(ends_a[i], ends_a[i + 1], a.u, b.u, u)) return true;
    if (more_b >= 2 && meeting(ends_b[i], ends_b[i + 1], a.u, b.u, u)) return true;
    return false;
  }

  static int list(const SweepSpans& spans, SweepEnd* ends) {
    int count = 0;
    for (int i = 0; i < spans.count; ++i) {
      ends[count++] = spans.span[i].low;
      ends[count++] = spans.span[i].high;
    }
    return count;
  }

  // A zero of the way from one end to another, or of the reach of the one face of both.
  bool meeting(const SweepEnd& one, const SweepEnd& other, double a, double b, double& u) const {
    const auto end_of = [&](const SweepEnd& end, const FaceCurve& curve) {
      return end.face < 0 ? 0.0 : end_on(solids_.faces[end.face], curve, end.leaves);
    };
    if (one.face == other.face) {
      const auto reach = [&](double at) {
        return one.face < 0 ? 0.0 : reach_of(solids_.faces[one.face], family_.curve(at));
      };
      return zero_between(reach, a, b, kInfinity, u);
    }
    const bool circle = family_.curve(a).circle;
    const auto way = [&](double at) {
      const FaceCurve curve = family_.curve(at);
      const double apart = end_of(other, curve) - end_of(one, curve);
      return circle ? std::remainder(apart, 2.0 * kPi) : apart;
    };
    if (zero_between(way, a, b, circle ? kPi : kInfinity, u)) return true;
    // Faces that are tangent where they meet do so in a seam.
    for (const SweepEnd& end : {one, other}) {
      if (end.face < 0) continue;
      const SweepPart& part = part_of(end.face);
      for (int f = part.first; f < part.last; ++f) {
        if (!solids_.faces[f].seam || f == face_) continue;
        const auto height = [&](double at) {
          const FaceCurve curve = family_.curve(at);
          return solids_.faces[f].value(curve.at(end_of(end, curve)));
        };
        if (zero_between(height, a, b, kInfinity, u)) return true;
      }
    }
    return false;
  }

  const SweepPart& part_of(int face) const {
    return *std::find_if(solids_.parts.begin(), solids_.parts.end(), [face](const SweepPart& part) {
      return face >= part.first && face < part.last;
    });
  }

  // The zero of a function with values of two signs at a and b, no farther apart than `jump`.
  template <typename Value>
  bool zero_between(const Value& value, double a, double b, double jump, double& u) const {
    double at_a = value(a), at_b = value(b);
    if (!std::isfinite(at_a) || !std::isfinite(at_b) || (at_a > 0.0) == (at_b > 0.0)) return false;
    if (std::abs(at_a - at_b) > jump) return false;
    int kept = 0;
    for (int i = 0; i < kMostSteps && std::abs(b - a) > kSharp * range_; ++i) {
      u = i % 8 == 7 ? 0.5 * (a + b) : a + (b - a) * at_a / (at_a - at_b);
      const double now = value(u);
      if (!std::isfinite(now)) return false;
      if (now == 0.0) return true;
      if ((now > 0.0) == (at_b > 0.0)) {
        b = u;
        at_b = now;
        if (kept == 1) at_a *= 0.5;
        kept = 1;
      } else {
        a = u;
        at_a = now;
        if (kept == 2) at_b *= 0.5;
        kept = 2;
      }
    }
    u = 0.5 * (a + b);
    return true;
  }

  bool integrate() {
    double low = family_.low();
    for (std::size_t i = 0; i <= s_.events.size(); ++i) {
      const double high = i < s_.events.size() ? s_.events[i] : family_.high();
      if (high - low > 10.0 * kBeside * range_) add_stretch(low, high);
      if (again_ || failed_) return false;
      low = high;
    }
    return true;
  }

  void add_stretch(double low, double high) {
    const double middle = 0.5 * (low + high);
    const SweepSpans spans = spans_at(middle);
    if (failed_) return;
    const auto first = static_cast<int>(surface_.strips.size());
    const FaceCurve curve = family_.curve(middle);
    for (int i = 0; i < spans.count; ++i) {
      SweepStrip& strip = surface_.strips.emplace_back();
      strip.owner = spans.span[i].owner;
      strip.low = spans.span[i].low;
      strip.high = spans.span[i].high;
      strip.at_low = curve.at(strip.low.t);
      strip.at_high = curve.at(strip.high.t);
    }
    patch_.stretches.push_back({low, high, first, spans.count});
    const double beside = 4.0 * kBeside * range_;
    for (const double u : {low + beside, high - beside}) {
      const SweepSpans at_end = spans_at(u);
      if (!alike(at_end, spans)) return look_again({u, at_end}, {middle, spans});
      const FaceCurve tip = family_.curve(u);
      for (int i = 0; i < spans.count; ++i) {
        surface_.tips.push_back({tip.at(at_end.span[i].low.t), first + i});
        surface_.tips.push_back({tip.at(at_end.span[i].high.t), first + i});
      }
    }
    if (spans.count > 0) integrate_stretch(spans, low, high, 0.0, kPi, 0);
  }

  // There is a change that nothing has told of.
  void look_again(const Sample& one, const Sample& other) {
    s_.samples.push_back(one);
    s_.samples.push_back(other);
    again_ = true;
  }

  // u = middle - half cos w, w from w0 to w1.
  void integrate_stretch(const SweepSpans& pattern, double low, double high, double w0, double w1,
                         int depth) {
    const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
    const std::size_t places = surface_.places.size(), tips = surface_.tips.size();
    InterruptScope::poll();
    SweepFlux sums[SweepSpans::kMost];
    double terms[SweepSpans::kMost][LegendreTable::kCount];
    for (int k = 0; k < LegendreTable::kCount; ++k) {
      const double w = w0 + (w1 - w0) * OuterRule::kNodes[k];
      const double u = middle - half * std::cos(w);
      const SweepSpans spans = spans_at(u);
      if (failed_) return;
      if (!alike(spans, pattern)) return look_again({u, spans}, {middle, pattern});
      const double weight = (w1 - w0) * OuterRule::kWeights[k] * half * std::sin(w);
      for (int i = 0; i < spans.count; ++i) {
        SweepFlux on_curve;
        add_span(spans.span[i], u, weight, last_stretch().first + i, on_curve);
        terms[i][k] = on_curve.moment.trace() / 3.0;
        sums[i] += on_curve;
      }
    }
    double worst = 0.0;
    for (int i = 0; i < pattern.count; ++i) {
      double size = 0.0;
      for (const double term : terms[i]) size += std::abs(term);
      const double unit = size + kRounding * solids_.half.norm() * sums[i].area / target_;
      worst = std::max(worst, legendre_error(terms[i]) / unit);
    }
    if (worst > target_ && depth < kMostDepth) {
      surface_.places.resize(places);
      surface_.tips.resize(tips);
      const double between = 0.5 * (w0 + w1);
      integrate_stretch(pattern, low, high, w0, between, depth + 1);
      if (!again_ && !failed_) integrate_stretch(pattern, low, high, between, w1, depth + 1);
      return;
    }
    for (int i = 0; i < pattern.count; ++i) {
      SweepStrip& strip = surface_.strips[last_stretch().first + i];
      strip.flux += sums[i];
      strip.error += legendre_error(terms[i]);
    }
  }

  // Where faces touch, rounding decides which of them a curve ends at; then the number of stretches
  // must do.
  bool alike(const SweepSpans& spans, const SweepSpans& pattern) const {
    if (round_ < kStrictRounds) return spans.same_as(pattern);
    if (spans.count != pattern.count) return false;
    for (int i = 0; i < spans.count; ++i) {
      if (spans.span[i].owner != pattern.span[i].owner) return false;
      if (spans.span[i].side != pattern.span[i].side) return false;
    }
    return true;
  }

  const SweepStretch& last_stretch() const { return patch_.stretches.back(); }

  void add_span(const SweepSpans::Span& span, double u, double weight, int strip, SweepFlux& sum) {
    const FaceCurve curve = family_.curve(u);
    const double low = span.low.t, length = span.high.t - low;
    const auto add = [&](double t, double share) {
      const Vec3 x = curve.at(t);
      const Vec3 n = span.side * weight * share * length * family_.element(u, t, x);
      surface_.places.push_back({x, n, strip});
      sum.add(x, n);
    };
    surface_.tips.push_back({curve.at(low), strip});
    surface_.tips.push_back({curve.at(span.high.t), strip});
    const bool all_round = curve.circle && span.low.face < 0 && span.high.face < 0;
    if (all_round) {  // even steps are exact
      constexpr int kSteps = 12;
      for (int i = 0; i < kSteps; ++i) add(2.0 * kPi * i / kSteps, 1.0 / kSteps);
      return;
    }
    // Three nodes would do for the fluxes of a line, but not for columns: their length has kinks.
    const int parts =
        curve.circle ? std::max(1, static_cast<int>(std::ceil(length / kStraightArc))) : 1;
    for (int i = 0; i < parts; ++i) {
      for (int k = 0; k < LegendreTable::kCount; ++k) {
        add(low + length * (i + OuterRule::kNodes[k]) / parts, OuterRule::kWeights[k] / parts);
      }
    }
  }

  const SweepSolids& solids_;
  const int face_;
  const CurveFamily& family_;
  const double target_, range_;
  SweepPatchScratch& s_;
  SweepPatch& patch_;
  SweepSurface& surface_;
  int curves_ = 0, round_ = 0;
  bool again_ = false, failed_ = false;
};

}  // namespace

void SweepSurface::clear() {
  strips.clear();
  places.clear();
  tips.clear();
}

void SweepSurface::append(const SweepSurface& part) {
  const auto base = static_cast<int>(strips.size());
  strips.insert(strips.end(), part.strips.begin(), part.strips.end());
  for (const SweepPlace& place : part.places) {
    places.push_back({place.x, place.n, base + place.strip});
  }
  for (const SweepTip& tip : part.tips) tips.push_back({tip.x, base + tip.strip});
}

bool sweep_face(const SweepSolids& solids, int face, const CurveFamily& family, double target,
                SweepPatchScratch& scratch, SweepPatch& patch) {
  return FaceSweep(solids, face, family, target, scratch, patch).run();
}

}  // namespace volcontact
