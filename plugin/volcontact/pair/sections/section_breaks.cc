// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/section_breaks.h"

#include <algorithm>
#include <array>
#include <limits>

namespace volcontact {
namespace {

constexpr double kParallel = 1e-12;  // squared sine below which two planes have no line in common
constexpr int kMaxPlanes = 12;       // with more, corners are left to the refinement
constexpr double kNearApex = 1.5;    // of the overlap: an apex that may be felt in it
constexpr int kRimSteps = 16;        // places tried on a rim in search of the other solid

// normal . x = offset, x counted from the center. A face of the overlap if `face` is not negative.
struct Plane {
  Vec3 normal;
  double offset;
  int face = -1;
};

// Angles along a rim in both directions from 0.
struct RimSteps {
  double angle[kRimSteps + 1], cos[kRimSteps + 1], sin[kRimSteps + 1];

  void set(double range, bool closer_in_the_middle) {
    for (int i = 0; i <= kRimSteps; ++i) {
      const double part = 2.0 * i / kRimSteps - 1.0;
      angle[i] = range * part * (closer_in_the_middle ? std::abs(part) : 1.0);
      cos[i] = std::cos(angle[i]);
      sin[i] = std::sin(angle[i]);
    }
  }
};

const RimSteps& all_round() {
  static const RimSteps steps = [] {
    RimSteps all;
    all.set(kPi, true);
    return all;
  }();
  return steps;
}

class BreakSearch {
 public:
  BreakSearch(const FaceSet& faces, const SectionFrame& frame, double tolerance,
              SectionBreaks& breaks)
      : faces_(faces), frame_(frame), tolerance_(tolerance), breaks_(breaks) {
    to_uv_ = Mat3::with_columns(frame.u, frame.v, frame.t).inverse();
    middle_ = frame.center;
    if (faces.has_bore) middle_ += frame.central ? frame.u + frame.t : frame.u;
  }

  void run() {
    breaks_.clear();
    const int n = static_cast<int>(faces_.planes.size());
    for (int r = 0; r < static_cast<int>(faces_.rounds.size()); ++r) {
      find_tops(r);
      if (faces_.rounds[r].cone) find_apex(r);
    }
    breaks_.complete = n <= kMaxPlanes;
    if (!breaks_.complete) return;
    for (int i = 0; i < n; ++i) {
      for (int r = 0; r < static_cast<int>(faces_.rounds.size()); ++r) {
        find_on_edge(i, r);
        for (int j = 0; j < i; ++j) intersect(plane(i), plane(j), r, kCorner);
      }
      for (int j = 0; j < i && faces_.has_bore; ++j) intersect(plane(i), plane(j), kBore, kCorner);
      for (int j = 0; j < i; ++j) {
        for (int k = 0; k < j; ++k) intersect(plane(i), plane(j), plane(k));
      }
    }
    for (const Rim& rim : faces_.rims) {
      const Owner met = other(rim.owner);
      if (faces_.has_rounds(met)) {
        follow(rim, [&](const Vec3& x) { return largest_value(x, met); });
      }
      if (faces_.has_bore) {
        follow(rim, [&](const Vec3& x) { return faces_.wall(frame_.center + x); });
      }
    }
    if (faces_.has_bore) follow_bore_rims();
  }

  void find_tops(const Vec3& n) {
    const Mat3 basis = basis_with_z(n);
    for (int r = 0; r < static_cast<int>(faces_.rounds.size()); ++r) {
      intersect(polar(r, basis.col(0)), polar(r, basis.col(1)), r, kTop);
      if (!breaks_.complete) continue;
      for (int i = 0; i < static_cast<int>(faces_.planes.size()); ++i) find_tops(i, r, n);
    }
  }

 private:
  enum Use { kCorner, kTouch, kTop };
  static constexpr int kBore = -2;  // stands for the index of a round face

  const RoundFace& round(int r) const { return r == kBore ? faces_.wall : faces_.rounds[r]; }

  Plane plane(int i) const {
    const PlaneFace& p = faces_.planes[i];
    return {p.normal, p.offset - p.normal.dot(frame_.center), i};
  }
  // Where the gradient of a round face is normal to e.
  Plane polar(int r, const Vec3& e) const {
    const RoundFace& f = faces_.rounds[r];
    const Vec3 normal = f.map.transpose() * f.weighted(f.map * e);
    return {normal, normal.dot(f.center - frame_.center)};
  }

  // Highest and lowest places of a round face, and on its edge with plane i.
  void find_tops(int r) { intersect(polar(r, frame_.u), polar(r, frame_.v), r, kTop); }
  void find_tops(int i, int r, const Vec3& n) {
    const Plane p = plane(i);
    intersect(p, polar(r, p.normal.cross(n)), r, kTop);
  }

  // A half-plane near the apex of a cone cuts it in an arc that bends sharply, and so it does where
  // the tip is cut off by a small disc.
  void find_apex(int r) {
    const Vec3 x = faces_.rounds[r].center - frame_.center;
    if (is_near(x)) note_direction(x);
  }

  // On the edge of plane i and round face r: the highest and lowest places, and those where a
  // half-plane of the sections touches it. Also the seams of a capsule.
  void find_on_edge(int i, int r) {
    const Plane p = plane(i);
    find_tops(i, r, frame_.t);
    const double climb = p.normal.dot(frame_.t);
    const RoundFace& f = faces_.rounds[r];
    if (std::abs(climb) > 1e-9 * frame_.t.norm()) {
      // The polar plane of the point where the axis pierces p.
      const Vec3 x = frame_.center + frame_.t * (p.offset / climb);
      const Vec3 y = f.map * (x - f.center);
      const Vec3 normal = f.map.transpose() * f.weighted(y);
      intersect(p, {normal, f.level() - f.weighted(y).dot(f.map * (frame_.center - f.center))}, r,
                kTouch);
    } else {
      intersect(p, polar(r, frame_.t), r, kTouch);  // that point is at infinity
    }
    if (f.part == CapsulePart::kTube) {
      const Segment& s = faces_.capsule[index(f.owner)];
      for (double side : {-1.0, 1.0}) {
        const double at = side * s.half_length - s.along(frame_.center);
        intersect(p, {s.axis, at}, r, kCorner);
      }
    }
  }

  // The two places where the line common to two planes pierces a round face.
  void intersect(const Plane& p, const Plane& q, int r, Use use) {
    const Vec3 along = p.normal.cross(q.normal);
    const double a2 = along.squaredNorm();
    if (!(a2 > kParallel * p.normal.squaredNorm() * q.normal.squaredNorm())) return;
    const Vec3 o = (p.offset * q.normal.cross(along) + q.offset * along.cross(p.normal)) / a2;
    const RoundFace& f = round(r);
    const Vec3 d = f.map * along, y = f.map * (frame_.center + o - f.center);
    const double a = d.dot(f.weighted(d)), b = d.dot(f.weighted(y));
    const double c = y.dot(f.weighted(y)) - f.level();
    const double disc = b * b - a * c;
    if (!(disc >= 0.0) || !(std::abs(a) > 1e-24 * a2 * f.map.squaredNorm())) return;
    for (double side : {-1.0, 1.0}) {
      const Vec3 x = o + along * ((-b + side * std::sqrt(disc)) / a);
      if (is_on(x, r) && is_inside(x, p.face, q.face, -1, r)) note(x, use);
    }
  }

  void intersect(const Plane& p, const Plane& q, const Plane& s) {
    Mat3 rows = Mat3::with_rows(p.normal, q.normal, s.normal);
    const double det = rows.determinant();
    if (!(std::abs(det) > 1e-9)) return;
    const Vec3 x = rows.inverse() * Vec3(p.offset, q.offset, s.offset);
    if (is_inside(x, p.face, q.face, s.face, -1)) note(x, kCorner);
  }

  // Where the rims of a bore, in planes across its axis, enter or leave the round faces of the body
  // in it.
  void follow_bore_rims() {
    const Bore& bore = faces_.bore;
    const Owner met = other(faces_.wall.owner);
    if (!faces_.has_rounds(met)) return;
    const Mat3 basis = basis_with_z(bore.axis);
    for (const PlaneFace& plane : faces_.planes) {
      if (plane.owner != faces_.wall.owner) continue;
      const double climb = plane.normal.dot(bore.axis);
      if (!(plane.normal.cross(bore.axis).squaredNorm() < kParallel)) continue;
      const Vec3 center =
          bore.center + bore.axis * ((plane.offset - plane.normal.dot(bore.center)) / climb);
      const double radius = bore.radius_at(center);
      follow({center, radius * basis.col(0), radius * basis.col(1), plane.owner},
             [&](const Vec3& x) { return largest_value(x, met); });
    }
  }

  // Where a rim of one solid enters or leaves the round faces of the other one, or a bore. Only
  // near the axis of the sections, as the overlap may be a small part of the rim; at a bore all
  // round, with smaller steps near the direction u, where the overlap is.
  template <typename Function>
  void follow(const Rim& rim, Function&& value_at) {
    const Vec3 from = middle_ - rim.center;
    const double middle = std::atan2(from.dot(rim.radius_v), from.dot(rim.radius_u));
    const double reach = std::max(frame_.u.norm(), frame_.v.norm()) / rim.radius_u.norm();
    const auto x_at = [&](double cosine, double sine) -> Vec3 {
      return rim.center - frame_.center + rim.radius_u * cosine + rim.radius_v * sine;
    };
    const auto value = [&](double angle) {
      return value_at(x_at(std::cos(angle), std::sin(angle)));
    };
    RimSteps near_axis;
    if (!faces_.has_bore) near_axis.set(std::min(kPi, 5.0 * reach), false);
    const RimSteps& steps = faces_.has_bore ? all_round() : near_axis;
    const double c = std::cos(middle), s = std::sin(middle);
    double angles[kRimSteps + 1], values[kRimSteps + 1];
    for (int i = 0; i <= kRimSteps; ++i) {
      angles[i] = middle + steps.angle[i];
      values[i] =
          value_at(x_at(c * steps.cos[i] - s * steps.sin[i], s * steps.cos[i] + c * steps.sin[i]));
    }
    const auto note_root = [&](double a0, double f0, double a1, double f1) {
      const double angle = root(value, a0, f0, a1, f1);
      const Vec3 x = x_at(std::cos(angle), std::sin(angle));
      if (is_inside(x, -2, -2, -2, -2)) note(x, kCorner);
    };
    for (int i = 1; i <= kRimSteps; ++i) {
      if ((values[i - 1] > 0.0) != (values[i] > 0.0)) {
        note_root(angles[i - 1], values[i - 1], angles[i], values[i]);
      }
      if (i == kRimSteps) continue;
      // Between two places the rim may dip into the solid, or out of it.
      const double sign = values[i] > 0.0 ? 1.0 : -1.0;
      const double before = sign * values[i - 1], here = sign * values[i],
                   after = sign * values[i + 1];
      if (!(before > 0.0 && after > 0.0 && here <= before && here <= after)) continue;
      // A parabola through the three goes an eighth of their bend lower at most.
      if (here > before + after - 2.0 * here) continue;
      const auto [angle, lowest] =
          dip([&](double at) { return sign * value(at); }, angles[i - 1], angles[i + 1]);
      if (lowest < 0.0) {
        note_root(angles[i - 1], values[i - 1], angle, sign * lowest);
        note_root(angle, sign * lowest, angles[i + 1], values[i + 1]);
      }
    }
  }

  // Where a function is least between two places, to about a thousandth of their distance, and what
  // it is there; the first negative value ends the search. Golden section.
  template <typename Function>
  static std::array<double, 2> dip(Function&& f, double x0, double x3) {
    constexpr double kGolden = 0.6180339887498949;
    double x1 = x3 - kGolden * (x3 - x0), x2 = x0 + kGolden * (x3 - x0);
    double f1 = f(x1), f2 = f(x2);
    for (int step = 0; step < 16 && f1 > 0.0 && f2 > 0.0; ++step) {
      if (f1 < f2) {
        x3 = x2, x2 = x1, f2 = f1;
        x1 = x3 - kGolden * (x3 - x0);
        f1 = f(x1);
      } else {
        x0 = x1, x1 = x2, f1 = f2;
        x2 = x0 + kGolden * (x3 - x0);
        f2 = f(x2);
      }
    }
    return f1 < f2 ? std::array{x1, f1} : std::array{x2, f2};
  }

  // Bracketed false position with halvings of the stale end (Illinois).
  template <typename Function>
  static double root(Function&& f, double x0, double f0, double x1, double f1) {
    for (int step = 0; step < 12; ++step) {
      const double x = x1 - f1 * (x1 - x0) / (f1 - f0), fx = f(x);
      if ((fx > 0.0) != (f1 > 0.0)) {
        x0 = x1;
        f0 = f1;
      } else {
        f0 *= 0.5;
      }
      x1 = x;
      f1 = fx;
      if (f1 == 0.0) break;
    }
    return x1;
  }

  // Largest value of the round faces of a solid; of a capsule that of the part x belongs to.
  double largest_value(const Vec3& x, Owner owner) const {
    double largest = -std::numeric_limits<double>::infinity();
    for (std::size_t r = 0; r < faces_.rounds.size(); ++r) {
      const RoundFace& f = faces_.rounds[r];
      if (f.owner == owner && is_on_part(x, f)) {
        largest = std::max(largest, f(frame_.center + x));
      }
    }
    return largest;
  }

  // Whether the part of a capsule that a face stands for is the one x belongs to.
  bool is_on_part(const Vec3& x, const RoundFace& f) const {
    if (f.part == CapsulePart::kNone) return true;
    const Segment& s = faces_.capsule[index(f.owner)];
    const double along = s.along(frame_.center + x);
    if (f.part == CapsulePart::kTube) return std::abs(along) <= s.half_length + tolerance_;
    return (f.part == CapsulePart::kTopBall ? along : -along) >= s.half_length - tolerance_;
  }

  // Whether a place on the unbounded round face belongs to the face: on the right part of a
  // capsule, on the right half of a cone.
  bool is_on(const Vec3& x, int r) const {
    const RoundFace& f = round(r);
    if (f.cone && !((f.map * (frame_.center + x - f.center)).z() >= 0.0)) return false;
    return is_on_part(x, f);
  }

  // Inside of both solids to the tolerance, up to the faces named.
  bool is_inside(const Vec3& x, int plane_1, int plane_2, int plane_3, int own) const {
    for (int i = 0; i < static_cast<int>(faces_.planes.size()); ++i) {
      if (i == plane_1 || i == plane_2 || i == plane_3) continue;
      const Plane p = plane(i);
      if (!(p.normal.dot(x) <= p.offset + tolerance_)) return false;
    }
    for (int r = 0; r < static_cast<int>(faces_.rounds.size()); ++r) {
      const RoundFace& f = faces_.rounds[r];
      if (own >= 0 && f.owner == faces_.rounds[own].owner) continue;
      if (!is_on_part(x, f)) continue;
      const Vec3 place = frame_.center + x;
      if (!(f(place) <= 2.0 * tolerance_ * f.half_gradient(place).norm())) return false;
    }
    return true;
  }

  void note(const Vec3& x, Use use) {
    breaks_.places.push_back(x);
    if (use == kTop) return;
    note_direction(x);
  }
  void note_direction(const Vec3& x) {
    const Vec3 y = to_uv_ * x;
    const double height = frame_.central ? 1.0 / y.z() : y.z();
    const double length = y.head<2>().norm(), rho = frame_.central ? length * height : length;
    if (!(rho > 1e-9)) return;
    if (faces_.has_bore && rho < 1.0 - 1e-9) return;
    breaks_.directions.push_back({y.x() / length, y.y() / length});
  }

  // Whether an apex is about as far from the axis of the sections as the overlap reaches.
  bool is_near(const Vec3& x) const {
    const Vec3 y = to_uv_ * x;
    if (frame_.central && !(y.z() > 0.0)) return false;
    const double length = y.head<2>().norm() / (frame_.central ? y.z() : 1.0);
    return length < kNearApex;
  }

  const FaceSet& faces_;
  const SectionFrame& frame_;
  double tolerance_;
  SectionBreaks& breaks_;
  Mat3 to_uv_;
  Vec3 middle_;  // of the overlap, or nearly so
};

}  // namespace

void SectionBreaks::clear() {
  directions.clear();
  complete = true;
  places.clear();
}

void find_breaks(const FaceSet& faces, const SectionFrame& frame, double tolerance,
                 SectionBreaks& breaks) {
  BreakSearch(faces, frame, tolerance, breaks).run();
}

void find_tops(const FaceSet& faces, const SectionFrame& frame, const Vec3& n, double tolerance,
               SectionBreaks& breaks) {
  BreakSearch(faces, frame, tolerance, breaks).find_tops(n);
}

}  // namespace volcontact
