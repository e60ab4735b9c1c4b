// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "volcontact/pair/closed_form/gauss_rule.h"
#include "volcontact/pair/closed_form/spherical_cap.h"
#include "volcontact/pair/closed_form/tilted_sum.h"

namespace volcontact {

/// The half of a ball on one side of its middle, cut by the plane z = 0 of A: the part below. The
/// flat side of the half ball is not counted as surface. docs/theory.md, "Capsule".
class HalfBall {
 public:
  /// `tilt` is that of the unit vector from the middle of the flat side towards the pole.
  HalfBall(double radius, const Vec3& center, const Tilt& tilt)
      : radius_(radius), center_(center), tilt_(tilt), height_(center.z() / radius) {}

  VolumeMetrics below() const {
    const double s = tilt_.sine, k = tilt_.cosine, d = height_;
    if (!(d < 1.0)) return VolumeMetrics{};
    // Where the planes meet: at `along` on the cut, from the point below the centre.
    const bool is_whole = d <= -1.0;
    const double cut_radius = is_whole ? 0.0 : std::sqrt((1.0 - d) * (1.0 + d));
    const bool meets = !is_whole && std::abs(d) < s;
    if (!meets) {
      const bool cut_is_outside = k * d < 0.0;  // the cut disc lies in this half of the ball
      if (d > 0.0) return cut_is_outside ? cap() : VolumeMetrics{};
      if (is_whole || d == 0.0 || !cut_is_outside)
        return d == 0.0 && k > 0.0 ? VolumeMetrics{} : whole();
      return rest(cut_radius, -cut_radius, 0.0, 1.0);
    }
    const double along = k * d / s;
    const double edge = std::sqrt((s - d) * (s + d)) / s;  // half the length of the common line
    constexpr double kShallow = 0.98;
    return d > kShallow ? thin(cut_radius, along, edge) : rest(cut_radius, along, edge, -d / s);
  }

 private:
  static double cube(double x) { return x * x * x; }

  // Metrics of a sum in units of the radius, about `origin` (z up, forward along the heading).
  VolumeMetrics scaled(TiltedSum sum, const Vec3& origin) const {
    const double r = radius_, r2 = r * r, r3 = r2 * r, r4 = r3 * r, r5 = r4 * r;
    sum.volume *= r3;
    sum.p *= r4, sum.q *= r4;
    sum.pp *= r5, sum.pq *= r5, sum.qq *= r5, sum.rr *= r5;
    sum.depth_moment *= r4;
    sum.cut_area *= r2, sum.side_area *= r2;
    sum.cut_p *= r3, sum.cut_q *= r3;
    sum.depth *= r;
    return sum.metrics(origin, upright(), r);
  }
  // p up and q forward: the sums below are in these axes.
  Tilt upright() const {
    Tilt t = tilt_;
    t.sine = 1.0;
    t.cosine = 0.0;
    return t;
  }

  // The whole cap lies in this half.
  VolumeMetrics cap() const {
    const SphericalCap cap = spherical_cap(1.0, 1.0 - height_);
    TiltedSum sum;
    sum.volume = cap.volume;
    sum.depth_moment = cap.depth_moment;
    sum.pp = cap.axial_second;
    sum.qq = sum.rr = cap.lateral_second;
    sum.cut_area = cap.cut_area;
    sum.side_area = cap.lateral_area;
    sum.depth = 1.0 - height_;
    return scaled(sum, center_);
  }

  // The whole half ball.
  VolumeMetrics whole() const {
    const double s = tilt_.sine, k = tilt_.cosine;
    constexpr double kAxial = kPi * (2.0 / 15.0 - 3.0 / 32.0);  // about the centroid, at 3/8
    constexpr double kLateral = kPi * 2.0 / 15.0;
    TiltedSum sum;
    sum.volume = kPi * 2.0 / 3.0;
    const double first = kPi / 4.0;
    sum.p = k * first;
    sum.q = s * first;
    sum.depth_moment = -(k * first + height_ * sum.volume);
    sum.pp = kLateral * s * s + kAxial * k * k + k * first * k * 0.375;
    sum.qq = kLateral * k * k + kAxial * s * s + s * first * s * 0.375;
    sum.pq = (kAxial - kLateral) * k * s + k * first * s * 0.375;
    sum.rr = kLateral;
    sum.side_area = 2.0 * kPi;
    sum.depth = std::max(k < 0.0 ? 1.0 : s, 0.0) - height_;
    return scaled(sum, center_);
  }

  // The general case by the divergence theorem, with w the half width across the plane of the
  // Tilt: x w = -grad(w^3) / 3, and w vanishes on the sphere. `from` <= q <= cut_radius on the cut.
  VolumeMetrics rest(double cut_radius, double from, double edge, double flat_end) const {
    const double s = tilt_.sine, k = tilt_.cosine, d = height_;
    const double g2 = cut_radius * cut_radius;
    const double turn_from = std::atan2(from, edge), turn = 0.5 * kPi - turn_from;
    const double sin_f = from / cut_radius, cos_f = edge / cut_radius;
    const double edge3 = cube(edge), edge5 = edge3 * edge * edge;
    // int w, w^3, q w and q w^3 over the cut.
    const double w1 = 0.5 * (g2 * turn - from * edge);
    const double w3 = 0.25 * (3.0 * g2 * w1 - from * edge3);
    const double q_w1 = edge3 / 3.0, q_w3 = edge5 / 5.0;
    // The same over the flat side, from its lowest line to the common line: int w^3 and x w^3.
    const double flat_turn = std::atan2(flat_end, edge) + 0.5 * kPi;
    const double f1 = 0.5 * (flat_turn + flat_end * edge);
    const double f3 = 0.25 * (3.0 * f1 + flat_end * edge3), x_f3 = -edge5 / 5.0;
    // Angle of the directions from the centre that end on the sphere or the cut.
    const double rim = std::atan2(cut_radius, d);
    const bool meets = edge > 0.0;
    const double inner = meets ? std::atan2(k, s) : (k > 0.0 ? kPi - rim : -rim);
    const double fan = rim - inner;
    // int dq / (1 + w) over the cut, times d.
    const auto pole = [&](double sine, double cosine) {
      return std::atan2(d * sine, (1.0 + cosine) * (1.0 + cut_radius));
    };
    const double poles = 2.0 * (pole(1.0, 0.0) - (meets ? pole(sin_f, cos_f) : pole(-1.0, 0.0)));
    const double hollow = d * turn - poles;
    TiltedSum sum;
    const double area = (fan - d * w1 - hollow) / 3.0;  // int w
    sum.volume = 2.0 * area;
    sum.p = (2.0 / 3.0) * (k * f3 - w3);
    sum.q = (2.0 / 3.0) * s * f3;
    const double cubes = 0.2 * (3.0 * area - d * w3);  // int w^3
    sum.rr = (2.0 / 3.0) * cubes;
    // On the flat side p = s x, q = -k x, its outward normal is -(k, s).
    sum.pp = (2.0 / 3.0) * (cubes + d * w3 + k * s * x_f3);
    sum.qq = (2.0 / 3.0) * (cubes - k * s * x_f3);
    sum.pq = (2.0 / 3.0) * (-q_w3 - k * k * x_f3);
    sum.depth_moment = std::max(0.0, -(sum.p + d * sum.volume));
    sum.cut_area = 2.0 * w1;
    sum.cut_p = -d * sum.cut_area;
    sum.cut_q = 2.0 * q_w1;
    sum.side_area = 2.0 * (fan - hollow);
    sum.depth = std::max(k < 0.0 ? 1.0 : s, 0.0) - d;
    return scaled(sum, center_);
  }

  // A thin slice, where rest() would cancel: sectors around the centre, between the cut and the
  // sphere. Along a sector 2 w^2 dw with rho^2 = 1 - w^2; 1 - rho by its series.
  VolumeMetrics thin(double cut_radius, double from, double edge) const {
    const double d = height_;
    const double turn_from = std::atan2(from, edge);
    const double half = 0.5 * (0.5 * kPi - turn_from), middle = turn_from + half;
    TiltedSum sum;
    for (const GaussNode& node : kGauss12) {
      for (const double x : {-node.x, node.x}) {
        const double turn = middle + half * x;
        const double q = cut_radius * std::sin(turn), w = cut_radius * std::cos(turn);
        const double dq = half * node.weight * w, w2 = w * w, w3 = w2 * w;
        const double rho2 = 1.0 - w2, rho = std::sqrt(rho2);
        const double weight = dq * d / rho2, cosine = d / rho, sine = q / rho;
        const double zero = w3 * (2.0 / 3.0);
        const double tail =
            w3 * w2 * w2 *
            (1.0 / 28.0 +
             w2 * (1.0 / 72.0 + w2 * (5.0 / 704.0 + w2 * (7.0 / 1664.0 + w2 * (7.0 / 2560.0)))));
        const double one = w3 * w2 * 0.2 + tail, two = 2.0 * tail;  // of 1 - rho
        const double top = cosine * w2 / (1.0 + rho);               // depth where rho = 1
        const double depth = top * zero - cosine * one;
        const double depth_one = top * one - cosine * two;
        const double depth_two = top * depth - cosine * depth_one;
        sum.volume += weight * zero;
        sum.depth_moment += weight * depth;
        sum.q += weight * sine * (zero - one);
        sum.pp += weight * depth_two;
        sum.qq += weight * sine * sine * (zero - 2.0 * one + two);
        sum.pq -= weight * sine * (depth - depth_one);
        sum.rr += weight * w3 * w2 * (2.0 / 15.0);
        sum.cut_area += 2.0 * dq * w;
        sum.cut_q += 2.0 * dq * w * q;
        sum.side_area += 2.0 * weight * w;
      }
    }
    sum.p = -sum.depth_moment;  // from the plane
    sum.depth = std::max(tilt_.cosine < 0.0 ? 1.0 : tilt_.sine, 0.0) - d;
    return scaled(sum, Vec3(center_.x(), center_.y(), 0.0));
  }

  const double radius_;
  const Vec3 center_;
  const Tilt tilt_;
  const double height_;  // of the centre above the plane, in radii
};

}  // namespace volcontact
