// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace volcontact {

/// A function and its derivative at one place of a curve.
struct CurveValue {
  double value, slope;
};

/// Where a function changes sign, in order; beyond kMost they are not counted.
struct CrossingList {
  static constexpr int kMost = 8;
  int count = 0;
  bool begins_inside = false;  ///< negative at the beginning
  double t[kMost];
};

/// Finds the sign changes of a smooth function between `low` and `high` from its values and slopes
/// at `places` even steps: two of them in a step show as slopes towards zero at its ends.
/// `periodic`: the end is the beginning, and there are as many changes one way as the other.
template <typename Function>
class CrossingFinder {
 public:
  CrossingFinder(const Function& f, CrossingList& list) : f_(f), list_(list) {}

  void run(double low, double high, int places, bool periodic) {
    list_.count = 0;
    const Place first = step_at(0, low, places);
    list_.begins_inside = first.value < 0.0;
    Place a = first;
    for (int i = 1; i <= places; ++i) {
      const double t = low + (high - low) * i / places;
      Place b =
          periodic && i == places ? Place{t, first.value, first.slope} : step_at(i, t, places);
      step(a, b);
      a = b;
    }
    if (periodic && list_.count % 2 != 0) --list_.count;
  }

 private:
  struct Place {
    double t, value, slope;
  };
  static constexpr int kMostSteps = 60;
  static constexpr double kSharp = 1e-15, kRough = 1e-6;

  Place at(double t) const {
    const CurveValue v = f_(t);
    return {t, v.value, v.slope};
  }

  // A function may know its values at the even steps of a turn.
  Place step_at(int i, double t, int places) const {
    if constexpr (requires { f_.step(i, places); }) {
      const CurveValue v = f_.step(i, places);
      return {t, v.value, v.slope};
    } else {
      return at(t);
    }
  }

  void step(const Place& a, const Place& b) {
    if ((a.value < 0.0) != (b.value < 0.0)) return cross(a, b);
    const double sign = a.value < 0.0 ? -1.0 : 1.0;  // towards zero is down then
    if (!(sign * a.slope < 0.0 && sign * b.slope > 0.0)) return;
    // Tangents at both ends are above a dip that is bent one way.
    const double width = b.t - a.t;
    if (std::abs(a.value) > 2.0 * width * std::abs(a.slope) &&
        std::abs(b.value) > 2.0 * width * std::abs(b.slope)) {
      return;
    }
    Place low = a, high = b;
    for (int i = 0; i < kMostSteps; ++i) {
      const double share = low.slope / (low.slope - high.slope);
      const double w = high.t - low.t;
      const Place m = at(low.t + std::clamp(i % 3 == 2 ? 0.5 : share, 0.01, 0.99) * w);
      if ((m.value < 0.0) != (a.value < 0.0)) {
        cross(a, m);
        return cross(m, b);
      }
      if (std::abs(m.slope) * w < kRough * std::abs(m.value) || w < kSharp * width) return;
      (sign * m.slope < 0.0 ? low : high) = m;
    }
  }

  // Newton's method, kept between both ends.
  void cross(const Place& a, const Place& b) {
    if (list_.count == CrossingList::kMost) return;
    double from = a.t, to = b.t;
    const bool rising = a.value < 0.0;
    double t = from + (to - from) * std::clamp(a.value / (a.value - b.value), 0.01, 0.99);
    for (int i = 0; i < kMostSteps; ++i) {
      const Place x = at(t);
      const double newton = t - x.value / x.slope;
      if (std::abs(newton - t) <= kSharp * (std::abs(a.t) + std::abs(b.t))) break;
      ((x.value < 0.0) == rising ? from : to) = t;
      t = newton > from && newton < to ? newton : 0.5 * (from + to);
    }
    list_.t[list_.count++] = t;
  }

  const Function& f_;
  CrossingList& list_;
};

template <typename Function>
void find_crossings(const Function& f, double low, double high, int places, bool periodic,
                    CrossingList& list) {
  CrossingFinder<Function>(f, list).run(low, high, places, periodic);
}

}  // namespace volcontact
