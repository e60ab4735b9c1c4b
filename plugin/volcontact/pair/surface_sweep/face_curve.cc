// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/surface_sweep/face_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "volcontact/pair/surface_sweep/curve_forms.h"

namespace volcontact {

using namespace curve_forms;

namespace {

using Toggle = FaceCurveScratch::Toggle;

constexpr double kSliver = 1e-10;  // of the box, or of a circle: stretches as good as none
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

class SpanFinder {
 public:
  SpanFinder(const SweepSolids& solids, const FaceCurve& curve, int face, FaceCurveScratch& s,
             SweepSpans& spans)
      : solids_(solids),
        curve_(curve),
        face_(face),
        sliver_(kSliver * (curve.circle ? 2.0 * kPi : solids.half.norm() / curve.u.norm())),
        s_(s),
        out_(spans) {}

  void run() {
    out_.count = 0;
    out_.overflow = false;
    s_.toggles.clear();
    inner_ = outer_ = 0;
    const auto parts = static_cast<int>(solids_.parts.size());
    for (int p = 0; p < parts; ++p) {
      const SweepPart& part = solids_.parts[p];
      part_ = p;
      on_ = 0;
      for (int f = part.first; f < part.last; ++f) {
        if (solids_.faces[f].twin == face_) on_ = solids_.faces[f].side;
      }
      on_faces_[p] = on_;
      const bool inside = curve_.circle ? add_circle_part(part) : add_line_part(part);
      if (inside) flip(p, true);
    }
    std::sort(s_.toggles.begin(), s_.toggles.end(), [](const Toggle& a, const Toggle& b) {
      if (a.t != b.t) return a.t < b.t;
      return a.part != b.part ? a.part < b.part : !a.leaves && b.leaves;
    });
    sweep();
  }

 private:
  bool skipped(int f) const { return face_ >= 0 && solids_.faces[f].twin == face_; }

  // Toggles of a part whose members are all convex. Whether the line comes from within it.
  bool add_line_part(const SweepPart& part) {
    Toggle enter{-kInfinity, part_, -1, false}, leave{kInfinity, part_, -1, true};
    for (int f = part.first; f < part.last; ++f) {
      if (skipped(f)) continue;
      if (solids_.faces[f].kind == Kind::kTorus) return add_ring(f);
      double low, high;
      if (!line_interval(solids_.faces[f], curve_, low, high)) return false;
      // Of two faces in one place the first.
      if (low > enter.t + sliver_) enter.face = f;
      if (high < leave.t - sliver_) leave.face = f;
      enter.t = std::max(enter.t, low);
      leave.t = std::min(leave.t, high);
    }
    if (!(enter.t < leave.t)) return false;
    if (enter.face >= 0) s_.toggles.push_back(enter);
    if (leave.face >= 0) s_.toggles.push_back(leave);
    return enter.face < 0;
  }

  // A torus, within the ball around it.
  bool add_ring(int f) {
    const SweepFace& face = solids_.faces[f];
    const double length = curve_.u.norm(), reach = face.major + face.minor;
    const double middle = curve_.u.dot(face.round.center - curve_.p) / (length * length);
    const double across = (curve_.at(middle) - face.round.center).norm();
    if (!(across < reach)) return false;
    const double way = 1.01 * std::sqrt((reach - across) * (reach + across)) / length;
    CrossingList list;
    find_crossings(AlongLine{face, curve_}, middle - way, middle + way, kTorusPlaces, false, list);
    for (int i = 0; i < list.count; ++i) {
      s_.toggles.push_back({list.t[i], part_, f, (i % 2 == 0) == list.begins_inside});
    }
    return list.begins_inside;
  }

  // A circle may leave a part several times. Whether it is within the part at t = 0.
  bool add_circle_part(const SweepPart& part) {
    s_.crossings.clear();
    int outside = 0;  // faces that the circle is outside of, at 0
    for (int f = part.first; f < part.last; ++f) {
      if (skipped(f)) continue;
      const int found = add_circle_face(f);
      if (found < 0) return false;
      outside += found;
    }
    std::sort(s_.crossings.begin(), s_.crossings.end(),
              [](const Toggle& a, const Toggle& b) { return a.t < b.t; });
    const bool begins = outside == 0;
    for (const Toggle& c : s_.crossings) {
      const bool was = outside == 0;
      outside += c.leaves ? 1 : -1;
      if (was != (outside == 0)) s_.toggles.push_back(c);
    }
    return begins;
  }

  // 1 where the circle begins outside of the face, 0 inside; -1 when it never is inside.
  int add_circle_face(int f) {
    const SweepFace& face = solids_.faces[f];
    Cosine cosine;
    if (cosine.read(face, curve_)) return add_cosine(f, cosine);
    CrossingList list;
    find_crossings(AlongCircle(face, curve_), 0.0, 2.0 * kPi,
                   face.kind == Kind::kTorus ? kTorusPlaces : kCirclePlaces, true, list);
    if (list.count == 0 && !list.begins_inside) return -1;
    for (int i = 0; i < list.count; ++i) {
      s_.crossings.push_back({list.t[i], part_, f, (i % 2 == 0) == list.begins_inside});
    }
    return list.begins_inside ? 0 : 1;
  }

  int add_cosine(int f, const Cosine& cosine) {
    if (!cosine.crosses()) return cosine.c < 0.0 ? 0 : -1;
    const double middle = cosine.middle(), width = cosine.width();
    double low = middle - width, high = middle + width;
    const auto turned = [](double t) {
      t = t < 0.0 ? t + 2.0 * kPi : t;
      return t >= 2.0 * kPi ? t - 2.0 * kPi : t;
    };
    low = turned(low);
    high = turned(high);
    s_.crossings.push_back({low, part_, f, false});
    s_.crossings.push_back({high, part_, f, true});
    return low > high ? 0 : 1;
  }

  void flip(int part, bool in) {
    const std::uint64_t bit = std::uint64_t{1} << part;
    const int on = on_faces_[part];
    if (on >= 0) inner_ = in ? inner_ | bit : inner_ & ~bit;
    if (on <= 0) outer_ = in ? outer_ | bit : outer_ & ~bit;
  }

  // 0 where the curve is no surface (or not inside); else 1 and 2 for A's, 3 and 4 for B's.
  int state() const {
    const bool a_in = solids_.holds(Owner::kA, inner_), b_in = solids_.holds(Owner::kB, inner_);
    if (face_ < 0) return a_in && b_in ? 1 : 0;
    const bool a_out = solids_.holds(Owner::kA, outer_), b_out = solids_.holds(Owner::kB, outer_);
    const bool in = a_in && b_in, out = a_out && b_out;
    if (in == out) return 0;
    return (b_in != b_out ? 3 : 1) + (in ? 0 : 1);
  }

  void sweep() {
    int now = state();
    SweepSpans::Span open{};
    if (now != 0) open = begin({curve_.circle ? 0.0 : -kInfinity, -1, false, -1, 0}, now);
    const std::size_t n = s_.toggles.size();
    for (std::size_t i = 0; i < n;) {
      // All that happens here as one: rounding does not decide which face it is.
      SweepEnd end{s_.toggles[i].t, s_.toggles[i].face, s_.toggles[i].leaves, -1, 0};
      for (const double from = end.t; i < n && s_.toggles[i].t <= from + sliver_; ++i) {
        const Toggle& toggle = s_.toggles[i];
        flip(toggle.part, !toggle.leaves);
        if (toggle.face < end.face) {
          end = {toggle.t, toggle.face, toggle.leaves, end.face, 0};
        } else if (toggle.face != end.face) {
          end.also = toggle.face;
        }
      }
      end.smooth = solids_.faces[end.face].smooth;
      const int next = state();
      if (next == now) continue;
      if (now != 0) close(open, end);
      if (next != 0) open = begin(end, next);
      now = next;
    }
    if (now != 0) close(open, {curve_.circle ? 2.0 * kPi : kInfinity, -1, true, -1, 0});
    drop_far();
  }

  static SweepSpans::Span begin(const SweepEnd& low, int state) {
    SweepSpans::Span span{};
    span.low = low;
    span.owner = state < 3 ? Owner::kA : Owner::kB;
    span.side = state % 2 == 1 ? 1 : -1;
    return span;
  }

  void close(SweepSpans::Span& span, const SweepEnd& high) {
    span.high = high;
    if (out_.count == SweepSpans::kMost) {
      out_.overflow = true;
      return;
    }
    out_.span[out_.count++] = span;
  }

  // What lies out of the box comes from faces that were dropped.
  void drop_far() {
    int kept = 0;
    for (int i = 0; i < out_.count; ++i) {
      const SweepSpans::Span& span = out_.span[i];
      const double middle = 0.5 * (span.low.t + span.high.t);
      if (!std::isfinite(middle)) continue;
      if (curve_.at(middle).cwiseAbs().exceeds(solids_.half)) continue;
      out_.span[kept++] = span;
    }
    out_.count = kept;
  }

  const SweepSolids& solids_;
  const FaceCurve& curve_;
  const int face_;
  const double sliver_;
  FaceCurveScratch& s_;
  SweepSpans& out_;
  int part_ = 0, on_ = 0;
  int on_faces_[SweepSolids::kMostParts] = {};
  std::uint64_t inner_ = 0, outer_ = 0;
};

}  // namespace

void find_spans(const SweepSolids& solids, const FaceCurve& curve, int face,
                FaceCurveScratch& scratch, SweepSpans& spans) {
  SpanFinder(solids, curve, face, scratch, spans).run();
}

double end_on(const SweepFace& face, const FaceCurve& curve, bool leaves) {
  if (curve.circle) {
    Cosine f;
    if (!f.read(face, curve) || !f.crosses()) return kNone;
    return leaves ? f.middle() + f.width() : f.middle() - f.width();
  }
  if (face.kind == Kind::kTorus) return kNone;
  double low, high;
  if (!line_interval(face, curve, low, high)) return kNone;
  const double end = leaves ? high : low;
  return std::isfinite(end) ? end : kNone;
}

double reach_of(const SweepFace& face, const FaceCurve& curve) {
  if (curve.circle) {
    Cosine f;
    return f.read(face, curve) ? f.reach() : kNone;
  }
  if (face.kind == Kind::kTorus) return kNone;
  if (face.kind == Kind::kPlane) {  // a line that is parallel to it
    const double slope = face.normal.dot(curve.u);
    if (std::abs(slope) > kParallel * curve.u.norm()) return kNone;
    return face.offset - face.normal.dot(curve.p);
  }
  const Parabola f(face.round, curve);
  return f.flat() ? -f.c : f.reach();
}

}  // namespace volcontact
