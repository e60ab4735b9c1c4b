// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/torus/torus_breaks.h"

#include <algorithm>
#include <cmath>

#include "volcontact/pair/sections/torus/curve_roots.h"

namespace volcontact {
namespace {

constexpr double kParallel = 1e-12;  // squared sine below which two planes have no line in common
constexpr double kSlack = 1e-9;      // of places on faces, per radius of the ring
constexpr int kMaxPlanes = 12;       // with more, corners are left to the refinement
constexpr double kSmallHole = 0.1;   // R^2 - r^2, per R^2
constexpr double kSlightLean = 0.1;  // sine of the angle between a plane and the axis
constexpr double kSlightOffset = 1e-2;  // per R
constexpr double kSlightTip = 0.1;      // per R: a tip of a cone beside the axis
constexpr double kSwing = 4.0;          // angle by that sine or offset: half of a section's swing
constexpr double kWidestSwing = 0.7;    // [rad]
constexpr double kTail = 32.0;          // the same: beyond it little is left

class TorusBreaks {
 public:
  TorusBreaks(const FaceSet& faces, double major, double minor, std::vector<double>& angles,
              std::vector<double>* roots)
      : faces_(faces), major_(major), minor_(minor), angles_(angles), roots_(roots) {}

  void run() {
    angles_.clear();
    if (roots_) roots_->clear();
    const std::vector<PlaneFace>& planes = faces_.planes;
    if (planes.size() > kMaxPlanes) return;
    for (std::size_t i = 0; i < planes.size(); ++i) {
      touch(planes[i]);
      swing(planes[i]);
      for (std::size_t j = 0; j < i; ++j) edge(planes[i], planes[j]);
    }
    for (const Rim& rim : faces_.rims) follow(rim);
    if (has_small_hole()) {
      for (const RoundFace& face : faces_.rounds) swing(face);
    }
  }

 private:
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
  // middle is a function of p = n_rho, and r^2 (p^2 + n_z^2) = (p R - c)^2. A ring without a hole
  // has one such p and not two.
  void touch(const PlaneFace& plane) {
    const double n_xy = std::hypot(plane.normal.x(), plane.normal.y()), n_z = plane.normal.z();
    const double a = (major_ - minor_) * (major_ + minor_), c = plane.offset;
    const double b = c * major_;
    const double square = minor_ * minor_ * (c * c + n_z * n_z * a);
    if (!(n_xy > 0.0)) return;
    const double to = std::atan2(plane.normal.y(), plane.normal.x());
    const double larger = b + std::copysign(std::sqrt(square), b);
    const double product = (c - minor_ * n_z) * (c + minor_ * n_z);  // of both p, times a
    for (const double p : {larger / a, product / larger}) {
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

  // Near a plane that all but holds the axis a section changes from all to next to none in a small
  // angle, and a ring with next to no hole has always some of it left. A plane that is nearer to
  // the middle than it leans to the axis swings about the rim of the disc and need not touch it;
  // another one touches it once, and what is left then falls like a power of the angle.
  void swing(const PlaneFace& plane) {
    const double lean = std::abs(plane.normal.z());
    if (!has_small_hole()) return;
    const double to = std::atan2(plane.normal.y(), plane.normal.x()), off = plane.offset / major_;
    const auto note_p = [&](double p) {
      if (std::abs(p) > kWidestSwing) return;
      for (const double side : {-1.0, 1.0}) angles_.push_back(to + side * (0.5 * kPi - p));
    };
    if (std::abs(plane.offset) > 2.0 * lean * minor_) {
      if (std::abs(off) > kSlightOffset) return;
      for (const double p : {kSwing * off, kTail * off}) note_p(p);
    } else if (lean < kSlightLean) {
      for (const double p : {0.0, kSwing * lean, kTail * lean}) {
        note_p(-p);
        if (p > 0.0) note_p(p);
      }
    }
  }

  bool has_small_hole() const {
    return (major_ - minor_) * (major_ + minor_) < kSmallHole * major_ * major_;
  }

  // The same of a cone or tube, where a plane along the axis touches it in a line. Behind that
  // plane a section is next to nothing; before it, it grows like the root of the angle.
  void swing(const RoundFace& face) {
    const Vec3 row = face.map.row(2);
    if (face.cone) {
      const double slope = row.norm(), cosine = 1.0 / std::sqrt(1.0 + slope * slope);
      const Vec3 axis = row / slope;
      const double across = std::hypot(axis.x(), axis.y()), sine = slope * cosine;
      if (!(across > sine)) return;
      const double at = std::atan2(axis.y(), axis.x()), turn = std::acos(-sine / across);
      for (const double angle : {at - turn, at + turn}) {
        const Vec3 normal(std::cos(angle), std::sin(angle), 0.0);
        swing(normal, normal.dot(face.center), axis + sine * normal);
      }
    } else if (face.part == CapsulePart::kNone || face.part == CapsulePart::kTube) {
      const Vec3 axis = Vec3(face.map.row(0)).cross(Vec3(face.map.row(1)));
      const double across = std::hypot(axis.x(), axis.y());
      if (!row.isZero(0.0) || !(across > 0.0)) return;
      const double radius = 1.0 / Vec3(face.map.row(0)).norm();
      for (const double side : {-1.0, 1.0}) {
        const Vec3 normal(side * axis.y() / across, -side * axis.x() / across, 0.0);
        const double offset = normal.dot(face.center) + radius;
        for (const double way : {-1.0, 1.0}) swing(normal, offset, way * axis);
      }
    }
  }

  // The plane touches a face along a line with this direction, which is not the axis's.
  void swing(const Vec3& normal, double offset, const Vec3& along) {
    const double off = offset / major_;
    if (std::abs(off) > kSlightTip) return;
    const double to = std::atan2(along.y(), along.x());
    const double side = along.x() * normal.y() - along.y() * normal.x() > 0.0 ? 1.0 : -1.0;
    note_root(to);
    if (off == 0.0) return;
    note_root(to + side * off * major_ / (major_ + minor_));
    for (const double p : {kSwing * off, kTail * off}) {
      if (std::abs(p) > kWidestSwing) return;
      note_root(to - p);
      note_root(to + p);
    }
  }

  void note_root(double angle) {
    angles_.push_back(angle);
    if (roots_) roots_->push_back(angle);
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
    pierce(x_at, from, to, CurveEnds::kOpen);
  }

  // A round edge: where it pierces the ring, and where a half-plane touches it.
  void follow(const Rim& rim) {
    if (distance(rim.center) > rim.radius_u.norm()) return;
    const auto x_at = [&](double t) -> Vec3 {
      return rim.center + rim.radius_u * std::cos(t) + rim.radius_v * std::sin(t);
    };
    pierce(x_at, -kPi, kPi, CurveEnds::kClosed);
    const auto turning = [&](double t) {
      const Vec3 x = x_at(t), v = rim.radius_v * std::cos(t) - rim.radius_u * std::sin(t);
      return x.x() * v.y() - x.y() * v.x();
    };
    each_root(turning, -kPi, kPi, CurveEnds::kClosed, [&](double t) {
      const Vec3 x = x_at(t);
      if (distance(x) < 0.0 && inside(x)) note(x);
    });
  }

  template <typename Place>
  void pierce(Place&& x_at, double from, double to, CurveEnds ends) {
    each_root([&](double t) { return distance(x_at(t)); }, from, to, ends,
              [&](double t) {
                if (inside(x_at(t))) note(x_at(t));
              });
  }

  const FaceSet& faces_;
  double major_, minor_;
  std::vector<double>& angles_;
  std::vector<double>* roots_;
};

}  // namespace

void find_torus_breaks(const FaceSet& faces, double major_radius, double minor_radius,
                       std::vector<double>& angles, std::vector<double>* roots) {
  TorusBreaks(faces, major_radius, minor_radius, angles, roots).run();
}

}  // namespace volcontact
