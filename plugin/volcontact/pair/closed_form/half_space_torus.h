// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <complex>

#include "volcontact/pair/closed_form/circular_segment.h"
#include "volcontact/pair/closed_form/gauss_rule.h"
#include "volcontact/pair/closed_form/tilted_sum.h"
#include "volcontact/shape/half_space.h"
#include "volcontact/shape/torus.h"

namespace volcontact {

/// The part of a torus below the plane z = 0 of A. A half plane through the axis, at the angle phi
/// from the upward direction p, cuts the tube in a disc and the plane in a chord: a circular
/// segment, to be integrated over phi. docs/theory.md, "Torus".
///
///   V = int dphi int rho dA,   rho from the axis, over the segment
class TorusSections {
 public:
  TorusSections(const Torus& torus, const Tilt& tilt, double height)
      : major_(torus.major_radius()),
        minor_(torus.minor_radius()),
        sine_(tilt.sine),
        cosine_(tilt.cosine),
        height_(height) {
    // A plane through the axis cuts two discs; the range of phi must not vanish there.
    constexpr double kNearly = 1e-9;
    if (std::abs(cosine_) < kNearly && std::abs(height_) < kNearly * major_) {
      cosine_ = std::copysign(kNearly, cosine_);
    }
    find_range();
    add_whole_discs();
    if (first_ < last_) add_segments();
    sum_.depth = major_ * sine_ + minor_ - height_;
  }
  const TiltedSum& sum() const { return sum_; }
  double error() const { return error_; }  ///< of V, beside rounding

 private:
  // The values of cos(phi) where the chord touches the disc: discs are whole below the lower one
  // and dry above the upper one.
  void find_range() {
    const double square = (major_ - minor_) * (major_ + minor_);
    const double a = sine_ * sine_ * square, b = sine_ * major_ * height_;
    const double c = height_ * height_ - minor_ * minor_ * cosine_ * cosine_;
    const double root = minor_ * sine_ * std::sqrt(height_ * height_ + cosine_ * cosine_ * square);
    const double q = -(b + std::copysign(root, b));
    if (q != 0.0) {
      const double one = a > 0.0 ? q / a : std::copysign(kInfinity, q), two = c / q;
      touch_low_ = std::min(one, two);
      touch_high_ = std::max(one, two);
    } else if (sine_ > 0.0 && !(c < 0.0)) {
      touch_low_ = touch_high_ = 0.0;
    }
    first_ = std::clamp(touch_low_, -1.0, 1.0);
    last_ = std::clamp(touch_high_, -1.0, 1.0);
  }

  void add_whole_discs() {
    const double angle = std::acos(-first_);  // pi - phi
    if (!(angle > 0.0)) return;
    const double sine = std::sin(angle), twice = 0.5 * sine * std::cos(angle);
    const double major2 = major_ * major_, minor2 = minor_ * minor_, disc = kPi * minor2;
    const double volume = 2.0 * angle * disc * major_;
    const double p = -2.0 * sine * disc * (major2 + 0.25 * minor2);
    const double third = disc * major_ * (major2 + 0.75 * minor2);
    sum_.volume += volume;
    sum_.p += p;
    sum_.pp += 2.0 * third * (0.5 * angle + twice);
    sum_.rr += 2.0 * third * (0.5 * angle - twice);
    sum_.qq += volume * 0.25 * minor2;
    sum_.depth_moment -= sine_ * p + height_ * volume;
    sum_.side_area += 4.0 * kPi * minor_ * major_ * angle;
  }

  // cos(phi) = middle - half cos(turn) takes the square roots out of both ends. What is left are
  // singularities off the range: roots beyond its ends, and where the chord would be level.
  void add_segments() {
    // Where a plane nearly holds the axis, the chord turns over within a narrow range about
    // cos(phi) = 0, or passes through it. Discs that touch each other on the axis are cut to both
    // sides.
    constexpr double kTurnedOver = 16.0, kNarrow = 0.1;
    const double off = std::max(std::abs(cosine_), std::abs(height_) / major_);
    const double turn = sine_ > 0.0 ? kTurnedOver * off / sine_ : kInfinity;
    if (turn < kNarrow * (last_ - first_)) {
      const double from = std::clamp(-turn, first_, last_), to = std::clamp(turn, first_, last_);
      add_segments(first_, from);
      add_segments(from, to);
      add_segments(to, last_);
    } else {
      add_segments(first_, last_);
    }
  }

  void add_segments(double from, double to) {
    if (!(from < to)) return;
    from_ = from;
    to_ = to;
    middle_ = 0.5 * (to + from);
    half_ = 0.5 * (to - from);
    const double below = from - (from > first_ ? first_ : std::min(-1.0, touch_low_));
    const double above = (to < last_ ? last_ : std::max(1.0, touch_high_)) - to;
    singular_[0] = {0.0, std::acosh(1.0 + below / half_)};
    singular_[1] = {kPi, std::acosh(1.0 + above / half_)};
    if (sine_ > 0.0) {
      singular_[2] = std::acos(std::complex<double>(middle_, cosine_ / sine_) / half_);
    }
    constexpr int kMostSplits = 24;
    add_panels(0.0, 0.5 * kPi, kMostSplits);
    add_panels(0.5 * kPi, kPi, kMostSplits);
  }

  // Gauss panels, each shorter than its distance from the singularities allows.
  void add_panels(double from, double to, int splits) {
    constexpr double kClear = 1.5;  // distance from the middle of a panel, in half its length
    const double center = 0.5 * (from + to), reach = 0.5 * (to - from);
    double nearest = kInfinity;
    for (const std::complex<double>& p : singular_) {
      nearest = std::min(nearest, std::norm(p - center));
    }
    if (splits > 0 && nearest < kClear * kClear * reach * reach) {
      add_panels(from, center, splits - 1);
      add_panels(center, to, splits - 1);
      return;
    }
    const double before = sum_.volume;
    for (const GaussNode& node : kGauss12) {
      for (const double x : {-node.x, node.x}) {
        const double turn = center + reach * x;
        const double c = middle_ - half_ * std::cos(turn);
        // From the ends of the range: next to them 1 - c^2 would be rounding.
        const double sine = std::sin(0.5 * turn), cosine = std::cos(0.5 * turn);
        const double square = ((1.0 - to_) + 2.0 * half_ * cosine * cosine) *
                              ((1.0 + from_) + 2.0 * half_ * sine * sine);
        if (!(square > 0.0)) continue;
        add_segment(c, square,
                    2.0 * reach * node.weight * half_ * std::sin(turn) / std::sqrt(square));
      }
    }
    // Where the plane touches the tube a singularity lies on the range, or next to it.
    constexpr double kUnresolved = 0.1;
    if (nearest < kClear * kClear * reach * reach) error_ += kUnresolved * (sum_.volume - before);
  }

  // The section at cos(phi) = c: chord at the distance g / n from the middle of the disc; u from
  // there downwards, v along the chord.
  void add_segment(double c, double sin_square, double weight) {
    const double n = std::sqrt(sine_ * c * sine_ * c + cosine_ * cosine_),
                 g = sine_ * major_ * c + height_;
    const double scale = minor_ * n;
    const double dry = std::max(0.0, scale - g), wet = std::max(0.0, scale + g);
    if (!(scale > 0.0) || !(dry > 0.0)) return;
    const CircularSegment segment(dry / scale, std::sqrt(dry * wet) / scale);
    const double n1 = sine_ * c / n, n2 = cosine_ / n;
    const double R = major_, r = minor_, r2 = r * r, r3 = r2 * r, r4 = r2 * r2, r5 = r4 * r;
    const double e = segment.area * r2, u = segment.u * r3, uu = segment.uu * r4,
                 vv = segment.vv * r4, uuu = segment.uuu * r5, uvv = segment.uvv * r5;
    const double n11 = n1 * n1, n22 = n2 * n2, n12 = n1 * n2;
    // rho = R - n1 u - n2 v, q = n1 v - n2 u.
    const double spread = n11 * uu + n22 * vv;
    const double rho = R * e - n1 * u;
    const double rho2 = R * (R * e - 2.0 * n1 * u) + spread;
    const double rho3 =
        R * (R * (R * e - 3.0 * n1 * u) + 3.0 * spread) - n1 * (n11 * uuu + 3.0 * n22 * uvv);
    const double rho_q = n12 * (uu - vv) - R * n2 * u;
    const double rho_qq = R * (n22 * uu + n11 * vv) - n1 * (n22 * uuu + (n11 - 2.0 * n22) * uvv);
    const double rho2_q =
        -n2 * (R * (R * u - 2.0 * n1 * (uu - vv)) + n11 * uuu + (n22 - 2.0 * n11) * uvv);
    sum_.volume += weight * rho;
    sum_.p += weight * c * rho2;
    sum_.q += weight * rho_q;
    sum_.pp += weight * c * c * rho3;
    sum_.rr += weight * sin_square * rho3;
    sum_.pq += weight * c * rho2_q;
    sum_.qq += weight * rho_qq;
    sum_.depth_moment += weight * scale * (R * r2 * segment.depth - n1 * r3 * segment.vv);
    sum_.side_area += weight * 2.0 * r * (segment.angle * R - n1 * r * segment.sine);
    // The chord, at u = r cosine.
    const double chord = r * segment.cosine, w = r * segment.sine, line = 2.0 * weight * w / n;
    const double at = R - n1 * chord, bend = w * w * (1.0 / 3.0);
    sum_.cut_area += line * at;
    sum_.cut_p += line * c * (at * at + n22 * bend);
    sum_.cut_q -= line * (at * n2 * chord + n12 * bend);
  }

  const double major_, minor_;
  double sine_, cosine_;
  const double height_;
  double touch_low_ = -kInfinity, touch_high_ = kInfinity;
  double first_ = -1.0, last_ = 1.0;  // range of cos(phi) with segments
  double from_ = -1.0, to_ = 1.0;     // of the part of it that is integrated
  double middle_ = 0.0, half_ = 1.0;  // of that
  double error_ = 0.0;
  std::complex<double> singular_[3] = {{0.0, kInfinity}, {0.0, kInfinity}, {0.0, kInfinity}};
  TiltedSum sum_;
};

/// Torus B in half-space A, in A. One region always: no plane cuts a torus into more than two
/// pieces, one on each side. Fully immersed as with the ball.
inline VolumeMetrics closed_form(const HalfSpace&, const Torus& b, const Pose& X_AB) noexcept {
  const double R = b.major_radius(), r = b.minor_radius();
  const Tilt tilt(X_AB.rotation.col(2));
  const double height = X_AB.translation.z(), reach = R * tilt.sine + r;
  if (!(height < reach) || !(r > 0.0)) return VolumeMetrics{};
  if (!(height > -reach)) {
    return immersed_solid(b.own_metrics(), X_AB, 4.0 * kPi * kPi * R * r, 2.0 * reach);
  }
  const TorusSections sections(b, tilt, height);
  VolumeMetrics metrics = sections.sum().metrics(X_AB.translation, tilt, R + r);
  metrics.volume_error += sections.error();
  return metrics;
}

}  // namespace volcontact
