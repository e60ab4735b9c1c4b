// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/torus/torus_breaks.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace volcontact {
namespace {

constexpr double kParallel = 1e-12;  // squared sine below which two planes have no line in common
constexpr double kSlack = 1e-9;      // of places on faces, per radius of the ring
constexpr int kMaxPlanes = 12;       // with more, corners are left to the refinement
constexpr int kEdgeSteps = 12;       // places tried on an edge in search of the ring
constexpr int kRootSteps = 8;

class TorusBreaks {
 public:
  TorusBreaks(const FaceSet& faces, double major, double minor, std::vector<double>& angles)
      : faces_(faces), major_(major), minor_(minor), angles_(angles) {}

  void run() {
    angles_.clear();
    const std::vector<PlaneFace>& planes = faces_.planes;
    if (planes.size() > kMaxPlanes) return;
    for (std::size_t i = 0; i < planes.size(); ++i) {
      touch(planes[i]);
      for (std::size_t j = 0; j < i; ++j) edge(planes[i], planes[j]);
    }
    for (const Rim& rim : faces_.rims) follow(rim);
  }

 private:
  enum class Curve { kOpen, kClosed };

  void note(const Vec3& x) { angles_.push_back(std::atan2(x.y(), x.x())); }

  bool inside(const Vec3& x) const {
    const double slack = kSlack * major_;
    for (const PlaneFace& p : faces_.planes) {
      if (!(p.normal.dot(x) <= p.offset + slack)) return false;
    }
    for (const RoundFace& f : faces_.rounds) {
      if (f.part != CapsulePart::kNone) continue;
      if (!(f(x) <= 2.0 * slack * f.half_gradient(x).norm())) return false;
    }
    return true;
  }

  // Where the line of a plane in a half-plane touches the disc: the distance of the line from its
  // middle is a function of p = n_rho, and r^2 (p^2 + n_z^2) = (p R - c)^2.
  void touch(const PlaneFace& plane) {
    const double n_xy = std::hypot(plane.normal.x(), plane.normal.y()), n_z = plane.normal.z();
    const double a = (major_ - minor_) * (major_ + minor_), c = plane.offset;
    const double b = c * major_;
    const double square = minor_ * minor_ * (c * c + n_z * n_z * a);
    if (!(n_xy > 0.0)) return;
    const double to = std::atan2(plane.normal.y(), plane.normal.x());
    for (double side : {-1.0, 1.0}) {
      const double p = (b + side * std::sqrt(square)) / a;
      if (!(std::abs(p) < n_xy)) continue;
      const double turn = std::acos(p / n_xy), across = std::hypot(p, n_z);
      const double way = (c - p * major_) / across;  // from the middle to the line, signed
      for (double angle : {to - turn, to + turn}) {
        const double rho = major_ + way * p / across;
        const Vec3 x(rho * std::cos(angle), rho * std::sin(angle), way * n_z / across);
        if (inside(x)) angles_.push_back(angle);
      }
    }
  }

  double distance(const Vec3& x) const {
    const double across = std::sqrt(x.x() * x.x() + x.y() * x.y()) - major_;
    return std::sqrt(across * across + x.z() * x.z()) - minor_;
  }

  // The edge common to two planes: its ends, and where it pierces the ring.
  void edge(const PlaneFace& p, const PlaneFace& q) {
    const Vec3 along = p.normal.cross(q.normal);
    const double a2 = along.squaredNorm();
    if (!(a2 > kParallel)) return;
    const Vec3 o = (p.offset * q.normal.cross(along) + q.offset * along.cross(p.normal)) / a2;
    const Vec3 d = along / std::sqrt(a2);
    const double reach = major_ + minor_, nearest = -o.dot(d);
    const double half2 = reach * reach - (o + nearest * d).squaredNorm();
    if (!(half2 > 0.0)) return;
    double from = nearest - std::sqrt(half2), to = nearest + std::sqrt(half2);
    for (const PlaneFace& face : faces_.planes) {
      if (&face == &p || &face == &q) continue;
      const double rate = face.normal.dot(d), gap = face.offset - face.normal.dot(o);
      if (rate > 0.0) {
        to = std::min(to, gap / rate);
      } else if (rate < 0.0) {
        from = std::max(from, gap / rate);
      } else if (gap < 0.0) {
        return;
      }
    }
    if (!(from < to)) return;
    const auto x_at = [&](double t) -> Vec3 { return o + t * d; };
    for (double end : {from, to}) {
      if (distance(x_at(end)) < -kSlack * minor_) note(x_at(end));
    }
    pierce(x_at, from, to, Curve::kOpen);
  }

  // A round edge: where it pierces the ring, and where a half-plane touches it.
  void follow(const Rim& rim) {
    if (distance(rim.center) > rim.radius_u.norm()) return;
    const auto x_at = [&](double t) -> Vec3 {
      return rim.center + rim.radius_u * std::cos(t) + rim.radius_v * std::sin(t);
    };
    pierce(x_at, -kPi, kPi, Curve::kClosed);
    const auto turning = [&](double t) {
      const Vec3 x = x_at(t), v = rim.radius_v * std::cos(t) - rim.radius_u * std::sin(t);
      return x.x() * v.y() - x.y() * v.x();
    };
    each_root(turning, -kPi, kPi, Curve::kClosed, [&](double t) {
      const Vec3 x = x_at(t);
      if (distance(x) < 0.0 && inside(x)) note(x);
    });
  }

  template <typename Place>
  void pierce(Place&& x_at, double from, double to, Curve curve) {
    each_root([&](double t) { return distance(x_at(t)); }, from, to, curve,
              [&](double t) {
                if (inside(x_at(t))) note(x_at(t));
              });
  }

  // Between places that are not far apart, by bracketed false position. A closed curve ends where
  // it began, at the same value: a root there is then seen, whatever its rounding.
  template <typename Function, typename Use>
  static void each_root(Function&& f, double from, double to, Curve curve, Use&& use) {
    const double first = f(from);
    double x0 = from, f0 = first;
    for (int i = 1; i <= kEdgeSteps; ++i) {
      const double x1 = from + (to - from) * i / kEdgeSteps;
      const double f1 = i == kEdgeSteps && curve == Curve::kClosed ? first : f(x1);
      if ((f0 > 0.0) != (f1 > 0.0)) {
        double a = x0, fa = f0, b = x1, fb = f1;
        for (int step = 0; step < kRootSteps && fb != fa; ++step) {
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
        use(b);
      }
      x0 = x1;
      f0 = f1;
    }
  }

  const FaceSet& faces_;
  double major_, minor_;
  std::vector<double>& angles_;
};

}  // namespace

void find_torus_breaks(const FaceSet& faces, double major_radius, double minor_radius,
                       std::vector<double>& angles) {
  TorusBreaks(faces, major_radius, minor_radius, angles).run();
}

}  // namespace volcontact
