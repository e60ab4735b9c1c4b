// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/torus_pair/circle_arcs.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "volcontact/base/simd.h"
#include "volcontact/pair/quadrature/small_turn.h"

namespace volcontact {
namespace {

constexpr int kSteps = 32, kFineSteps = 64;  // places looked at
constexpr int kMinimaSteps = 96;             // the same in search of all minima
constexpr double kOffset = 0.3137;           // of a step: no symmetric pose has places on its axes
constexpr double kOnSurface = 1e-14;         // values this small are zero, per sizes
constexpr double kMayCross = 0.5;      // an extremum that comes this near to zero is looked for
constexpr double kSharp = 1e-14;       // of an angle [rad]
constexpr double kSquareSharp = 1e-6;  // of a bracket: the next step squares what is left
constexpr double kNearEnd = 1e-3;      // of a bracket: no closer to its ends
constexpr int kMostSteps = 40;         // in search of one
constexpr double kRoughValue = 1e-3, kSharpValue = 1e-9;  // of an extremum, relative
constexpr double kLeast = std::numeric_limits<double>::min();

struct CircleFrame {
  double center[3], u[3], v[3];
};

template <int N>
struct Turns {
  alignas(64) double cos[N], sin[N];
  Turns() {
    for (int i = 0; i < N; ++i) {
      cos[i] = std::cos(2.0 * kPi * (i + kOffset) / N);
      sin[i] = std::sin(2.0 * kPi * (i + kOffset) / N);
    }
  }
};

}  // namespace
}  // namespace volcontact

#define VOLCONTACT_SIMD_KERNEL "volcontact/pair/torus_pair/circle_arcs_kernel.inc"
#include "volcontact/base/simd_paths.inc"

namespace volcontact {
namespace {

class ArcFinder {
 public:
  ArcFinder(const Circle& circle, const TorusSize& ring, ArcSearch search, CircleArcs& arcs)
      : ring_(ring), search_(search), arcs_(arcs) {
    for (int i = 0; i < 3; ++i) {
      frame_.center[i] = circle.center[i];
      frame_.u[i] = circle.radius * circle.u[i];
      frame_.v[i] = circle.radius * circle.v[i];
    }
    const double size = circle.center.norm() + circle.radius + ring.major;
    zero_ = kOnSurface * (ring.minor + kOnSurface * size) * size;
  }

  template <int N>
  void run(SimdPath path) {
    arcs_.count = arcs_.minima = 0;
    arcs_.whole = false;
    static const Turns<N> turns;
    alignas(64) double value[N], slope[N];
    VOLCONTACT_SIMD_CALL(path, look, frame_, ring_.major, ring_.minor, turns.cos, turns.sin, N,
                         value, slope);
    const auto place = [&](int i) -> Place {
      return {2.0 * kPi * (i + kOffset) / N, value[i], slope[i], turns.cos[i], turns.sin[i]};
    };
    int first = -1, last = -1;
    for (int i = 0; i < N; ++i) {
      if (std::abs(value[i]) <= zero_) continue;
      if (first < 0) {
        first = i;
      } else if (worth_a_step(value[last], slope[last], value[i], slope[i])) {
        step(place(last), place(i), search_ == ArcSearch::kWithMinima);
      }
      last = i;
    }
    if (first < 0) return;
    Place next = place(first);
    next.angle += 2.0 * kPi;
    step(place(last), next, search_ == ArcSearch::kWithMinima);
    close(value[first] < 0.0);
  }

 private:
  struct Place {
    double angle, value, slope;
    double cos, sin;  // of the angle
  };

  // A crossing, or slopes of two signs.
  static bool worth_a_step(double value, double slope, double next_value, double next_slope) {
    return (value < 0.0) != (next_value < 0.0) || !(slope * next_slope > 0.0);
  }

  void evaluate(double c, double s, double& value, double& slope) const {
    const CircleFrame& f = frame_;
    const double x = f.center[0] + c * f.u[0] + s * f.v[0],
                 y = f.center[1] + c * f.u[1] + s * f.v[1],
                 z = f.center[2] + c * f.u[2] + s * f.v[2];
    const double dx = c * f.v[0] - s * f.u[0], dy = c * f.v[1] - s * f.u[1],
                 dz = c * f.v[2] - s * f.u[2];
    const double rho = std::max(std::sqrt(x * x + y * y), kLeast), across = rho - ring_.major;
    value = across * across + (z - ring_.minor) * (z + ring_.minor);
    slope = 2.0 * (across / rho * (x * dx + y * dy) + z * dz);
  }
  // At a small way from a place.
  Place at(const Place& from, double way) const {
    const SmallTurn turn = std::abs(way) < kSmallTurn ? SmallTurn(way) : SmallTurn::any(way);
    Place place{from.angle + way, 0.0, 0.0, turn.cos * from.cos - turn.sin * from.sin,
                turn.cos * from.sin + turn.sin * from.cos};
    evaluate(place.cos, place.sin, place.value, place.slope);
    return place;
  }

  // From one place to the next: a crossing, or a dip that may reach through the surface.
  void step(const Place& a, const Place& b, bool minima) {
    const bool dip = a.slope < 0.0 && b.slope >= 0.0;
    if ((a.value < 0.0) != (b.value < 0.0)) {
      cross(a, b, (b.angle - a.angle) * first_guess(a, b));
      if (minima && dip) note_minimum(turning(a, b, kSharpValue));
      return;
    }
    const bool inside = a.value < 0.0;
    if (inside && minima && dip) note_minimum(turning(a, b, kSharpValue));
    const bool toward = inside ? a.slope > 0.0 && b.slope <= 0.0 : dip;
    if (!toward || !may_cross(a, b)) return;
    const Place m = turning(a, b, minima ? kSharpValue : kRoughValue);
    if (inside ? m.value <= zero_ : m.value >= -zero_) return;
    const double bend = (b.slope - a.slope) / (b.angle - a.angle);
    cross(a, m, m.angle - a.angle - half_width(m, bend));
    cross(m, b, half_width(m, bend));
    if (minima && !inside) note_minimum(m);
  }

  // The cubic with the values and slopes of both ends, at its turning point by their slopes.
  static bool may_cross(const Place& a, const Place& b) {
    const double width = b.angle - a.angle, t = a.slope / (a.slope - b.slope), r = 1.0 - t;
    const double there = r * r * (1.0 + 2.0 * t) * a.value + t * t * (1.0 + 2.0 * r) * b.value +
                         width * t * r * (r * a.slope - t * b.slope);
    const double nearer = std::abs(a.value) < std::abs(b.value) ? a.value : b.value;
    return nearer > 0.0 ? there < kMayCross * nearer : there > kMayCross * nearer;
  }

  // Where the slope, of different signs at both ends, vanishes: at the turning point of the cubic
  // with their values and slopes.
  Place turning(Place a, Place b, double sharp) const {
    Place m = b;
    if (b.slope == 0.0) return m;
    const double sign = a.slope < 0.0 ? 1.0 : -1.0;
    for (int i = 0; i < kMostSteps; ++i) {
      const double width = b.angle - a.angle;
      if (!(width > kSharp)) break;
      const double d0 = sign * width * a.slope, d1 = sign * width * b.slope;
      const double c = 3.0 * sign * (a.value - b.value) + d0 + d1, g = std::sqrt(c * c - d0 * d1);
      const double t = i % 4 == 3 ? 0.5 : 1.0 - (d1 + g - c) / (d1 - d0 + 2.0 * g);
      m = at(a, std::clamp(t, kNearEnd, 1.0 - kNearEnd) * width);
      if (m.slope == 0.0) break;
      const double near = std::abs(m.slope) * std::min(m.angle - a.angle, b.angle - m.angle);
      ((m.slope < 0.0) == (a.slope < 0.0) ? a : b) = m;
      if (near < sharp * std::abs(m.value) || near < 0.1 * zero_) break;
    }
    return m;
  }

  void note_minimum(const Place& m) {
    if (arcs_.minima < CircleArcs::kMost) arcs_.nearest[arcs_.minima++] = m.angle;
  }

  // Where the cubic with the values and slopes of both ends vanishes, as a share of the way.
  static double first_guess(const Place& a, const Place& b) {
    const double width = b.angle - a.angle, f0 = a.value, f1 = b.value, d0 = width * a.slope,
                 d1 = width * b.slope;
    const double c2 = 3.0 * (f1 - f0) - 2.0 * d0 - d1, c3 = 2.0 * (f0 - f1) + d0 + d1;
    double t = f0 / (f0 - f1);
    for (int i = 0; i < 2; ++i) {
      const double f = f0 + t * (d0 + t * (c2 + t * c3)), d = d0 + t * (2.0 * c2 + 3.0 * t * c3);
      const double next = t - f / d;
      if (!(next > 0.0 && next < 1.0)) break;
      t = next;
    }
    return t;
  }

  // How far from an extremum the values change sign.
  static double half_width(const Place& m, double bend) { return std::sqrt(-2.0 * m.value / bend); }

  // Newton's method, kept between both ends.
  void cross(const Place& a, const Place& b, double way) {
    if (crossings_ == 2 * CircleArcs::kMost) return;
    if (search_ == ArcSearch::kCount) {
      ++crossings_;
      return;
    }
    double from = 0.0, to = b.angle - a.angle;
    const bool rising = a.value < 0.0;
    const double width = to;
    if (!(way > 0.0 && way < width)) way = 0.5 * width;
    for (int i = 0; i < kMostSteps; ++i) {
      const Place x = at(a, way);
      ((x.value < 0.0) == rising ? from : to) = way;
      double next = way - x.value / x.slope;
      if (!(next > from && next < to)) next = 0.5 * (from + to);
      const double step = std::abs(next - way);
      way = next;
      if (step < kSquareSharp * width || to - from < kSharp) break;
    }
    crossing_[crossings_++] = a.angle + way;
  }

  // Pairs the crossings. They alternate between going in and out.
  void close(bool begins_inside) {
    if (crossings_ == 0) {
      arcs_.whole = begins_inside;
      return;
    }
    if (search_ == ArcSearch::kCount) {
      arcs_.count = crossings_ / 2;
      return;
    }
    const int first = begins_inside ? 1 : 0;
    arcs_.count = crossings_ / 2;
    for (int i = 0; i < arcs_.count; ++i) {
      const int in = first + 2 * i, out = in + 1;
      double low = crossing_[in % crossings_], high = crossing_[out % crossings_];
      if (low >= 2.0 * kPi) {
        low -= 2.0 * kPi;
        high -= 2.0 * kPi;
      }
      if (high < low) high += 2.0 * kPi;
      arcs_.low[i] = low;
      arcs_.high[i] = high;
    }
  }

  const TorusSize& ring_;
  const ArcSearch search_;
  CircleArcs& arcs_;
  CircleFrame frame_;
  double zero_;
  double crossing_[2 * CircleArcs::kMost];
  int crossings_ = 0;
};

}  // namespace

void find_arcs(const Circle& circle, const TorusSize& ring, ArcSearch search, bool fine,
               CircleArcs& arcs) {
  ArcFinder finder(circle, ring, search, arcs);
  static const SimdPath path = best_simd_path();
  if (search == ArcSearch::kWithMinima) return finder.run<kMinimaSteps>(path);
  fine ? finder.run<kFineSteps>(path) : finder.run<kSteps>(path);
}

}  // namespace volcontact
