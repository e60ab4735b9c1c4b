// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/torus_pair/torus_events.h"

#include <algorithm>
#include <cmath>

namespace volcontact {
namespace {

constexpr int kMostHalvings = 40;
constexpr double kSharp = 1e-9;      // of a range, and at least:
constexpr double kSharpest = 1e-14;  // [rad]
constexpr int kMostCircles = 400;
constexpr int kNewtonSteps = 8;
constexpr double kBeside = 1e-5;  // of a range: there the change must be seen

class EventSearch {
 public:
  EventSearch(const TorusSize& ring, const Pose& X, const TorusSize& other, bool fine,
              std::vector<double>& events)
      : ring_(ring), X_(X), other_(other), fine_(fine), events_(events) {}

  using Sample = TorusPatchScratch::Sample;

  void between(const Sample& a, const Sample& b, int halvings) {
    if (a.count == b.count) return;
    const double width = b.angle - a.angle;
    if (halvings == 0) scale_ = width;
    if (halvings >= kMostHalvings || spent_ >= kMostCircles ||
        width < std::max(kSharp * scale_, kSharpest)) {
      events_.push_back(0.5 * (a.angle + b.angle));
      return;
    }
    double angle;
    if (one_apart(a.count, b.count) && touch(a, b, angle)) {
      events_.push_back(angle);
      return;
    }
    ++spent_;
    const double middle = 0.5 * (a.angle + b.angle);
    const Sample m{middle, arc_count(arcs_at(middle))};
    between(a, m, halvings + 1);
    between(m, b, halvings + 1);
  }

 private:
  // A whole circle and one with one gap are neighbours as well.
  static bool one_apart(int a, int b) {
    if (a == kWholeCircle || b == kWholeCircle) return a + b == 0;
    return std::abs(a - b) == 1;
  }

  CircleArcs arcs_at(double angle, ArcSearch search = ArcSearch::kCount) const {
    CircleArcs arcs;
    find_arcs(section_circle(ring_, X_, angle), other_, search, fine_, arcs);
    return arcs;
  }

  // Newton's method for a circle that touches the surface, from the narrowest arc or gap.
  bool touch(const Sample& a, const Sample& b, double& angle) const {
    const bool from_a = a.count > std::max(b.count, 0);
    const Sample& start = from_a ? a : b;
    const CircleArcs arcs = arcs_at(start.angle, ArcSearch::kArcs);
    double at = 0.0, least = kInfinity;
    const bool opens = std::min(a.count, b.count) == kWholeCircle;
    for (int i = 0; i < arcs.count; ++i) {
      const double next =
          i + 1 < arcs.count ? arcs.low[i + 1] : arcs.low[0] + (arcs.count ? 2.0 * kPi : 0.0);
      const double wide = arcs.high[i] - arcs.low[i];
      double gap = next - arcs.high[i];
      if (gap < 0.0) gap += 2.0 * kPi;
      if (!opens && wide < least) {
        least = wide;
        at = 0.5 * (arcs.low[i] + arcs.high[i]);
      }
      if ((opens || arcs.count > 1) && gap < least) {
        least = gap;
        at = arcs.high[i] + 0.5 * gap;
      }
    }
    if (!(least < kInfinity)) return false;
    angle = start.angle;
    if (!solve(a.angle, b.angle, angle, at)) return false;
    const double side = kBeside * (b.angle - a.angle);
    return angle - side > a.angle && angle + side < b.angle &&
           arc_count(arcs_at(angle - side)) == a.count &&
           arc_count(arcs_at(angle + side)) == b.count;
  }

  // For g = 0 and dg/dt = 0, t the angle on the section circle.
  bool solve(double from, double to, double& angle, double& t) const {
    const double width = to - from;
    for (int i = 0; i < kNewtonSteps; ++i) {
      const double c = std::cos(t), s = std::sin(t);
      const Circle circle = section_circle(ring_, X_, angle);
      const Vec3 side = circle.v.cross(circle.u);  // d u / d angle
      const double rho = ring_.major + ring_.minor * c;
      const Vec3 x = circle.center + ring_.minor * (c * circle.u + s * circle.v);
      const Vec3 x_t = ring_.minor * (c * circle.v - s * circle.u), x_a = rho * side;
      const Vec3 x_tt = -ring_.minor * (c * circle.u + s * circle.v),
                 x_ta = -ring_.minor * s * side;
      const double to_axis = std::sqrt(x.x() * x.x() + x.y() * x.y());
      if (!(to_axis > 0.0)) return false;
      const double share = 1.0 - other_.major / to_axis,
                   bend = other_.major / (to_axis * to_axis * to_axis);
      const Vec3 gradient(share * x.x(), share * x.y(), x.z());  // half of it
      const auto bent = [&](const Vec3& w) -> Vec3 {
        const double along = bend * (w.x() * x.x() + w.y() * x.y());
        return {share * w.x() + along * x.x(), share * w.y() + along * x.y(), w.z()};
      };
      const double g = 0.5 * torus_value(other_, x);
      const double g_t = gradient.dot(x_t), g_a = gradient.dot(x_a);
      const Vec3 bent_t = bent(x_t);
      const double g_tt = x_t.dot(bent_t) + gradient.dot(x_tt),
                   g_ta = x_a.dot(bent_t) + gradient.dot(x_ta);
      const double det = g_a * g_tt - g_t * g_ta;
      const double d_angle = (g_t * g_t - g * g_tt) / det, d_t = (g * g_ta - g_t * g_a) / det;
      if (!std::isfinite(d_angle) || !std::isfinite(d_t)) return false;
      angle += d_angle;
      t += d_t;
      if (!(angle > from - width && angle < to + width) || std::abs(d_t) > 3.0) return false;
      if (std::abs(d_angle) < 1e-10 * width && std::abs(d_t) < 1e-4) {
        return angle > from && angle < to;
      }
    }
    return false;
  }

  const TorusSize& ring_;
  const Pose& X_;
  const TorusSize& other_;
  bool fine_;
  std::vector<double>& events_;
  double scale_ = 0.0;
  int spent_ = 0;
};

}  // namespace

void find_torus_events(const TorusSize& ring, const Pose& X, const TorusSize& other, bool fine,
                       const std::vector<TorusPatchScratch::Sample>& samples,
                       std::vector<double>& events) {
  events.clear();
  EventSearch search(ring, X, other, fine, events);
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    search.between(samples[i], samples[i + 1], 0);
  }
}

}  // namespace volcontact
