// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/closed_form/capsule_at_edge.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "volcontact/pair/closed_form/gauss_rule.h"

namespace volcontact {
namespace {

constexpr double kLeastSine = 1e-3;    // of the angle between the planes
constexpr double kLeastDepth = 1e-12;  // of the edge below the surface, in radii
constexpr double kLeastLean = 1e-12;   // of a half-plane to the axis; with less they are upright
constexpr double kLongest = 1.8;       // piece of a way, by its measure
constexpr double kLongestToRim = 1.0;  // the same where a rim is touched
constexpr double kOpen = 2e-6;         // gap of the surface, per area, with which steps are halved
constexpr int kMostHalvings = 8;
constexpr double kRule = 1e-9;         // error of the rule in a section
constexpr double kMostOpen = 1e-5;     // gap with which there is no answer

double square(double x) { return x * x; }

// Calls add(x, weight) at the nodes of a rule on [-1, 1].
template <typename Add>
void over(std::span<const GaussNode> rule, Add&& add) {
  for (const GaussNode& node : rule) {
    add(-node.x, node.weight);
    add(node.x, node.weight);
  }
}

// Products of five sines and cosines to 1e-7 or better.
std::span<const GaussNode> rule_for(double range) {
  if (range < 1.7) return kGauss8;
  if (range < 3.5) return kGauss12;
  return kGauss16;
}

}  // namespace

// Integrals over a section, with y along the edge and rho away from it.
struct CapsuleAtEdge::Section {
  double area = 0.0, area_y = 0.0;                             // int 1, y
  double rho = 0.0, rho_rho = 0.0, rho_y = 0.0;                // int rho times 1, rho, y
  double rho_rho_rho = 0.0, rho_rho_y = 0.0, rho_y_y = 0.0;    // rho times rho^2, rho y, y^2
  double surface = 0.0;  // of the solid, per angle
  double flux = 0.0, rho_flux = 0.0;  // of the same, across the half-plane: 1, rho

  // Of a piece of the outline, counterclockwise: sums of rho^k y^i dy, which are the integrals but
  // for factors, since rho vanishes along the edge.
  void add(double r, double y, double dy) {
    const double one = r * dy, two = r * one, three = r * two;
    area += one;
    area_y += y * one;
    rho += two;
    rho_y += y * two;
    rho_y_y += y * y * two;
    rho_rho += three;
    rho_rho_y += y * three;
    rho_rho_rho += r * three;
  }
  void finish() {
    rho *= 0.5, rho_y *= 0.5, rho_y_y *= 0.5;
    rho_rho *= 1.0 / 3.0, rho_rho_y *= 1.0 / 3.0;
    rho_rho_rho *= 0.25;
  }
};

// What a half-plane sees of the axis: parts along it, away from the edge, and across it.
struct CapsuleAtEdge::View {
  double rho, across, y;  // of A's origin
  double axis_rho, axis_across, axis_y;
  double lean;            // of the axis in the half-plane: its length
  double cosine, sine;    // its direction there
};

struct CapsuleAtEdge::Sums {
  double volume = 0.0, surface = 0.0, depth_moment = 0.0;
  double flux = 0.0, rho_flux = 0.0;
  double most = 0.0;  // int rho of a section
  Vec3 first = Vec3::Zero();
  double second[6] = {};  // xx, xy, yy, xz, yz, zz

  // A section with the weight of its angle; `length` of a column there, per distance of its lower
  // end from the edge.
  void add(const Section& s, double weight, double cosine, double sine, double length) {
    volume += weight * s.rho;
    depth_moment += weight * length * s.rho_rho;
    surface += weight * s.surface;
    flux += weight * s.flux;
    rho_flux += weight * s.rho_flux;
    most = std::max(most, s.rho);
    first += weight * Vec3(s.rho_rho * cosine, s.rho_rho * sine, s.rho_y);
    const double x = weight * cosine, y = weight * sine;
    second[0] += x * cosine * s.rho_rho_rho;
    second[1] += x * sine * s.rho_rho_rho;
    second[2] += y * sine * s.rho_rho_rho;
    second[3] += x * s.rho_rho_y;
    second[4] += y * s.rho_rho_y;
    second[5] += weight * s.rho_y_y;
  }
  Sums& operator+=(const Sums& o) {
    volume += o.volume;
    surface += o.surface;
    depth_moment += o.depth_moment;
    flux += o.flux;
    rho_flux += o.rho_flux;
    most = std::max(most, o.most);
    first += o.first;
    for (int i = 0; i < 6; ++i) second[i] += o.second[i];
    return *this;
  }
};

// What gaps are judged by: the area of the faces, and int rho of a section.
struct CapsuleAtEdge::Scale {
  double area, rho;
};

// Angles between which the outline of a section is of the same parts.
struct CapsuleAtEdge::Breaks {
  struct Break {
    double angle;
    int end;  // of the cylinder whose rim the half-plane touches, or 0
  };
  std::array<Break, 8> at;
  int count = 0;
};

CapsuleAtEdge::CapsuleAtEdge(double radius, double half_length, const FaceMet& first,
                             const FaceMet& second)
    : radius_(radius), half_length_(half_length), faces_{first, second} {
  is_cut_ = find_edge(first, second);
  if (is_cut_) find_middle();
}

bool CapsuleAtEdge::find_edge(const FaceMet& first, const FaceMet& second) {
  const Vec3 &n = first.normal, &m = second.normal;
  const Vec3 across = m.cross(n);
  const double sine = across.norm(), cosine = n.dot(m);
  if (!(sine > kLeastSine)) return false;
  opening_ = kPi - std::atan2(sine, cosine);
  const Vec3 along = across / sine;
  X_AE_.rotation = Mat3::with_columns(along.cross(n), -n, along);
  const double a = -first.height, b = -second.height, per_square = 1.0 / (sine * sine);
  X_AE_.translation = (per_square * (a - b * cosine)) * n + (per_square * (b - a * cosine)) * m;
  return true;
}

// The place of the edge that is nearest to the axis, and the ends of the edge in the solid.
void CapsuleAtEdge::find_middle() {
  const Vec3 along = X_AE_.rotation.col(2);
  Vec3 x = X_AE_.translation;  // at right angles to the edge
  const double lean = 1.0 - square(along.z());
  double z = 0.0;
  if (lean > 1e-12) z = x.z() / lean;
  z = std::clamp(z, -half_length_, half_length_);
  x = x + (z * along.z()) * along;
  Vec3 out = x - Vec3(0.0, 0.0, z);
  const double distance = out.norm(), depth = radius_ - distance;
  is_cut_ = depth > kLeastDepth * radius_;
  if (!is_cut_) return;
  const double to = way_out(x, along), from = -way_out(x, -along);
  half_edge_ = 0.5 * (to - from);
  X_AE_.translation = x + 0.5 * (to + from) * along;

  // The way out is across the axis as well, but at the ends of it.
  if (!(distance > 1e-6 * radius_)) {
    out = along.cross(Vec3::UnitZ());
    if (!(out.norm() > 1e-6)) out = X_AE_.rotation.col(0);
  }
  out = out.normalized();
  const Vec3 flat = out.cross(along).normalized();
  const double width = 0.5 * (way_out(x, flat) + way_out(x, -flat));
  flat_angle_ = std::atan2(flat.dot(X_AE_.rotation.col(1)), flat.dot(X_AE_.rotation.col(0)));
  flat_scale_ = 2.0 * depth / width;

  origin_ = X_AE_.rotation.transposed_times(-X_AE_.translation);
  axis_ = X_AE_.rotation.transposed_times(Vec3::UnitZ());
}

// From a place within along a unit vector, which leaves by the cylinder or by the end that it heads
// for.
double CapsuleAtEdge::way_out(const Vec3& from, const Vec3& along) const {
  const auto root = [](double a, double b, double c) {  // a s^2 + 2 b s = c, c > 0: the larger s
    const double d = std::sqrt(std::max(0.0, b * b + a * c));
    return b > 0.0 ? c / (b + d) : (d - b) / a;
  };
  const double end = std::copysign(half_length_, along.z());
  if (half_length_ > 0.0) {
    const double a = square(along.x()) + square(along.y());
    const double b = along.x() * from.x() + along.y() * from.y();
    const double away = std::sqrt(square(from.x()) + square(from.y()));
    const double c = (radius_ - away) * (radius_ + away);
    if (a > 1e-24) {
      const double s = root(a, b, std::max(0.0, c));
      const double z = from.z() + s * along.z();
      if (std::abs(z) <= half_length_) return s;
      if (z * end < 0.0) {  // heads for one end and still is in the other
        const Vec3 p = from + Vec3(0.0, 0.0, end);
        const double d = p.norm();
        return root(1.0, p.dot(along), std::max(0.0, (radius_ - d) * (radius_ + d)));
      }
    }
  }
  const Vec3 p = from - Vec3(0.0, 0.0, end);
  const double d = p.norm();
  return root(1.0, p.dot(along), (radius_ - d) * (radius_ + d));
}

bool CapsuleAtEdge::is_behind(int face, const Vec3& x) const {
  const FaceMet& f = faces_[static_cast<std::size_t>(face)];
  return f.normal.dot(x) + f.height <= 1e-14 * (radius_ + half_length_);
}

// The farthest place along e of what of the solid is in the plane of a face. It is made of discs
// about the axis, of which the best is where the slope vanishes.
double CapsuleAtEdge::reach_in_face(const Vec3& e, int face, bool& within) const {
  const FaceMet& f = faces_[static_cast<std::size_t>(face)];
  const double rise = f.normal.z(), upright = e.dot(f.normal);
  Vec3 flat = e - upright * f.normal;
  const double length = flat.norm();
  flat = length > 0.0 ? Vec3(flat / length) : Vec3::Zero();
  const double slope = e.z() - rise * upright;
  double low = -half_length_, high = half_length_;
  double z = slope > 0.0 ? high : low;
  if (std::abs(rise) > 1e-12) {
    const double best = std::copysign(1.0, rise) * radius_ * slope /
                        std::max(1e-300, std::hypot(slope, length * rise));
    const double p = (-radius_ - f.height) / rise, q = (radius_ - f.height) / rise;
    low = std::max(low, std::min(p, q));
    high = std::min(high, std::max(p, q));
    within = low <= high;
    if (!within) return 0.0;
    z = std::clamp((best - f.height) / rise, low, high);
  }
  const double height = rise * z + f.height;
  const double disc = (radius_ - height) * (radius_ + height);
  within = disc >= 0.0;
  if (!within) return 0.0;
  const Vec3 x = Vec3(0.0, 0.0, z) - height * f.normal + std::sqrt(disc) * flat;
  within = is_behind(1 - face, x);
  return e.dot(x);
}

double CapsuleAtEdge::reach(const Vec3& e) const {
  const Vec3 farthest = radius_ * e + Vec3(0.0, 0.0, std::copysign(half_length_, e.z()));
  if (is_behind(0, farthest) && is_behind(1, farthest)) return e.dot(farthest);
  const double along = e.dot(X_AE_.rotation.col(2));
  double most = e.dot(X_AE_.translation) + half_edge_ * std::abs(along);
  for (int face = 0; face < 2; ++face) {
    bool within = false;
    const double here = reach_in_face(e, face, within);
    if (within) most = std::max(most, here);
  }
  return most;
}

// The part of a round end: a circle, from where it is beyond the end of the cylinder to where the
// edge cuts it.
void CapsuleAtEdge::add_cap(const View& v, int end, Section& s) const {
  const double z = end * half_length_;
  const double x = v.rho + z * v.axis_rho, y = v.y + z * v.axis_y;
  const double across = v.across + z * v.axis_across;
  const double disc = (radius_ - across) * (radius_ + across);
  if (!(disc > 0.0)) return;
  const double r = std::sqrt(disc), on_edge = disc - x * x;
  double edge = kPi;  // half the angle of what is on this side of the edge
  if (on_edge > 0.0) {
    edge = std::atan2(std::sqrt(on_edge), -x);
  } else if (!(x > 0.0)) {
    return;
  }
  const auto add = [&](double from, double to) {
    if (!(to > from)) return;
    const int parts = to - from > 5.0 ? 2 : 1;
    const double half = 0.5 * (to - from) / parts;
    for (int i = 0; i < parts; ++i) {
      const double middle = from + (2 * i + 1) * half;
      const double cosine = std::cos(middle), sine = std::sin(middle);
      for (const GaussNode& node : rule_for(2.0 * half)) {
        const double c = std::cos(half * node.x), si = std::sin(half * node.x);
        for (const double side : {-1.0, 1.0}) {
          const double cos_t = cosine * c - side * sine * si;
          const double sin_t = sine * c + side * cosine * si;
          const double weight = half * node.weight, rho = x + r * cos_t;
          s.add(rho, y + r * sin_t, weight * r * cos_t);
          s.surface += weight * radius_ * rho;
          s.flux -= weight * across * rho;
          s.rho_flux -= weight * across * rho * rho;
        }
      }
    }
  };
  if (!(half_length_ > 0.0)) return add(-edge, edge);
  const double rim = square(radius_ * v.lean) - square(across), beyond = end * across * v.axis_across;
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

// One of the two parts of the cylinder's outline, from one end to the other but for what is beyond
// the edge: by z, or by the angle of which the distance across is the sine.
void CapsuleAtEdge::add_side(const View& v, double side, Section& s) const {
  const double per_radius = 1.0 / (radius_ * v.lean);
  struct Place {
    double z, q;
  };
  const auto place = [&](double z) -> Place {
    const double q = (v.across + z * v.axis_across) * per_radius;
    if (std::abs(q) <= 1.0) return {z, q};
    const double tip = std::copysign(1.0, q);
    return {(tip / per_radius - v.across) / v.axis_across, tip};
  };
  const Place low = place(-half_length_), high = place(half_length_);
  if (low.q == high.q && std::abs(low.q) == 1.0) return;
  const double lean_rho = radius_ * v.axis_across * v.cosine,
               lean_y = radius_ * v.axis_across * v.sine;
  const double out_rho = side * radius_ * v.sine, out_y = -side * radius_ * v.cosine;
  const auto rho_at = [&](double z, double q, double c) {
    return v.rho + z * v.axis_rho + q * lean_rho + c * out_rho;
  };
  const auto cosine_of = [](double q) { return std::sqrt(std::max(0.0, (1.0 - q) * (1.0 + q))); };

  // Across the axis z tells nothing, along it q.
  const bool steep = std::abs(v.axis_across) > 0.7;
  const auto order = [&](const Place& p) {
    return steep ? std::copysign(1.0, v.axis_across) * p.q : p.z;
  };

  const auto add = [&](const Place& a, const Place& b) {
    if (!(order(b) > order(a))) return;
    const double dz = b.z - a.z, dq = b.q - a.q;
    if (std::abs(dq) <= 1.0 - std::max(std::abs(a.q), std::abs(b.q))) {
      const double q_m = 0.5 * (a.q + b.q), z_m = 0.5 * (a.z + b.z);
      if (!(rho_at(z_m, q_m, cosine_of(q_m)) > 0.0)) return;
      over(kGauss8, [&](double x, double w) {
        const double z = z_m + 0.5 * dz * x, q = q_m + 0.5 * dq * x, c = cosine_of(q);
        const double weight = 0.5 * w, rho = rho_at(z, q, c);
        const double y = v.y + z * v.axis_y + q * lean_y + c * out_y;
        const double dy = dz * v.axis_y + dq * (lean_y - q / c * out_y);
        s.add(rho, y, side * weight * dy);
        s.surface += weight * rho * dz / (v.lean * c);
        s.flux -= weight * rho * q * dz / c;
        s.rho_flux -= weight * rho * rho * q * dz / c;
      });
      return;
    }
    const double from = std::atan2(a.q, cosine_of(a.q)), to = std::atan2(b.q, cosine_of(b.q));
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from), rate = dz / dq;
    const double cosine = std::cos(middle), sine = std::sin(middle);
    if (!(rho_at(a.z + rate * (sine - a.q), sine, cosine) > 0.0)) return;
    for (const GaussNode& node : rule_for(2.0 * std::abs(half))) {
      const double c_x = std::cos(half * node.x), s_x = std::sin(half * node.x);
      for (const double sign : {-1.0, 1.0}) {
        const double c = cosine * c_x - sign * sine * s_x, q = sine * c_x + sign * cosine * s_x;
        const double weight = half * node.weight, z = a.z + rate * (q - a.q);
        const double rho = rho_at(z, q, c), y = v.y + z * v.axis_y + q * lean_y + c * out_y;
        s.add(rho, y, side * weight * (c * (rate * v.axis_y + lean_y) - q * out_y));
        s.surface += weight * rate * rho / v.lean;
        s.flux -= weight * rate * rho * q;
        s.rho_flux -= weight * rate * rho * rho * q;
      }
    }
  };

  // Where the edge leaves the cylinder on this side.
  std::array<Place, 4> cuts = {low};
  int count = 1;
  for (const double y : {-half_edge_, half_edge_}) {
    const double z = axis_.z() * y - axis_.dot(origin_);
    if (!steep && !(std::abs(z) < half_length_)) continue;
    const double x = -(v.rho + z * v.axis_rho), along = y - v.y - z * v.axis_y;
    if (!((x * v.sine - along * v.cosine) * side > 0.0)) continue;
    Place cut = place(z);
    if (steep) {
      cut.q = std::clamp((x * v.cosine + along * v.sine) / (radius_ * v.axis_across), -1.0, 1.0);
      cut.z = (cut.q / per_radius - v.across) / v.axis_across;
    }
    if (!(order(cut) > order(low) && order(cut) < order(high))) continue;
    cuts[static_cast<std::size_t>(count++)] = cut;
  }
  if (count == 3 && order(cuts[1]) > order(cuts[2])) std::swap(cuts[1], cuts[2]);
  cuts[static_cast<std::size_t>(count)] = high;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) add(cuts[i], cuts[i + 1]);
}

CapsuleAtEdge::View CapsuleAtEdge::view(double angle) const {
  const double c = std::cos(angle), s = std::sin(angle);
  View v;
  v.rho = c * origin_.x() + s * origin_.y();
  v.across = c * origin_.y() - s * origin_.x();
  v.y = origin_.z();
  v.axis_rho = c * axis_.x() + s * axis_.y();
  v.axis_across = c * axis_.y() - s * axis_.x();
  v.axis_y = axis_.z();
  v.lean = std::max(kLeastLean, std::sqrt(square(v.axis_rho) + square(v.axis_y)));
  const bool upright = v.lean == kLeastLean;
  v.cosine = upright ? 1.0 : v.axis_rho / v.lean;
  v.sine = upright ? 0.0 : v.axis_y / v.lean;
  return v;
}

CapsuleAtEdge::Section CapsuleAtEdge::section(double angle) const {
  const View v = view(angle);
  Section result;
  add_cap(v, 1, result);
  if (half_length_ > 0.0) {
    add_cap(v, -1, result);
    add_side(v, 1.0, result);
    add_side(v, -1.0, result);
  }
  result.finish();
  return result;
}

// Where a half-plane touches the rim of an end of the cylinder, where the normal is, and the faces.
CapsuleAtEdge::Breaks CapsuleAtEdge::breaks(double normal_angle) const {
  Breaks b;
  const auto add = [&](double angle, int end) {
    b.at[static_cast<std::size_t>(b.count++)] = {angle, end};
  };
  add(0.0, 0);
  add(normal_angle, 0);
  if (half_length_ > 0.0) {
    for (const int end : {-1, 1}) {
      // (N . p)^2 = R^2 (1 - N_z^2) for the normal N = (-sin, cos) of the half-plane.
      const Vec3 p = origin_ + end * half_length_ * axis_;
      const double r2 = radius_ * radius_;
      const double xx = square(p.x()) + r2 * (square(axis_.x()) - 1.0);
      const double yy = square(p.y()) + r2 * (square(axis_.y()) - 1.0);
      const double xy = p.x() * p.y() + r2 * axis_.x() * axis_.y();
      // (xx + yy) / 2 + (yy - xx) / 2 cos(2 angle) - xy sin(2 angle) = 0
      const double c = 0.5 * (yy - xx), size = std::hypot(c, xy), cosine = -0.5 * (xx + yy) / size;
      if (!(std::abs(cosine) < 1.0)) continue;
      const double middle = 0.5 * std::atan2(-xy, c), half = 0.5 * std::acos(cosine);
      for (double angle : {middle - half, middle + half}) {
        angle -= kPi * std::floor(angle / kPi);
        if (!(angle > 0.0 && angle < opening_)) continue;
        const View v = view(angle);
        const double across = v.across + end * half_length_ * v.axis_across;
        const double rho = v.rho + end * half_length_ * v.axis_rho +
                           across * v.axis_across * v.axis_rho / square(v.lean);
        if (rho > 0.0) add(angle, end);
      }
    }
  }
  std::sort(b.at.begin(), b.at.begin() + b.count,
            [](const Breaks::Break& x, const Breaks::Break& y) { return x.angle < y.angle; });
  add(opening_, 0);
  return b;
}

// A way from an angle to the next break: where sections change fast the steps are small. That is
// about a half-plane `flat` along the surface, and next to one that touches a rim.
struct CapsuleAtEdge::Way {
  double flat, scale;
  double from, to;         // of the measure along the way
  bool at_from, at_to;     // a rim is touched there from within

  double length() const { return to - from; }
};

CapsuleAtEdge::Way CapsuleAtEdge::way(const Breaks& b, int i) const {
  const Breaks::Break &first = b.at[static_cast<std::size_t>(i)],
                      &last = b.at[static_cast<std::size_t>(i + 1)];
  const double middle = 0.5 * (first.angle + last.angle);
  const auto about = [&](double flat, double scale) -> Way {
    flat += kPi * std::round((middle - flat) / kPi);
    return {flat, scale, std::asinh((first.angle - flat) / scale),
            std::asinh((last.angle - flat) / scale), false, false};
  };
  Way w = about(flat_angle_, flat_scale_);
  if (half_length_ > 0.0) {
    // Along the axis.
    const double along = std::atan2(axis_.y(), axis_.x());
    double scale = 1.0;
    for (int k = 0; k < b.count; ++k) {
      const Breaks::Break& other = b.at[static_cast<std::size_t>(k)];
      if (other.end == 0) continue;
      const double from = other.angle - along;
      scale = std::min(scale, std::abs(from - kPi * std::round(from / kPi)));
    }
    const Way other = about(along, std::max(scale, 1e-9));
    if (other.length() > w.length()) w = other;
    const View v = view(middle);
    const auto meets = [&](int end) {
      return end != 0 && std::abs(v.across + end * half_length_ * v.axis_across) < radius_ * v.lean;
    };
    w.at_from = meets(first.end);
    w.at_to = meets(last.end);
  }
  return w;
}

// The rule on a piece of a way.
void CapsuleAtEdge::add_piece(const Way& w, double normal_angle, Sums& sum) const {
  const double length = w.length();
  over(kGauss8, [&](double x, double weight) {
    double t = 0.5 + 0.5 * x, rate = 0.5 * weight * length;
    if (w.at_from) {
      rate *= 3.0 * t * t;
      t = t * t * t;
    } else if (w.at_to) {
      t = 1.0 - t;
      rate *= 3.0 * t * t;
      t = 1.0 - t * t * t;
    }
    const double grown = std::exp(w.from + t * length), shrunk = 1.0 / grown;
    const double angle = w.flat + w.scale * 0.5 * (grown - shrunk);
    const double column = angle < normal_angle
                              ? std::sin(angle) / std::sin(normal_angle)
                              : std::sin(opening_ - angle) / std::sin(opening_ - normal_angle);
    sum.add(section(angle), rate * w.scale * 0.5 * (grown + shrunk), std::cos(angle),
            std::sin(angle), column);
  });
}

CapsuleAtEdge::Sums CapsuleAtEdge::sums(double normal_angle, const Scale* scale) const {
  Sums sum;
  const Breaks b = breaks(normal_angle);
  for (int i = 0; i + 1 < b.count; ++i) {
    const Way whole = way(b, i);
    if (!(whole.length() > 0.0)) continue;
    const int least = whole.at_from && whole.at_to ? 2 : 1;
    const double longest = whole.at_from || whole.at_to ? kLongestToRim : kLongest;
    const int parts = std::max(least, static_cast<int>(std::ceil(whole.length() / longest)));
    for (int part = 0; part < parts; ++part) {
      Way w = whole;
      w.from = whole.from + whole.length() * part / parts;
      w.to = whole.from + whole.length() * (part + 1) / parts;
      w.at_from = whole.at_from && part == 0;
      w.at_to = whole.at_to && part == parts - 1;
      add_closed(w, normal_angle, scale, kMostHalvings, sum);
    }
  }
  return sum;
}

// How far the surface between two half-planes is from closed: what flows through them along the
// angle flows through the surface as well, be it as fast everywhere or ever faster away from the
// edge.
double CapsuleAtEdge::gap(const Sums& sum, const Section& from, const Section& to,
                          const Scale& scale) {
  return std::max(std::abs(sum.flux + to.area - from.area) / scale.area,
                  std::abs(sum.rho_flux + to.rho - from.rho) / scale.rho);
}

// The same, halved until its surface is closed.
void CapsuleAtEdge::add_closed(const Way& w, double normal_angle, const Scale* scale, int halvings,
                               Sums& sum) const {
  if (!scale || halvings == 0) return add_piece(w, normal_angle, sum);
  Sums here;
  add_piece(w, normal_angle, here);
  const double from = w.flat + w.scale * std::sinh(w.from), to = w.flat + w.scale * std::sinh(w.to);
  if (gap(here, section(from), section(to), *scale) < kOpen) {
    sum += here;
    return;
  }
  Way low = w, high = w;
  low.to = high.from = 0.5 * (w.from + w.to);
  low.at_to = high.at_from = false;
  add_closed(low, normal_angle, scale, halvings - 1, sum);
  add_closed(high, normal_angle, scale, halvings - 1, sum);
}

VolumeMetrics CapsuleAtEdge::metrics() const {
  VolumeMetrics none;
  const Section in_first = section(0.0), in_second = section(opening_);
  const Vec3 n(0.0, -1.0, 0.0), m(-std::sin(opening_), std::cos(opening_), 0.0);
  const double a = in_first.area, b = in_second.area;
  MomentSum moments;
  moments.counter_area = a + b;
  moments.area_vector = -(a * n + b * m);
  const double push = moments.area_vector.norm();
  if (!(a > 0.0 && b > 0.0 && push > 0.0)) return none;
  const Vec3 along(std::cos(opening_), std::sin(opening_), 0.0);
  moments.area_moment = -Vec3(in_first.rho, 0.0, in_first.area_y).cross(n) -
                        (in_second.rho * along + Vec3(0.0, 0.0, in_second.area_y)).cross(m);
  // The way down from the edge against the normal.
  const double normal_angle = std::atan2(moments.area_vector.y(), moments.area_vector.x());
  if (!(normal_angle > 0.0 && normal_angle < opening_)) return none;

  Sums sum = sums(normal_angle, nullptr);
  const Scale scale{moments.counter_area, sum.most};
  double open = gap(sum, in_first, in_second, scale);
  if (!(open < kOpen)) {
    sum = sums(normal_angle, &scale);
    open = gap(sum, in_first, in_second, scale);
  }
  if (!(open < kMostOpen)) return none;
  moments.volume = sum.volume;
  moments.first = sum.first;
  const double* x = sum.second;
  moments.second = {x[0], x[1], x[3], x[1], x[2], x[4], x[3], x[4], x[5]};
  moments.area = sum.surface;
  VolumeMetrics result = transformed(moments.metrics(), X_AE_);
  const Vec3 down = moments.area_vector / push;
  const Vec3 down_A = X_AE_.rotation * down;
  result.depth = reach(down_A) - down_A.dot(X_AE_.translation);
  result.depth_moment = sum.depth_moment;
  constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();
  result.volume_error =
      kRounding * (16.0 * result.volume + (result.area + result.counter_area) *
                                              (radius_ + half_length_ + X_AE_.translation.norm())) +
      (4.0 * open + kRule) * result.volume;
  return result;
}

}  // namespace volcontact
