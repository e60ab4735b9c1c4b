// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "volcontact/pair/surface_sweep/crossings.h"
#include "volcontact/pair/surface_sweep/face_curve.h"

namespace volcontact::curve_forms {

// The functions of faces along lines and circles, and where they vanish.

using Kind = SweepFace::Kind;

inline constexpr double kParallel = 1e-13;  ///< a line as good as in a face or along its wall
inline constexpr int kCirclePlaces = 16, kTorusPlaces = 32;

// a t^2 + 2 b t + c, negative inside of a round face.
struct Parabola {
  double a, b, c, unit;
  double rise, height;  ///< along the axis of a cone: of the direction, and over the apex

  Parabola(const RoundFace& face, const FaceCurve& line) {
    const Vec3 y = face.map * (line.p - face.center), d = face.map * line.u;
    const Vec3 dj = face.weighted(d);
    a = d.dot(dj);
    b = y.dot(dj);
    c = y.dot(face.weighted(y)) - face.level();
    unit = (face.map.cwiseAbs2() * line.u.cwiseAbs2()).sum();
    rise = d.z();
    height = y.z();
  }
  bool flat() const { return std::abs(a) <= kParallel * unit; }
  bool level(double size) const {
    return flat() && std::abs(b) <= kParallel * std::sqrt(unit) * size;
  }
  double reach() const { return b * b - a * c; }
  // Lower and higher root.
  bool roots(double& low, double& high) const {
    const double square = reach();
    if (!(square > 0.0)) return false;
    const double q = -(b + std::copysign(std::sqrt(square), b));
    const double one = q / a, other = q != 0.0 ? c / q : one;
    low = std::min(one, other);
    high = std::max(one, other);
    return true;
  }
};

/// The interval of a line inside of a face; false for none.
inline bool line_interval(const SweepFace& face, const FaceCurve& line, double& low, double& high) {
  low = -kInfinity;
  high = kInfinity;
  if (face.kind == Kind::kPlane) {
    const double slope = face.normal.dot(line.u), level = face.offset - face.normal.dot(line.p);
    if (std::abs(slope) <= kParallel * line.u.norm()) return level > 0.0;
    (slope > 0.0 ? high : low) = level / slope;
    return true;
  }
  const Parabola f(face.round, line);
  if (f.flat()) {
    if (f.level(1.0) || f.b == 0.0)
      return f.c < 0.0 && (face.kind != Kind::kCone || f.height > 0.0);
    (f.b > 0.0 ? high : low) = -0.5 * f.c / f.b;
    return true;
  }
  double one, other;
  if (!f.roots(one, other)) return false;
  if (f.a > 0.0) {
    low = one;
    high = other;
    return face.kind != Kind::kCone || f.height + 0.5 * (one + other) * f.rise > 0.0;
  }
  (f.rise > 0.0 ? low : high) = f.rise > 0.0 ? other : one;
  return true;
}

/// c + a cos t + b sin t, negative inside of a plane, or of a round face that the circle lies even
/// to.
struct Cosine {
  double c, a, b, r;

  bool read(const SweepFace& face, const FaceCurve& circle) {
    if (face.kind == Kind::kTorus) return false;
    if (face.kind == Kind::kPlane) {
      c = face.normal.dot(circle.p) - face.offset;
      a = face.normal.dot(circle.u);
      b = face.normal.dot(circle.v);
    } else {
      const RoundFace& f = face.round;
      const Vec3 y = f.map * (circle.p - f.center), u = f.map * circle.u, v = f.map * circle.v;
      const double uu = u.dot(f.weighted(u)), vv = v.dot(f.weighted(v)), uv = u.dot(f.weighted(v));
      if (std::abs(uu - vv) + std::abs(uv) > kParallel * (u.squaredNorm() + v.squaredNorm())) {
        return false;
      }
      c = y.dot(f.weighted(y)) - f.level() + 0.5 * (uu + vv);
      a = 2.0 * y.dot(f.weighted(u));
      b = 2.0 * y.dot(f.weighted(v));
    }
    r = std::hypot(a, b);
    return true;
  }
  bool crosses() const { return std::abs(c) < r && r > kParallel * std::abs(c); }
  double reach() const { return (r - c) * (r + c); }
  double middle() const { return std::atan2(-b, -a); }
  double width() const { return std::acos(std::clamp(c / r, -1.0, 1.0)); }
};

/// x . J x of a vector x = p + c u + s v on a circle, of its cosine c and sine s.
struct CircleForm {
  double pp = 0.0, pu = 0.0, pv = 0.0, uu = 0.0, uv = 0.0, vv = 0.0;

  void add(double p, double u, double v, double weight) {
    pp += weight * p * p;
    pu += weight * p * u;
    pv += weight * p * v;
    uu += weight * u * u;
    uv += weight * u * v;
    vv += weight * v * v;
  }
  CurveValue at(double c, double s) const {
    const double along = pu + c * uu + s * uv, across = pv + c * uv + s * vv;
    return {pp + c * (pu + along) + s * (pv + across), 2.0 * (c * across - s * along)};
  }
};

/// Values and slopes of a face along a circle.
class AlongCircle {
 public:
  AlongCircle(const SweepFace& face, const FaceCurve& circle) {
    if (face.kind != Kind::kTorus) {
      const RoundFace& f = face.round;
      const Vec3 y = f.map * (circle.p - f.center), u = f.map * circle.u, v = f.map * circle.v;
      for (int i = 0; i < 3; ++i) form_.add(y[i], u[i], v[i], i == 2 && f.cone ? -1.0 : 1.0);
      form_.pp -= f.level();
      return;
    }
    const Vec3 d = circle.p - face.round.center;
    for (int i = 0; i < 3; ++i) form_.add(d[i], circle.u[i], circle.v[i], 1.0);
    height_.add(face.normal.dot(d), face.normal.dot(circle.u), face.normal.dot(circle.v), 1.0);
    major_ = face.major;
    constant_ = (major_ - face.minor) * (major_ + face.minor);
  }

  CurveValue operator()(double t) const { return at(std::cos(t), std::sin(t)); }
  // At even steps of a turn.
  CurveValue step(int i, int places) const {
    static const auto table = [] {
      std::array<double, 2 * kTorusPlaces> turns;
      for (int k = 0; k < kTorusPlaces; ++k) {
        turns[2 * k] = std::cos(2.0 * kPi * k / kTorusPlaces);
        turns[2 * k + 1] = std::sin(2.0 * kPi * k / kTorusPlaces);
      }
      return turns;
    }();
    const int k = i * (kTorusPlaces / places);
    return at(table[2 * k], table[2 * k + 1]);
  }

 private:
  CurveValue at(double c, double s) const {
    const CurveValue form = form_.at(c, s);
    if (major_ < 0.0) return form;
    // (rho - R)^2 + z^2 - r^2, with rho^2 + z^2 in the form.
    const CurveValue z2 = height_.at(c, s);
    const double rho =
        std::sqrt(std::max(form.value - z2.value, std::numeric_limits<double>::min()));
    return {form.value - 2.0 * major_ * rho + constant_,
            form.slope - major_ / rho * (form.slope - z2.slope)};
  }

  CircleForm form_, height_;
  double major_ = -1.0, constant_ = 0.0;
};

/// The same of a torus along a line.
struct AlongLine {
  const SweepFace& face;
  const FaceCurve& line;

  CurveValue operator()(double t) const {
    const Vec3 d = line.at(t) - face.round.center;
    const double z = face.normal.dot(d), dz = face.normal.dot(line.u);
    const Vec3 across = d - z * face.normal;
    const double rho = std::max(across.norm(), std::numeric_limits<double>::min());
    const double off = rho - face.major;
    return {off * off + (z - face.minor) * (z + face.minor),
            2.0 * (off / rho * across.dot(line.u) + z * dz)};
  }
};

}  // namespace volcontact::curve_forms
