// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/torus/torus_arcs.h"

#include <algorithm>
#include <cmath>

#include "volcontact/pair/convex/gjk.h"

namespace volcontact {
namespace {

constexpr int kMaxBalls = 96;            // tried at most
constexpr double kShortArc = kPi / 6.0;  // one with a ball that meets the body is not divided [rad]

class ArcSearch {
 public:
  ArcSearch(const ConvexView& body, const Pose& X, double major, double minor, TorusArcs& arcs)
      : body_(body), X_(X), major_(major), minor_(minor), s_(arcs) {}

  void run() {
    s_.doubtful.clear();
    s_.met.clear();
    part_by_planes();
    if (!s_.doubtful.empty()) join_doubtful();
  }

 private:
  using Arc = TorusArcs::Arc;

  // Leaves what no plane parts from the body.
  void part_by_planes() {
    const Vec3 middle = body_.middle(X_);
    s_.start = std::atan2(middle.y(), middle.x());
    s_.open.clear();
    s_.open.push_back({s_.start - kPi, s_.start + kPi});
    for (int balls = 0; !s_.open.empty(); ++balls) {
      const Arc arc = s_.open.back();
      s_.open.pop_back();
      if (!(arc.high - arc.low > TorusArcs::kNothing)) continue;
      if (balls >= kMaxBalls) {
        s_.doubtful.push_back(arc);
        continue;
      }
      divide(arc);
    }
  }

  void divide(const Arc& arc) {
    const double angle = 0.5 * (arc.low + arc.high);
    const Vec3 center(major_ * std::cos(angle), major_ * std::sin(angle), 0.0);
    const BallGap gap = ball_gap(body_, X_, center, minor_);
    if (gap.apart) {
      const double across = major_ * std::hypot(gap.normal.x(), gap.normal.y());
      const double share = (gap.offset + minor_) / across;
      if (share <= -1.0) return s_.open.clear(), s_.doubtful.clear();
      const double middle = turned_near(std::atan2(gap.normal.y(), gap.normal.x()), angle);
      const double half = share < 1.0 ? std::acos(share) : 0.0;
      const double low = std::min(middle - half, angle), high = std::max(middle + half, angle);
      if (low > arc.low) s_.open.push_back({arc.low, low});
      if (high < arc.high) s_.open.push_back({high, arc.high});
      return;
    }
    const Vec3& q = gap.place;
    if (q.x() != 0.0 || q.y() != 0.0) {
      s_.met.push_back(turned_near(std::atan2(q.y(), q.x()), s_.start));
    }
    if (arc.high - arc.low > kShortArc) {
      s_.open.push_back({arc.low, angle});
      s_.open.push_back({angle, arc.high});
    } else {
      s_.doubtful.push_back(arc);
    }
  }

  // Where they touch.
  void join_doubtful() {
    std::vector<Arc>& arcs = s_.doubtful;
    std::sort(arcs.begin(), arcs.end(), [](const Arc& a, const Arc& b) { return a.low < b.low; });
    std::size_t kept = 0;
    for (std::size_t i = 1; i < arcs.size(); ++i) {
      if (arcs[i].low <= arcs[kept].high + TorusArcs::kNothing) {
        arcs[kept].high = std::max(arcs[kept].high, arcs[i].high);
      } else {
        arcs[++kept] = arcs[i];
      }
    }
    arcs.resize(kept + 1);
  }

  const ConvexView& body_;
  const Pose& X_;
  const double major_, minor_;
  TorusArcs& s_;
};

}  // namespace

void find_torus_arcs(const ConvexView& body, const Pose& X, double major, double minor,
                     TorusArcs& arcs) {
  ArcSearch(body, X, major, minor, arcs).run();
}

}  // namespace volcontact
