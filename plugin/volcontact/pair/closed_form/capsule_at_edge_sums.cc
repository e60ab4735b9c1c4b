// SPDX-License-Identifier: Apache-2.0
// The integrals of CapsuleAtEdge: half-planes that turn about the edge, from break to break.
#include "volcontact/pair/closed_form/capsule_at_edge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "volcontact/base/fields.h"
#include "volcontact/pair/quadrature/gauss.h"

namespace volcontact {
namespace {

constexpr double kBend = 2.0;          // measure of a way up to where it bends
constexpr double kLongest = 1.8;       // piece of a way there, by its measure
constexpr double kLongestToRim = 1.0;  // the same next to a rim
constexpr double kLongestAway = 5.0;   // the same beyond the bend, where sections shrink
constexpr double kShort = 0.6;         // piece for which a short rule will do
constexpr double kNearRim = 1.0;       // of the end of a way, by its measure
constexpr double kLeastScale = 1e-9;   // of angles [rad]
constexpr double kOpen = 2e-6;         // gap of the surface with which pieces are halved
constexpr int kMostHalvings = 8;
constexpr double kMostOpen = 5e-5;  // with more there is no answer
constexpr double kPerGap = 4.0;     // error of V that is claimed for a gap
constexpr double kRule = 5e-6;      // the same for the rules, more than any error that was found

}  // namespace

struct CapsuleAtEdge::Sums {
  double volume = 0.0, surface = 0.0, depth_moment = 0.0;
  double flux = 0.0, rho_flux = 0.0;
  double most = 0.0;  // int rho of a section
  Vec3 first = Vec3::Zero();
  double second[6] = {};  // xx, xy, yy, xz, yz, zz

  // A section with the weight of its angle; `length` of a column there, per distance of its lower
  // end from the edge.
  void add(const EdgeSection& s, double weight, double cosine, double sine, double length) {
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
  std::array<Break, 8> at;  // in order, from the first after 0
  int count = 0;
  Break before = {-kInfinity, 0}, after = {kInfinity, 0};  // rims next to them

  void add(double angle, int end) { at[static_cast<std::size_t>(count++)] = {angle, end}; }
};

EdgeSection CapsuleAtEdge::section(double angle) const {
  return sections_.at(std::cos(angle), std::sin(angle));
}

// Where a half-plane touches the rim of an end of the cylinder: (N . p)^2 = R^2 (1 - N_z^2) for its
// normal N = (-sin, cos).
void CapsuleAtEdge::add_touches(int end, Breaks& b) const {
  const Vec3& axis = sections_.axis;
  const double z = end * sections_.half_length, r2 = square_of(sections_.radius);
  const Vec3 p = sections_.origin + z * axis;
  const double xx = square_of(p.x()) + r2 * (square_of(axis.x()) - 1.0);
  const double yy = square_of(p.y()) + r2 * (square_of(axis.y()) - 1.0);
  const double xy = p.x() * p.y() + r2 * axis.x() * axis.y();
  // (xx + yy) / 2 + (yy - xx) / 2 cos(2 angle) - xy sin(2 angle) = 0
  const double c = 0.5 * (yy - xx), cosine = -0.5 * (xx + yy) / std::hypot(c, xy);
  if (!(std::abs(cosine) < 1.0)) return;
  const double middle = 0.5 * std::atan2(-xy, c), half = 0.5 * std::acos(cosine);
  for (double angle : {middle - half, middle + half}) {
    angle -= kPi * std::floor(angle / kPi);
    const EdgeView v = sections_.view(std::cos(angle), std::sin(angle));
    const double across = v.across + z * v.axis_across;
    const double tip = across * v.axis_across / square_of(v.lean);
    const bool is_ahead = v.rho + (z + tip) * v.axis_rho > 0.0;
    if (is_ahead && angle > 0.0 && angle < opening_) {
      b.add(angle, end);
    } else if (is_ahead && angle < b.after.angle) {
      b.after = {angle, end};
    } else if (!is_ahead && angle - kPi > b.before.angle) {
      b.before = {angle - kPi, end};
    }
  }
}

CapsuleAtEdge::Breaks CapsuleAtEdge::breaks(double normal_angle) const {
  Breaks b;
  b.add(normal_angle, 0);
  if (sections_.half_length > 0.0) {
    add_touches(-1, b);
    add_touches(1, b);
  }
  std::sort(b.at.begin(), b.at.begin() + b.count,
            [](const Breaks::Break& x, const Breaks::Break& y) { return x.angle < y.angle; });
  b.add(opening_, 0);
  return b;
}

// A way from an angle to the next break, by a measure: the angle is flat + scale sinh(measure). So
// steps are small about a half-plane `flat` along the surface, where sections change fast.
struct CapsuleAtEdge::Way {
  double flat, scale;
  double from, to;  // of the measure
  // Where a rim is touched, at the ends or next to them, by half-planes that meet it on this way.
  double low_rim = -kInfinity, high_rim = kInfinity;

  double length() const { return to - from; }
  bool is_at_rim() const { return low_rim > -kInfinity || high_rim < kInfinity; }
  double measure(double angle) const { return std::asinh((angle - flat) / scale); }
  double angle(double at) const { return flat + scale * std::sinh(at); }
  // A piece: the rims are next to its ends alone.
  Way piece(double begin, double end) const {
    return {flat,
            scale,
            begin,
            end,
            begin > from ? -kInfinity : low_rim,
            end < to ? kInfinity : high_rim};
  }
};

CapsuleAtEdge::Way CapsuleAtEdge::way_about(double flat, double scale, double from,
                                            double to) const {
  flat += kPi * std::round((0.5 * (from + to) - flat) / kPi);
  Way w{flat, scale, 0.0, 0.0};
  w.from = w.measure(from);
  w.to = w.measure(to);
  return w;
}

// From break i to the next one: about the half-plane along the surface next to the edge, or along
// the axis, whichever is the longer way.
CapsuleAtEdge::Way CapsuleAtEdge::way(const Breaks& b, int i) const {
  const Breaks::Break first = i > 0 ? b.at[static_cast<std::size_t>(i - 1)] : Breaks::Break{0.0, 0};
  const Breaks::Break last = b.at[static_cast<std::size_t>(i)];
  Way w = way_about(flat_angle_, flat_scale_, first.angle, last.angle);
  if (!(sections_.half_length > 0.0)) return w;
  const double along = std::atan2(sections_.axis.y(), sections_.axis.x());
  double scale = 1.0;
  const auto include = [&](const Breaks::Break& touch) {
    if (touch.end == 0) return;
    const double turn = (touch.angle - along) / kPi;
    scale = std::min(scale, kPi * std::abs(turn - std::round(turn)));
  };
  for (int k = 0; k < b.count; ++k) include(b.at[static_cast<std::size_t>(k)]);
  include(b.before);
  include(b.after);
  const Way other = way_about(along, std::max(scale, kLeastScale), first.angle, last.angle);
  if (other.length() > w.length()) w = other;
  const double middle = 0.5 * (first.angle + last.angle);
  const EdgeView v = sections_.view(std::cos(middle), std::sin(middle));
  const auto meets = [&](int end) {
    const double across = v.across + end * sections_.half_length * v.axis_across;
    return end != 0 && std::abs(across) < sections_.radius * v.lean;
  };
  const Breaks::Break &low = i > 0 ? first : b.before, &high = i + 1 < b.count ? last : b.after;
  if (meets(low.end)) w.low_rim = std::min(w.from, w.measure(low.angle));
  if (meets(high.end)) w.high_rim = std::max(w.to, w.measure(high.angle));
  if (w.from - w.low_rim > kNearRim) w.low_rim = -kInfinity;
  if (w.high_rim - w.to > kNearRim) w.high_rim = kInfinity;
  return w;
}

// The rule on a piece of a way. Next to a rim the third power of the rule's variable makes smooth
// what begins there like a root.
void CapsuleAtEdge::add_piece(const Way& w, double normal_angle, Sums& sum) const {
  const double to_second = opening_ - normal_angle;
  const double per_first = 1.0 / std::sin(normal_angle), per_second = 1.0 / std::sin(to_second);
  const bool low = w.low_rim > -kInfinity, high = !low && w.high_rim < kInfinity;
  const double rim = low ? w.low_rim : w.high_rim;
  const double from = low || high ? std::cbrt(w.from - rim) : w.from;
  const double range = (low || high ? std::cbrt(w.to - rim) : w.to) - from;
  const auto add = [&](double t, double weight) {
    double at = from + t * range, rate = range;
    if (low || high) {
      rate *= 3.0 * at * at;
      at = rim + at * at * at;
    }
    const double grown = std::exp(at), shrunk = 1.0 / grown;
    const double angle = w.flat + 0.5 * w.scale * (grown - shrunk);
    rate *= 0.5 * w.scale * (grown + shrunk);
    const double cosine = std::cos(angle), sine = std::sin(angle);
    const double column =
        angle < normal_angle ? sine * per_first : std::sin(opening_ - angle) * per_second;
    sum.add(sections_.at(cosine, sine), weight * rate, cosine, sine, column);
  };
  if (w.length() < kShort && !w.is_at_rim()) {
    for (int i = 0; i < 5; ++i) add(GaussRule<5>::kNodes[i], GaussRule<5>::kWeights[i]);
  } else {
    for (int i = 0; i < 8; ++i) add(GaussRule<8>::kNodes[i], GaussRule<8>::kWeights[i]);
  }
}

// A piece, halved until its surface is closed.
void CapsuleAtEdge::add_closed(const Way& w, double normal_angle, const Scale& scale, int halvings,
                               Sums& sum) const {
  Sums here;
  add_piece(w, normal_angle, here);
  const EdgeSection from = section(w.angle(w.from)), to = section(w.angle(w.to));
  if (halvings == 0 || gap(here, from, to, scale) < kOpen) {
    sum += here;
    return;
  }
  const double middle = 0.5 * (w.from + w.to);
  add_closed(w.piece(w.from, middle), normal_angle, scale, halvings - 1, sum);
  add_closed(w.piece(middle, w.to), normal_angle, scale, halvings - 1, sum);
}

// How far the surface between two half-planes is from closed: a flow about the edge that passes
// them passes the surface as well, be it as fast everywhere or faster away from the edge.
double CapsuleAtEdge::gap(const Sums& sum, const EdgeSection& from, const EdgeSection& to,
                          const Scale& scale) {
  return std::max(std::abs(sum.flux + to.area - from.area) / scale.area,
                  std::abs(sum.rho_flux + to.rho - from.rho) / scale.rho);
}

// From one face to the other; with a scale, piece by piece until they are closed.
CapsuleAtEdge::Sums CapsuleAtEdge::sums(double normal_angle, const Scale* scale) const {
  Sums sum;
  const Breaks b = breaks(normal_angle);
  for (int i = 0; i < b.count; ++i) {
    const Way whole = way(b, i);
    if (!(whole.length() > 0.0)) continue;
    double from = whole.from;
    for (const double bend : {-kBend, kBend, whole.to}) {
      const double to = std::min(bend, whole.to);
      if (!(to > from)) continue;
      const Way w = whole.piece(from, to);
      const double middle = 0.5 * (from + to);
      const bool is_away = std::abs(middle) > kBend && std::cos(w.angle(middle) - out_angle_) > 0.0;
      const double longest = w.is_at_rim() ? kLongestToRim : is_away ? kLongestAway : kLongest;
      const int least = w.low_rim > -kInfinity && w.high_rim < kInfinity ? 2 : 1;
      const int parts = std::max(least, static_cast<int>(std::ceil(w.length() / longest)));
      for (int part = 0; part < parts; ++part) {
        const double end = part + 1 < parts ? from + w.length() * (part + 1) / parts : to;
        const Way piece = w.piece(from + w.length() * part / parts, end);
        if (scale) {
          add_closed(piece, normal_angle, *scale, kMostHalvings, sum);
        } else {
          add_piece(piece, normal_angle, sum);
        }
      }
      from = to;
    }
  }
  return sum;
}

VolumeMetrics CapsuleAtEdge::metrics() const {
  const EdgeSection in_first = section(0.0), in_second = section(opening_);
  const double a = in_first.area, b = in_second.area;
  const Vec3 along(std::cos(opening_), std::sin(opening_), 0.0);  // the second face
  const Vec3 n(0.0, -1.0, 0.0), m(-along.y(), along.x(), 0.0);
  MomentSum moments;
  moments.counter_area = a + b;
  moments.area_vector = -(a * n + b * m);
  moments.area_moment = -Vec3(in_first.rho, 0.0, in_first.area_y).cross(n) -
                        (in_second.rho * along + Vec3(0.0, 0.0, in_second.area_y)).cross(m);
  const double push = moments.area_vector.norm();
  if (!(a > 0.0 && b > 0.0 && push > 0.0)) return {};
  // From the edge against the normal.
  const double normal_angle = std::atan2(moments.area_vector.y(), moments.area_vector.x());
  if (!(normal_angle > 0.0 && normal_angle < opening_)) return {};

  Sums sum = sums(normal_angle, nullptr);
  const Scale scale{moments.counter_area, sum.most};
  double open = gap(sum, in_first, in_second, scale);
  if (!(open < kOpen)) {
    sum = sums(normal_angle, &scale);
    open = gap(sum, in_first, in_second, scale);
  }
  if (!(open < kMostOpen)) return {};
  moments.volume = sum.volume;
  moments.first = sum.first;
  const double* x = sum.second;
  moments.second = {x[0], x[1], x[3], x[1], x[2], x[4], x[3], x[4], x[5]};
  moments.area = sum.surface;
  VolumeMetrics result = transformed(moments.metrics(), X_AE_);
  const Vec3 down = X_AE_.rotation * (moments.area_vector / push);
  result.depth = reach(down) - down.dot(X_AE_.translation);
  result.depth_moment = sum.depth_moment;
  constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();
  const double size = sections_.radius + sections_.half_length + X_AE_.translation.norm();
  result.volume_error = (16.0 * kRounding + kPerGap * open + kRule) * result.volume +
                        kRounding * (result.area + result.counter_area) * size;
  return result;
}

}  // namespace volcontact
