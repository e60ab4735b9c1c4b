// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/closed_form/edge_sections.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include "volcontact/pair/closed_form/gauss_rule.h"
#include "volcontact/pair/quadrature/small_turn.h"

namespace volcontact {
namespace {

constexpr double kLeastLean = 1e-12;  // of a half-plane to the axis; with less it is across it
constexpr double kSteep = 0.7;        // part of the axis across, with which z tells little
constexpr double kMostAtOnce = 5.0;   // angle of an arc for one rule [rad]
constexpr double kShortArc = 0.8;     // angle of an arc for a short rule [rad]

// For products of five sines and cosines over `range` [rad], to 1e-7 or better.
std::span<const GaussNode> rule_for(double range) {
  if (range < kShortArc) return kGauss6;
  if (range < 1.7) return kGauss8;
  if (range < 3.5) return kGauss12;
  return kGauss16;
}

// Calls add(cosine, sine, weight) at the nodes of a rule between two angles.
template <typename Add>
void over_arc(double from, double to, Add&& add) {
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  const double cosine = std::cos(middle), sine = std::sin(middle);
  const bool is_small = std::abs(half) <= kSmallTurn;
  for (const GaussNode& node : rule_for(2.0 * std::abs(half))) {
    const double angle = half * node.x;
    const SmallTurn turn = is_small ? SmallTurn(angle) : SmallTurn::any(angle);
    const double weight = half * node.weight;
    add(cosine * turn.cos + sine * turn.sin, sine * turn.cos - cosine * turn.sin, weight);
    add(cosine * turn.cos - sine * turn.sin, sine * turn.cos + cosine * turn.sin, weight);
  }
}

// One of the two parts of the outline of the cylinder. At z along the axis the half-plane is at the
// distance q from it, in radii in the direction across; c = sqrt(1 - q^2) is how far the outline is
// from there.
class Side {
 public:
  struct Place {
    double z, q;
  };

  // `side`: +1 or -1.
  Side(const EdgeView& v, double radius, double side)
      : v_(v),
        side_(side),
        width_(radius * v.lean),
        slope_rho_(radius * v.axis_across * v.cosine),
        slope_y_(radius * v.axis_across * v.sine),
        out_rho_(side * radius * v.sine),
        out_y_(-side * radius * v.cosine),
        steep_(std::abs(v.axis_across) > kSteep) {}

  // At z, or at the tip of the outline if it does not reach so far.
  Place at(double z) const {
    const double q = (v_.across + z * v_.axis_across) / width_;
    return std::abs(q) <= 1.0 ? Place{z, q} : at_distance(std::copysign(1.0, q));
  }
  Place at_distance(double q) const { return {(q * width_ - v_.across) / v_.axis_across, q}; }

  // Where the edge leaves the cylinder: at `z`, and y. False if that is on the other side.
  bool find(double z, double y, double radius, Place& place) const {
    const double x = -(v_.rho + z * v_.axis_rho), along = y - v_.y - z * v_.axis_y;
    if (!((x * v_.sine - along * v_.cosine) * side_ > 0.0)) return false;
    place = at(z);
    if (steep_) {
      const double q = (x * v_.cosine + along * v_.sine) / (radius * v_.axis_across);
      place = at_distance(std::clamp(q, -1.0, 1.0));
    }
    return true;
  }

  // Half-planes across the axis meet all of the outline at one z, those along it at one q.
  bool is_steep() const { return steep_; }
  bool is_before(const Place& a, const Place& b) const {
    return steep_ ? (b.q - a.q) * v_.axis_across > 0.0 : a.z < b.z;
  }

  // What is between two places, if it is on this side of the edge. By z, but where the outline
  // bends much.
  void add(const Place& a, const Place& b, EdgeSection& s) const {
    if (!is_before(a, b)) return;
    const double q_m = 0.5 * (a.q + b.q);
    if (!(rho(0.5 * (a.z + b.z), q_m, cosine_of(q_m)) > 0.0)) return;
    const bool is_flat = std::abs(b.q - a.q) <= 1.0 - std::max(std::abs(a.q), std::abs(b.q));
    return is_flat ? add_by_z(a, b, s) : add_by_angle(a, b, s);
  }

 private:
  static double cosine_of(double q) { return std::sqrt(std::max(0.0, (1.0 - q) * (1.0 + q))); }
  double rho(double z, double q, double c) const {
    return v_.rho + z * v_.axis_rho + q * slope_rho_ + c * out_rho_;
  }
  double y(double z, double q, double c) const {
    return v_.y + z * v_.axis_y + q * slope_y_ + c * out_y_;
  }

  void add_by_z(const Place& a, const Place& b, EdgeSection& s) const {
    const double z_m = 0.5 * (a.z + b.z), q_m = 0.5 * (a.q + b.q);
    const double dz = 0.5 * (b.z - a.z), dq = 0.5 * (b.q - a.q);
    EdgeSection sum;
    for (const GaussNode& node : kGauss8) {
      for (const double x : {-node.x, node.x}) {
        const double z = z_m + dz * x, q = q_m + dq * x, c = cosine_of(q), r = rho(z, q, c);
        const double dy = dz * v_.axis_y + dq * (slope_y_ - q / c * out_y_);
        sum.add(r, y(z, q, c), side_ * node.weight * dy);
        sum.add_surface(r, node.weight * dz / (v_.lean * c), q * v_.lean);
      }
    }
    s += sum;
  }

  // By the angle whose sine is q.
  void add_by_angle(const Place& a, const Place& b, EdgeSection& s) const {
    const double from = std::atan2(a.q, cosine_of(a.q)), to = std::atan2(b.q, cosine_of(b.q));
    const double rate = (b.z - a.z) / (b.q - a.q);
    EdgeSection sum;
    over_arc(from, to, [&](double c, double q, double weight) {
      const double z = a.z + rate * (q - a.q), r = rho(z, q, c);
      sum.add(r, y(z, q, c), side_ * weight * (c * (rate * v_.axis_y + slope_y_) - q * out_y_));
      sum.add_surface(r, weight * rate / v_.lean, q * v_.lean);
    });
    s += sum;
  }

  const EdgeView& v_;
  const double side_, width_;  // q = 1 is so far across
  const double slope_rho_, slope_y_, out_rho_, out_y_;
  const bool steep_;
};

}  // namespace

// Of a round end: a circle, from where it is beyond the end of the cylinder to where the edge cuts
// it.
void EdgeSections::add_cap(const EdgeView& v, int end, EdgeSection& s) const {
  const double z = end * half_length;
  const double x = v.rho + z * v.axis_rho, y = v.y + z * v.axis_y;
  const double across = v.across + z * v.axis_across;
  const double disc = (radius - across) * (radius + across);
  if (!(disc > 0.0)) return;
  const double r = std::sqrt(disc), on_edge = disc - x * x;
  double edge = kPi;  // half the angle of what is on this side of the edge
  if (on_edge > 0.0) {
    edge = std::atan2(std::sqrt(on_edge), -x);
  } else if (!(x > 0.0)) {
    return;
  }
  const auto add_arc = [&](double from, double to) {
    EdgeSection sum;
    over_arc(from, to, [&](double cosine, double sine, double weight) {
      const double rho = x + r * cosine;
      sum.add(rho, y + r * sine, weight * r * cosine);
      sum.add_surface(rho, weight * radius, across / radius);
    });
    s += sum;
  };
  const auto add = [&](double from, double to) {
    if (!(to > from)) return;
    const double middle = 0.5 * (from + to);
    if (!(to - from > kMostAtOnce)) return add_arc(from, to);
    add_arc(from, middle);
    add_arc(middle, to);
  };
  if (!(half_length > 0.0)) return add(-edge, edge);
  const double rim = square_of(radius * v.lean) - square_of(across);
  const double beyond = end * across * v.axis_across;
  if (!(rim > 0.0)) {
    if (beyond < 0.0) add(-edge, edge);
    return;
  }
  const double half = std::atan2(std::sqrt(rim), beyond);
  const double middle = std::atan2(end * v.sine, end * v.cosine);
  for (const double turn : {-2.0 * kPi, 0.0, 2.0 * kPi}) {
    add(std::max(-edge, middle + turn - half), std::min(edge, middle + turn + half));
  }
}

// From one end of the cylinder to the other, but for what is beyond the edge.
void EdgeSections::add_side(const EdgeView& v, double which, EdgeSection& s) const {
  const Side side(v, radius, which);
  const Side::Place low = side.at(-half_length), high = side.at(half_length);
  if (low.q == high.q && std::abs(low.q) == 1.0) return;
  std::array<Side::Place, 4> cuts = {low};
  std::size_t count = 1;
  for (const double y : {-half_edge, half_edge}) {
    const double z = axis.z() * y - axis.dot(origin);
    if (!side.is_steep() && !(std::abs(z) < half_length)) continue;
    Side::Place cut;
    if (!side.find(z, y, radius, cut)) continue;
    if (side.is_before(low, cut) && side.is_before(cut, high)) cuts[count++] = cut;
  }
  if (count == 3 && side.is_before(cuts[2], cuts[1])) std::swap(cuts[1], cuts[2]);
  cuts[count] = high;
  for (std::size_t i = 0; i < count; ++i) side.add(cuts[i], cuts[i + 1], s);
}

EdgeView EdgeSections::view(double c, double s) const {
  EdgeView v;
  v.rho = c * origin.x() + s * origin.y();
  v.across = c * origin.y() - s * origin.x();
  v.y = origin.z();
  v.axis_rho = c * axis.x() + s * axis.y();
  v.axis_across = c * axis.y() - s * axis.x();
  v.axis_y = axis.z();
  v.lean = std::max(kLeastLean, std::sqrt(square_of(v.axis_rho) + square_of(v.axis_y)));
  const bool is_across = v.lean == kLeastLean;
  v.cosine = is_across ? 1.0 : v.axis_rho / v.lean;
  v.sine = is_across ? 0.0 : v.axis_y / v.lean;
  return v;
}

EdgeSection EdgeSections::at(double cosine, double sine) const {
  const EdgeView v = view(cosine, sine);
  EdgeSection result;
  add_cap(v, 1, result);
  if (half_length > 0.0) {
    add_cap(v, -1, result);
    add_side(v, 1.0, result);
    add_side(v, -1.0, result);
  }
  result.finish();
  return result;
}

}  // namespace volcontact
