// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/pressure/pressure_columns.h"

#include <algorithm>
#include <cmath>

#include "volcontact/base/symmetric_eigen.h"
#include "volcontact/pair/quadrature/outer_rule.h"

namespace volcontact {
namespace {

constexpr int kTurns = 32;            // half-planes through the axis
constexpr int kMostSearchSteps = 60;  // of any search
constexpr double kNear = 1e-12;       // where a search ends, per length searched
constexpr double kFirstReach = 2.0;   // spreads from the centroid to the rim, as a first guess

class ColumnField {
 public:
  ColumnField(const Ellipsoid& a, const Ellipsoid& b, const Pose& X_AB, const VolumeMetrics& site,
              double share_of_a)
      : a_(a), b_(b), X_BA_(X_AB.inverse()), c_(site.centroid) {
    stiffness_a_ = share_of_a > 0.0 ? 1.0 / share_of_a : kInfinity;
    stiffness_b_ = share_of_a < 1.0 ? 1.0 / (1.0 - share_of_a) : kInfinity;
    choose_frame(site);
  }

  PressureField integrate() {
    using Rule = GaussRule<8>;
    for (int k = 0; k < kTurns; ++k) {
      const double angle = 2.0 * kPi * (k + 0.5) / kTurns;
      const Vec3 along = std::cos(angle) * u_ + std::sin(angle) * v_;
      const double rim = find_rim(along);
      for (int i = 0; i < 8; ++i) {
        const double rho = rim * Rule::kNodes[i];
        weight_ = 2.0 * kPi / kTurns * rim * Rule::kWeights[i] * rho * area_;
        add_column(column(rho * along));
      }
    }
    return sum_;
  }

 private:
  struct Column {
    Vec3 foot;
    RayInterval in_a, in_b;

    double low() const { return std::max(in_a.enter, in_b.enter); }
    double high() const { return std::min(in_a.leave, in_b.leave); }
    bool hits() const { return !in_a.empty() && !in_b.empty(); }
  };

  // Columns along the normal; across them, axes in which the overlap has the spread 1.
  void choose_frame(const VolumeMetrics& site) {
    const Mat3 spread = site.second_moment() / site.volume;
    t_ = site.normal();
    if (t_.isZero(0.0))
      t_ = symmetric_eigen(spread).vectors.col(0);  // no direction: the shortest one
    const Mat3 basis = basis_with_z(t_);
    const Mat2 across = basis.leftCols<2>().transpose() * spread * basis.leftCols<2>();
    const double l00 = std::sqrt(across(0, 0)), l10 = across(1, 0) / l00;
    const double l11 = std::sqrt(std::max(0.0, across(1, 1) - l10 * l10));
    u_ = l00 * basis.col(0) + l10 * basis.col(1);
    v_ = l11 * basis.col(1);
    area_ = l00 * l11;
  }

  Column column(const Vec3& offset) const {
    const Vec3 foot = c_ + offset;
    return {foot, a_.ray(foot, t_), b_.ray(X_BA_ * foot, X_BA_.rotation * t_)};
  }

  // How far the columns reach along a direction. Their length is a concave function of the way.
  double find_rim(const Vec3& along) const {
    double inside = 0.0, outside = kFirstReach;
    double length = 0.0, miss = 0.0;  // length at `inside`; overlap at `outside`, negative
    bool known_miss = false;
    const auto look = [&](double rho) {
      const Column at = column(rho * along);
      const double overlap = at.high() - at.low();
      if (at.hits() && overlap > 0.0) {
        inside = rho, length = overlap;
        return true;
      }
      outside = rho, miss = overlap, known_miss = at.hits();
      return false;
    };
    for (int step = 0; step < kMostSearchSteps && look(outside); ++step) outside = 2.0 * inside;
    for (int step = 0; step < kMostSearchSteps && outside - inside > kNear * outside; ++step) {
      // From inside a concave function lies above the chord: the chord's end is inside as well.
      double next = 0.5 * (inside + outside);
      const bool by_chord = known_miss && length > 0.0 && miss < 0.0 && step % 3 != 2;
      if (by_chord) next = inside + (outside - inside) * length / (length - miss);
      if (!(next > inside && next < outside)) break;
      look(next);
    }
    return inside;
  }

  // psi of A's layer over that of B's.
  double lead(const Vec3& x) const {
    return stiffness_a_ * depth_in(a_, x).value - stiffness_b_ * depth_in(b_, X_BA_ * x).value;
  }

  void add_column(const Column& at) {
    const double low = at.low(), high = at.high();
    if (!at.hits() || !(high > low)) return;
    if (stiffness_b_ == kInfinity || stiffness_a_ == kInfinity) return add_part(at, low, high);
    const bool a_below = at.in_a.enter > at.in_b.enter, a_above = at.in_a.leave < at.in_b.leave;
    const double middle = a_below == a_above ? 0.5 * (low + high) : crossing(at, low, high);
    add_part(at, low, middle);
    add_part(at, middle, high);
  }

  // Where the two layers are equally soft, by the Illinois form of false position.
  double crossing(const Column& at, double low, double high) const {
    const double width = high - low;
    double at_low = lead(at.foot + low * t_), at_high = lead(at.foot + high * t_), last = low;
    int kept = 0;  // which end the step before left in place
    for (int step = 0; step < kMostSearchSteps; ++step) {
      const double s = (low * at_high - high * at_low) / (at_high - at_low);
      if (!(s > low && s < high)) break;
      const double at_s = lead(at.foot + s * t_);
      if ((at_s < 0.0) == (at_high < 0.0)) {
        high = s, at_high = at_s;
        if (kept < 0) at_low *= 0.5;
        kept = -1;
      } else {
        low = s, at_low = at_s;
        if (kept > 0) at_high *= 0.5;
        kept = 1;
      }
      if (std::abs(s - last) <= kNear * width) break;
      last = s;
    }
    return std::abs(at_low) < std::abs(at_high) ? low : high;
  }

  void add_part(const Column& at, double from, double to) {
    using Rule = GaussRule<5>;
    for (int i = 0; i < 5; ++i) {
      const Vec3 x = at.foot + (from + Rule::kNodes[i] * (to - from)) * t_;
      const double weight = weight_ * Rule::kWeights[i] * (to - from);
      const Depth in_a = depth_in(a_, x);
      const double psi_a = stiffness_a_ * std::max(0.0, in_a.value);
      const Depth in_b = depth_in(b_, X_BA_ * x);
      const double psi_b = stiffness_b_ * std::max(0.0, in_b.value);
      sum_.energy += weight * std::min(psi_a, psi_b);
      Vec3 force;
      if (stiffness_a_ == kInfinity) {  // what B's layer presses comes back on A
        force = -weight * stiffness_b_ * (X_BA_.rotation.transpose() * in_b.gradient);
      } else {
        if (!(psi_a < psi_b)) continue;
        force = weight * stiffness_a_ * in_a.gradient;
      }
      sum_.force += force;
      sum_.couple += (x - c_).cross(force);
    }
  }

  const Ellipsoid& a_;
  const Ellipsoid& b_;
  Pose X_BA_;
  Vec3 c_;
  double stiffness_a_, stiffness_b_;  // of the layers, per k_v
  Vec3 t_, u_, v_;
  double area_ = 0.0, weight_ = 0.0;
  PressureField sum_;
};

}  // namespace

Depth depth_in(const Ellipsoid& solid, const Vec3& x) {
  const Vec3 per_axis = solid.semi_axes().cwiseInverse();
  const Vec3 unit = x.cwiseProduct(per_axis), normal = unit.cwiseProduct(per_axis);
  const double m = normal.norm(), s = solid.semi_axes().minCoeff();
  const double deficit = std::max(0.0, 1.0 - unit.squaredNorm());
  const double root = std::sqrt(m * m + deficit / (s * s));
  const double d = deficit / (m + root);
  if (!(m > 0.0)) return {d, Vec3::Zero()};
  const Vec3 grad_m = normal.cwiseProduct(per_axis).cwiseProduct(per_axis) / m;
  return {d, -(normal + d * grad_m) / root};
}

PressureField pressure_columns(const Ellipsoid& a, const Ellipsoid& b, const Pose& X_AB,
                               const VolumeMetrics& site, double share_of_a) {
  return ColumnField(a, b, X_AB, site, share_of_a).integrate();
}

}  // namespace volcontact
