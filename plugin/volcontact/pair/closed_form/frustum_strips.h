// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "volcontact/pair/closed_form/gauss_rule.h"
#include "volcontact/pair/closed_form/tilted_sum.h"

namespace volcontact {

/// The part of a cone frustum (or cylinder) below a plane, in strips that run from end to end at
/// constant angle theta: p = -r cos(theta), with r the radius at the place q along the axis, and
/// therefore straight. Each strip is cut at one place; all integrals along it are polynomials,
/// those over theta smooth between the strips through the corners of the profile, and nothing
/// cancels. docs/theory.md, "Cylinder and frustum".
///
///   V = int dtheta int 2 r^2 sin(theta)^2 dq,   over the q of the strip below the plane
class FrustumStrips {
 public:
  struct Solid {
    double start_radius, end_radius, length;
    double start_height, end_height;  ///< of the middles of the ends above the plane [m]
    bool has_ends;                    ///< whether the end discs belong to the surface
  };

  /// The start of the solid should be the end with the lowest corner. The sum is about that corner.
  FrustumStrips(const Solid& solid, const Tilt& tilt)
      : solid_(solid),
        tilt_(tilt),
        growth_((solid.end_radius - solid.start_radius) / solid.length),
        slant_(std::sqrt(1.0 + growth_ * growth_)),
        start_(solid.start_height, tilt.sine * solid.start_radius),
        end_(solid.end_height, tilt.sine * solid.end_radius) {
    sum_.depth = -start_.low;
    integrate();
  }
  const TiltedSum& sum() const { return sum_; }

 private:
  // Heights of the lowest and of the highest point of an end disc, and where the plane cuts it:
  // `below` = 1 - cos(theta), `above` = 1 + cos(theta), clamped to [0, 2].
  struct End {
    double low, high, below, above;
    End(double middle, double reach) : low(middle - reach), high(middle + reach) {
      if (!(low < 0.0)) {
        below = 0.0, above = 2.0;
      } else if (!(high > 0.0)) {
        below = 2.0, above = 0.0;
      } else {
        below = 2.0 * (-low / (high - low));
        above = 2.0 * (high / (high - low));
      }
    }
  };
  // A strip, and the place q where the plane cuts it.
  struct Mark {
    double below, above, q;
    double sine() const { return std::sqrt(below * above); }
  };

  double radius(double q) const {
    const double t = q / solid_.length;
    return (1.0 - t) * solid_.start_radius + t * solid_.end_radius;
  }

  void integrate() {
    const bool start_is_wet_longer = start_.below >= end_.below;
    const End& first = start_is_wet_longer ? end_ : start_;  // the end that leaves the plane first
    const End& last = start_is_wet_longer ? start_ : end_;
    add_whole_strips(first.below, first.above);
    if (first.above == 0.0 || last.below == 0.0) return;  // all below, or all above
    const double length = solid_.length;
    Mark from{first.below, first.above, start_is_wet_longer ? length : 0.0};
    Mark to{last.below, last.above, start_is_wet_longer ? 0.0 : length};
    if (from.below == 0.0) from.q = crossing(start_.low, end_.low);
    if (to.above == 0.0) to.q = crossing(start_.high, end_.high);
    add_cut_strips(from, to, start_is_wet_longer);
  }

  // Where a line between these heights at both ends meets the plane.
  double crossing(double at_start, double at_end) const {
    const double rise = at_end - at_start;
    return rise != 0.0 ? std::clamp(-at_start / rise, 0.0, 1.0) * solid_.length : 0.0;
  }

  // Strips that lie below the plane from end to end.
  void add_whole_strips(double below, double above) {
    if (!(below > 0.0)) return;
    const double half = std::atan2(std::sqrt(below), std::sqrt(above));
    const double sin_half = std::sin(half), cos_half = std::cos(half);
    for (const GaussNode& node : gauss_rule_for(2.0 * half)) {
      const double sine = std::sin(half * node.x), cosine = std::cos(half * node.x);
      for (const double side : {-sine, sine}) {
        const Strip strip(sin_half * cosine + cos_half * side, cos_half * cosine - sin_half * side);
        add_strip(strip, half * node.weight, 0.0, solid_.length, depth_at_start(strip),
                  depth_at_end(strip));
        if (solid_.has_ends) add_ends(strip, half * node.weight, true, true);
      }
    }
  }

  // Strips between two marks, below the plane at the start (or else at the end). Along the cut the
  // radius is the inverse of a linear function of cos(theta): where it falls by more than kSteep,
  // the piece is divided, down to a tip too small to matter.
  void add_cut_strips(const Mark& from, const Mark& to, bool wet_start) {
    constexpr double kSteep = 2.0;
    constexpr int kMostPieces = 11;
    const bool narrows = radius(from.q) >= radius(to.q);
    Mark wide = narrows ? from : to;
    const Mark& narrow = narrows ? to : from;
    const double r_narrow = radius(narrow.q);
    for (int piece = 1; piece < kMostPieces; ++piece) {
      const double r_wide = radius(wide.q), r = r_wide / kSteep;
      if (!(r > r_narrow)) break;
      const double turn = r_narrow * (r_wide - r) / (r * (r_wide - r_narrow));
      const double along = (r_wide - r) / (r_wide - r_narrow);
      const Mark middle{wide.below + turn * (narrow.below - wide.below),
                        wide.above + turn * (narrow.above - wide.above),
                        wide.q + along * (narrow.q - wide.q)};
      narrows ? add_cut_piece(wide, middle, wet_start) : add_cut_piece(middle, wide, wet_start);
      wide = middle;
    }
    narrows ? add_cut_piece(wide, narrow, wet_start) : add_cut_piece(narrow, wide, wet_start);
  }

  void add_cut_piece(const Mark& from, const Mark& to, bool wet_start) {
    const double sines = from.sine() + to.sine();
    if (!(sines > 0.0) && !(to.below > from.below)) return;
    const double gap = std::max(0.0, to.below - from.below);  // of -cos(theta)
    // tan(half the range of theta) = gap / sines holds without cancellation.
    const double half = std::atan2(gap, sines);
    const double range_per_gap = gap > 1e-8 * sines ? 2.0 * half / gap : 2.0 / sines;
    const double middle = 2.0 * std::atan2(std::sqrt(from.below), std::sqrt(from.above)) + half;
    const double sin_mid = std::sin(middle), cos_mid = std::cos(middle);
    const double sin_half = std::sin(half), cot_mid = cos_mid / sin_mid;
    const double cos_half = std::cos(half);
    const double r_from = radius(from.q), r_to = radius(to.q);
    const double p_from = across(from.below, from.q), p_to = across(to.below, to.q);
    const double cut_length = std::hypot(p_to - p_from, to.q - from.q);
    // A pole lies beyond the wide end, the nearer the more the radius falls.
    const bool is_steep = std::max(r_from, r_to) > 1.1 * std::min(r_from, r_to);
    const double range = std::max(2.0 * half, is_steep ? 1.0 : 0.0);
    for (const GaussNode& node : gauss_rule_for(range)) {
      const double sine = std::sin(half * node.x), cosine = std::cos(half * node.x);
      const double share = sin_half > 0.0 ? sine / sin_half : node.x;
      for (const double sign : {-1.0, 1.0}) {
        const double side = sign * sine, t = sign * share;
        const Strip strip(sin_mid * cosine + cos_mid * side, cos_mid * cosine - sin_mid * side);
        // Shares of the way from one mark to the other: in cos(theta), then along the cut.
        const double even = cot_mid / (cos_half + cosine);
        const double done = 0.5 * (1.0 + t) * (1.0 - even * (sin_half - side));
        const double left = 0.5 * (1.0 - t) * (1.0 + even * (sin_half + side));
        const double scale = left * r_to + done * r_from;
        const double along = scale > 0.0 ? done * r_from / scale : done;
        const double q = from.q + along * (to.q - from.q), r = radius(q);
        const double weight = half * node.weight;
        if (wet_start) {
          add_strip(strip, weight, 0.0, q, depth_at_start(strip), 0.0);
        } else {
          add_strip(strip, weight, q, solid_.length, 0.0, depth_at_end(strip));
        }
        if (solid_.has_ends) add_ends(strip, weight, wet_start, !wet_start);
        const double stretch = scale > 0.0 ? r_from * r_to / (scale * scale) : 0.0;
        const double area =
            node.weight * range_per_gap * strip.sine * strip.sine * r * cut_length * stretch;
        const double p = p_from + along * (p_to - p_from);
        sum_.cut_area += area;
        sum_.cut_p += area * p;
        sum_.cut_q += area * q;
      }
    }
  }

  struct Strip {
    double sine, below;  // below = 1 - cos(theta)
    Strip(double s, double c) : sine(s), below(c > 0.0 ? s * s / (1.0 + c) : 1.0 - c) {}
  };
  // p from the lowest corner of the start.
  double across(double below, double q) const { return below * radius(q) - growth_ * q; }
  double depth_at_start(const Strip& strip) const {
    return std::max(0.0, -start_.low - tilt_.sine * solid_.start_radius * strip.below);
  }
  double depth_at_end(const Strip& strip) const {
    return std::max(0.0, -end_.low - tilt_.sine * solid_.end_radius * strip.below);
  }

  // The strips at theta on both sides, from q = `from` to `to`. Gauss rule of degree 5.
  void add_strip(const Strip& strip, double weight, double from, double to, double depth_from,
                 double depth_to) {
    constexpr double kNode = 0.774596669241483377;
    const double half = 0.5 * (to - from), middle = 0.5 * (to + from);
    const double half_depth = 0.5 * (depth_to - depth_from);
    const double mean_depth = 0.5 * (depth_to + depth_from);
    const double square = strip.sine * strip.sine;
    const double factor = 2.0 * weight * half * square;
    sum_.side_area += 4.0 * weight * half * slant_ * radius(middle);
    if (growth_ == 0.0) {
      const double r = solid_.start_radius, v = 2.0 * factor * r * r, p = strip.below * r;
      sum_.volume += v;
      sum_.p += v * p;
      sum_.q += v * middle;
      sum_.pp += v * p * p;
      sum_.pq += v * p * middle;
      sum_.qq += v * (middle * middle + half * half * (1.0 / 3.0));
      sum_.rr += v * r * r * square * (1.0 / 3.0);
      sum_.depth_moment += v * mean_depth;
      return;
    }
    for (int i = -1; i <= 1; ++i) {
      const double t = i * kNode, q = middle + half * t, r = radius(q);
      const double v = factor * (i == 0 ? 8.0 / 9.0 : 5.0 / 9.0) * r * r;
      const double p = strip.below * r - growth_ * q;
      sum_.volume += v;
      sum_.p += v * p;
      sum_.q += v * q;
      sum_.pp += v * p * p;
      sum_.pq += v * p * q;
      sum_.qq += v * q * q;
      sum_.rr += v * r * r * square * (1.0 / 3.0);
      sum_.depth_moment += v * (mean_depth + half_depth * t);
    }
  }
  void add_ends(const Strip& strip, double weight, bool start, bool end) {
    const double factor = 2.0 * weight * strip.sine * strip.sine;
    if (start) sum_.side_area += factor * solid_.start_radius * solid_.start_radius;
    if (end) sum_.side_area += factor * solid_.end_radius * solid_.end_radius;
  }

  const Solid& solid_;
  const Tilt& tilt_;
  const double growth_;  // of the radius along q
  const double slant_;   // length of the wall along q
  const End start_, end_;
  TiltedSum sum_;
};

}  // namespace volcontact
