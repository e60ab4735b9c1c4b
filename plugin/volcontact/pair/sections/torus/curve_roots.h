// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <utility>

namespace volcontact {

/// Whether a curve ends where it began.
enum class CurveEnds { kOpen, kClosed };

/// Which roots close to each other are looked for: those about places where the function is
/// positive, or about negative ones too.
enum class CloseRoots { kAll, kAboutPositive };

namespace curve_roots {

constexpr int kPlaces = 12;  // tried on a curve
constexpr int kRootSteps = 8;
constexpr int kWideRootSteps = 16;  // between places that are far apart
constexpr int kDipSteps = 16;       // of the search for two roots between two places
constexpr double kDipMargin = 0.2;  // of the bend, that a dip may go lower than it looks

// Whether the middle one of three values of one sign is nearest to zero, and a parabola through
// them comes near zero or beyond.
inline bool dips(const double* y) {
  const double before = std::abs(y[-1]), here = std::abs(y[0]), after = std::abs(y[1]);
  if ((y[-1] > 0.0) != (y[0] > 0.0) || (y[0] > 0.0) != (y[1] > 0.0)) return false;
  if (!(here <= before && here <= after)) return false;
  const double bend = before - 2.0 * here + after, slope = 0.5 * (after - before);
  return here * bend < 0.5 * slope * slope + kDipMargin * bend * bend;
}

// By golden section; the first place found below zero will do.
template <typename Function>
double lowest(Function&& f, double x0, double x3) {
  constexpr double kGolden = 0.6180339887498949;
  double x1 = x3 - kGolden * (x3 - x0), x2 = x0 + kGolden * (x3 - x0), f1 = f(x1), f2 = f(x2);
  for (int step = 0; step < kDipSteps && f1 >= 0.0 && f2 >= 0.0; ++step) {
    if (f1 < f2) {
      x3 = x2;
      x2 = std::exchange(x1, x2 - kGolden * (x2 - x0));
      f2 = std::exchange(f1, f(x1));
    } else {
      x0 = x1;
      x1 = std::exchange(x2, x1 + kGolden * (x3 - x1));
      f1 = std::exchange(f2, f(x2));
    }
  }
  return f1 < f2 ? x1 : x2;
}

template <typename Function>
double root_between(Function&& f, double a, double fa, double b, double fb,
                    int steps = kRootSteps) {
  for (int step = 0; step < steps && fb != fa; ++step) {
    const double x = b - fb * (b - a) / (fb - fa), fx = f(x);
    if ((fx > 0.0) != (fb > 0.0)) {
      a = b;
      fa = fb;
    } else {
      fa *= 0.5;
    }
    b = x;
    fb = fx;
    if (fx == 0.0) break;
  }
  return b;
}

}  // namespace curve_roots

/// Calls use(t) at the roots of f(t) between two values, in any order: between places that are not
/// far apart, by bracketed false position; two close to each other from the place between them
/// where the function is nearest to zero. A closed curve ends where it began, at the same value: a
/// root there is then seen, whatever its rounding.
template <typename Function, typename Use>
void each_root(Function&& f, double from, double to, CurveEnds ends, Use&& use,
               CloseRoots close = CloseRoots::kAll) {
  using namespace curve_roots;
  double x[kPlaces + 2], y[kPlaces + 2];
  for (int i = 0; i <= kPlaces; ++i) {
    x[i] = from + (to - from) * i / kPlaces;
    y[i] = i == kPlaces && ends == CurveEnds::kClosed ? y[0] : f(x[i]);
  }
  int last = kPlaces;
  if (ends == CurveEnds::kClosed) {
    x[++last] = to + (to - from) / kPlaces;
    y[last] = y[1];
  }
  for (int i = 0; i < kPlaces; ++i) {
    if ((y[i] > 0.0) != (y[i + 1] > 0.0)) use(root_between(f, x[i], y[i], x[i + 1], y[i + 1]));
  }
  for (int i = 1; i < last; ++i) {
    if (y[i] > 0.0 && close == CloseRoots::kAboutPositive) continue;
    if (!dips(y + i)) continue;
    const double sign = y[i] > 0.0 ? 1.0 : -1.0;
    const double at = lowest([&](double t) { return sign * f(t); }, x[i - 1], x[i + 1]);
    const double value = f(at);
    if ((value > 0.0) == (y[i] > 0.0)) continue;
    use(root_between(f, x[i - 1], y[i - 1], at, value, kWideRootSteps));
    use(root_between(f, at, value, x[i + 1], y[i + 1], kWideRootSteps));
  }
}

}  // namespace volcontact
