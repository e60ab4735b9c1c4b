// SPDX-License-Identifier: Apache-2.0
#include "core/reference/reference_solid.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace volcontact::test {
namespace {

using Solid = ReferenceSolid;

ReferenceFace plane(const Vec3& normal, double offset) {
  ReferenceFace face;
  face.linear = normal;
  face.constant = -offset;
  return face;
}

// sum weights_i (x_i - center_i)^2 <= level.
ReferenceFace round_face(const Vec3& weights, const Vec3& center, double level) {
  ReferenceFace face;
  face.hessian = (2.0 * weights).asDiagonal();
  face.linear = -2.0 * weights.cwiseProduct(center);
  face.constant = weights.cwiseProduct(center).dot(center) - level;
  return face;
}

Solid ball(double radius, const Vec3& center) {
  return Solid::piece({round_face(Vec3::Ones(), center, radius * radius)});
}

Solid tube(double radius, double half_length) {
  return Solid::piece({plane(Vec3::UnitZ(), half_length), plane(-Vec3::UnitZ(), half_length),
                       round_face({1.0, 1.0, 0.0}, Vec3::Zero(), radius * radius)});
}

Solid solid_of(const HalfSpace&) { return Solid::piece({plane(Vec3::UnitZ(), 0.0)}); }
Solid solid_of(const Sphere& s) { return ball(s.radius(), Vec3::Zero()); }
Solid solid_of(const Ellipsoid& e) {
  return Solid::piece({round_face(e.semi_axes().cwiseAbs2().cwiseInverse(), Vec3::Zero(), 1.0)});
}
Solid solid_of(const Capsule& c) {
  const Vec3 up(0.0, 0.0, c.half_length());
  return Solid::capsule(
      c.radius(), c.half_length(),
      tube(c.radius(), c.half_length()) | ball(c.radius(), up) | ball(c.radius(), -up));
}
Solid solid_of(const Cylinder& c) { return tube(c.radius(), c.half_length()); }
Solid solid_of(const Frustum& f) {
  // x^2 + y^2 <= (middle + slope z)^2 between the ends.
  const Frustum::Params& p = f.params();
  const double middle = 0.5 * (p.bottom_radius + p.top_radius);
  const double slope = 0.5 * (p.top_radius - p.bottom_radius) / p.half_length;
  ReferenceFace cone;
  cone.hessian = Vec3(2.0, 2.0, -2.0 * slope * slope).asDiagonal();
  cone.linear = Vec3(0.0, 0.0, -2.0 * middle * slope);
  cone.constant = -middle * middle;
  cone.nappe = Vec3(0.0, 0.0, slope);
  cone.nappe_constant = middle;
  return Solid::piece(
      {plane(Vec3::UnitZ(), p.half_length), plane(-Vec3::UnitZ(), p.half_length), cone});
}
Solid solid_of(const Box& box) {
  std::vector<ReferenceFace> faces;
  for (int i = 0; i < 3; ++i) {
    for (const double side : {1.0, -1.0}) {
      faces.push_back(plane(side * Vec3::Unit(i), box.half_sizes()[i]));
    }
  }
  return Solid::piece(faces);
}
// From its definition: the ball swept over the box of its centres.
Solid solid_of(const RoundedBox& box) {
  const double r = box.radius();
  const Vec3 inner = box.half_sizes() - Vec3::Constant(r);
  std::optional<Solid> whole;
  const auto add = [&](const Solid& part) { whole = whole ? *whole | part : part; };
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<ReferenceFace> slab;
    for (int i = 0; i < 3; ++i) {
      for (const double side : {1.0, -1.0}) {
        slab.push_back(plane(side * Vec3::Unit(i), inner[i] + (i == axis ? r : 0.0)));
      }
    }
    add(Solid::piece(slab));
    for (int k = 0; k < 4; ++k) {
      Vec3 center = Vec3::Zero();
      center[(axis + 1) % 3] = (k & 1 ? 1.0 : -1.0) * inner[(axis + 1) % 3];
      center[(axis + 2) % 3] = (k & 2 ? 1.0 : -1.0) * inner[(axis + 2) % 3];
      add(Solid::piece({plane(Vec3::Unit(axis), inner[axis]), plane(-Vec3::Unit(axis), inner[axis]),
                        round_face(Vec3::Ones() - Vec3::Unit(axis), center, r * r)}));
    }
  }
  for (int i = 0; i < 8; ++i) add(ball(r, inner.cwiseProduct(corner_signs(i))));
  return *whole;
}
Solid solid_of(const Torus& t) { return Solid::torus(t.major_radius(), t.minor_radius()); }
Solid solid_of(const ConvexPolytope& polytope) {
  std::vector<ReferenceFace> faces;
  for (const auto& face : polytope.faces()) faces.push_back(plane(face.normal, face.offset));
  return Solid::piece(faces);
}

// A function is no set of faces: it has its own tests.
Solid solid_of(const SignedDistance&) {
  throw std::invalid_argument("reference_solid: a signed distance has no faces");
}

// Meshes are compared with manifold3d and CGAL, in Python.
Solid solid_of(const Mesh&) {
  throw std::invalid_argument("reference_solid: a mesh has too many faces");
}

Solid solid_of(const Csg& csg) {
  std::vector<Solid> stack;
  for (const Csg::Step& step : csg.steps()) {
    if (step.member >= 0) {
      const Csg::Member& member = csg.members()[static_cast<std::size_t>(step.member)];
      const auto make = [](const auto& solid) { return solid_of(solid); };
      stack.push_back(std::visit(make, member.shape).posed(member.X_SM));
      continue;
    }
    const Solid b = stack.back();
    stack.pop_back();
    const Solid a = stack.back();
    switch (step.operation) {
      case Csg::Operation::kUnion:
        stack.back() = a | b;
        break;
      case Csg::Operation::kIntersection:
        stack.back() = a & b;
        break;
      case Csg::Operation::kDifference:
        stack.back() = a - b;
        break;
    }
  }
  return stack.back();
}

// The root of a monotone stretch of t^4 + p t^2 + q t + r, by Newton steps kept in the bracket.
double quartic_root(double p, double q, double r, double low, double high) {
  const auto f = [=](double t) { return ((t * t + p) * t + q) * t + r; };
  const bool rising = f(high) > f(low);
  double t = 0.5 * (low + high);
  for (int i = 0; i < 100; ++i) {
    const double value = f(t);
    ((value > 0.0) == rising ? high : low) = t;
    const double slope = (4.0 * t * t + 2.0 * p) * t + q;
    double next = t - value / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - t) <= 1e-15 * (1.0 + std::abs(t))) return next;
    t = next;
  }
  return t;
}

// Sorted real roots of 4 t^3 + 2 p t + q.
int cubic_roots(double p, double q, double* roots) {
  const double c = 0.5 * p, d = 0.25 * q;  // t^3 + c t + d
  const double discriminant = 0.25 * d * d + c * c * c / 27.0;
  if (discriminant > 0.0) {
    const double big = -0.5 * d - std::copysign(std::sqrt(discriminant), d);
    const double one = std::cbrt(big);
    roots[0] = one == 0.0 ? 0.0 : one - c / (3.0 * one);
    return 1;
  }
  const double m = 2.0 * std::sqrt(std::max(0.0, -c / 3.0));
  if (m == 0.0) {
    roots[0] = 0.0;
    return 1;
  }
  const double angle = std::acos(std::clamp(3.0 * d / (c * m), -1.0, 1.0)) / 3.0;
  for (int k = 0; k < 3; ++k) roots[k] = m * std::cos(angle - 2.0 * kPi * k / 3.0);
  std::sort(roots, roots + 3);
  return 3;
}

}  // namespace

constexpr double kSame = 1e-13;   // distance at which faces of bodies of a metre count as one [m]
constexpr double kShared = 1e-9;  // and at which they are said to be shared [m]

ReferenceSpans both(const ReferenceSpans& a, const ReferenceSpans& b) {
  ReferenceSpans result;
  for (int i = 0; i < a.size(); ++i) {
    for (int j = 0; j < b.size(); ++j) {
      const ReferenceSpan &x = a[i], &y = b[j];
      // Of coplanar faces always the first solid's: rounding must not choose.
      const ReferenceSpan& first = x.enter >= y.enter - kSame ? x : y;
      const ReferenceSpan& last = x.leave <= y.leave + kSame ? x : y;
      result.add({first.enter, last.leave, first.enter_face, last.leave_face,
                  std::abs(x.enter - y.enter) < kShared, std::abs(x.leave - y.leave) < kShared});
    }
  }
  return result;
}

ReferenceSpans either(const ReferenceSpans& a, const ReferenceSpans& b) {
  ReferenceSpans result;
  int i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    const auto take = [&]() -> const ReferenceSpan& {
      const bool from_a = j == b.size() || (i < a.size() && a[i].enter <= b[j].enter + kSame);
      return from_a ? a[i++] : b[j++];
    };
    ReferenceSpan span = take();
    // Of two that lie flush no gap is left between them, whatever rounding says.
    while ((i < a.size() && a[i].enter <= span.leave + kSame) ||
           (j < b.size() && b[j].enter <= span.leave + kSame)) {
      const ReferenceSpan& more = take();
      if (more.leave <= span.leave + kSame) continue;
      span.leave = more.leave;
      span.leave_face = more.leave_face;
    }
    result.add(span);
  }
  return result;
}

ReferenceSpans without(const ReferenceSpans& a, const ReferenceSpans& b) {
  ReferenceSpans result;
  for (int i = 0; i < a.size(); ++i) {
    ReferenceSpan rest = a[i];
    for (int j = 0; j < b.size(); ++j) {
      if (b[j].leave <= rest.enter + kSame || b[j].enter >= rest.leave - kSame) continue;
      if (b[j].enter > rest.enter + kSame) {
        result.add({rest.enter, b[j].enter, rest.enter_face, b[j].enter_face});
      }
      rest.enter = b[j].leave;
      rest.enter_face = b[j].leave_face;
    }
    if (rest.leave > rest.enter + kSame) result.add(rest);
  }
  return result;
}

ReferenceSolid ReferenceSolid::piece(std::vector<ReferenceFace> faces) {
  ReferenceSolid solid;
  solid.faces_ = std::move(faces);
  return solid;
}

ReferenceSolid ReferenceSolid::torus(double major_radius, double minor_radius) {
  ReferenceSolid solid;
  solid.kind_ = Kind::kTorus;
  solid.major_radius_ = major_radius;
  solid.minor_radius_ = minor_radius;
  return solid;
}

ReferenceSolid ReferenceSolid::capsule(double radius, double half_length,
                                       const ReferenceSolid& parts) {
  ReferenceSolid solid;
  solid.kind_ = Kind::kCapsule;
  solid.major_radius_ = half_length;
  solid.minor_radius_ = radius;
  solid.parts_ = {parts};
  return solid;
}

ReferenceSolid ReferenceSolid::joined(Kind kind, const ReferenceSolid& a, const ReferenceSolid& b) {
  ReferenceSolid solid;
  solid.kind_ = kind;
  solid.parts_ = {a, b};
  return solid;
}
ReferenceSolid operator|(const ReferenceSolid& a, const ReferenceSolid& b) {
  return ReferenceSolid::joined(ReferenceSolid::Kind::kUnion, a, b);
}
ReferenceSolid operator&(const ReferenceSolid& a, const ReferenceSolid& b) {
  return ReferenceSolid::joined(ReferenceSolid::Kind::kIntersection, a, b);
}
ReferenceSolid operator-(const ReferenceSolid& a, const ReferenceSolid& b) {
  return ReferenceSolid::joined(ReferenceSolid::Kind::kDifference, a, b);
}

ReferenceSolid ReferenceSolid::posed(const Pose& X_WS) const {
  ReferenceSolid solid = *this;
  const Pose X_SW = X_WS.inverse();
  const Mat3& r = X_SW.rotation;
  const Vec3& p = X_SW.translation;
  for (ReferenceFace& face : solid.faces_) {
    face.constant += face.linear.dot(p) + 0.5 * p.dot(face.hessian * p);
    face.linear = r.transpose() * (face.linear + face.hessian * p);
    face.hessian = r.transpose() * face.hessian * r;
    face.nappe_constant += face.nappe.dot(p);
    face.nappe = r.transpose() * face.nappe;
  }
  solid.X_TW_ = X_TW_ * X_SW;
  for (ReferenceSolid& part : solid.parts_) part = part.posed(X_WS);
  return solid;
}

int ReferenceSolid::number_faces(int first) {
  first_face_ = first;
  if (kind_ == Kind::kTorus || kind_ == Kind::kCapsule) return first + 1;
  if (kind_ == Kind::kPiece) return first + static_cast<int>(faces_.size());
  for (ReferenceSolid& part : parts_) first = part.number_faces(first);
  return first;
}

ReferenceSpans ReferenceSolid::column(double u, double v) const {
  switch (kind_) {
    case Kind::kPiece:
      return piece_column(u, v);
    case Kind::kTorus:
      return torus_column(u, v);
    case Kind::kCapsule: {
      const ReferenceSpans spans = parts_[0].column(u, v);
      ReferenceSpans renamed;
      for (int i = 0; i < spans.size(); ++i) {
        renamed.add({spans[i].enter, spans[i].leave, first_face_, first_face_});
      }
      return renamed;
    }
    case Kind::kUnion:
      return either(parts_[0].column(u, v), parts_[1].column(u, v));
    case Kind::kIntersection:
      return both(parts_[0].column(u, v), parts_[1].column(u, v));
    case Kind::kDifference:
      return without(parts_[0].column(u, v), parts_[1].column(u, v));
  }
  return {};
}

ReferenceSpans ReferenceSolid::piece_column(double u, double v) const {
  double low = -kInfinity, high = kInfinity;
  int low_face = -1, high_face = -1, number = first_face_;
  const auto from = [&](double t) {
    if (t > low) low = t, low_face = number;
  };
  const auto to = [&](double t) {
    if (t < high) high = t, high_face = number;
  };
  for (const ReferenceFace& face : faces_) {
    // a t^2 + b t + c <= 0.
    const Mat3& h = face.hessian;
    const double a = 0.5 * h(2, 2), b = face.linear.z() + h(0, 2) * u + h(1, 2) * v;
    const double c = face.constant + face.linear.x() * u + face.linear.y() * v +
                     0.5 * (h(0, 0) * u * u + h(1, 1) * v * v) + h(0, 1) * u * v;
    if (a == 0.0) {
      if (b > 0.0) to(-c / b);
      if (b < 0.0) from(-c / b);
      if (b == 0.0 && c > 0.0) return {};
    } else {
      const double discriminant = b * b - 4.0 * a * c;
      if (discriminant <= 0.0) {
        if (a > 0.0) return {};
      } else {
        const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
        const double one = std::min(q / a, c / q), two = std::max(q / a, c / q);
        if (a > 0.0) {
          from(one);
          to(two);
        } else if (std::min(high, one) - low >= high - std::max(low, two)) {
          to(one);  // of the two nappes, the one between the ends
        } else {
          from(two);
        }
      }
    }
    if (!(low < high)) return {};
    ++number;
  }
  ReferenceSpans spans;
  spans.add({low, high, low_face, high_face});
  return spans;
}

ReferenceSpans ReferenceSolid::torus_column(double u, double v) const {
  // In the frame of the torus, t counted from the point of the line nearest its middle:
  // (|p|^2 + R^2 - r^2)^2 <= 4 R^2 (x^2 + y^2).
  const Vec3 d = X_TW_.rotation.col(2);
  Vec3 o = X_TW_ * Vec3(u, v, 0.0);
  const double shift = -o.dot(d), R2 = major_radius_ * major_radius_;
  o += shift * d;
  const double reach = major_radius_ + minor_radius_, square = o.squaredNorm();
  ReferenceSpans spans;
  if (square >= reach * reach) return spans;
  const double level = square + R2 - minor_radius_ * minor_radius_;
  const double p = 2.0 * level - 4.0 * R2 * (1.0 - d.z() * d.z());
  const double q = 8.0 * R2 * o.z() * d.z();
  const double r = level * level - 4.0 * R2 * (square - o.z() * o.z());
  const auto f = [=](double t) { return ((t * t + p) * t + q) * t + r; };
  double ends[5] = {-1.01 * reach};
  const int turns = cubic_roots(p, q, ends + 1);
  ends[turns + 1] = 1.01 * reach;
  double enter = 0.0;
  bool inside = false;
  for (int i = 0; i <= turns; ++i) {
    const bool next_inside = f(ends[i + 1]) < 0.0;
    if (next_inside == inside) continue;
    const double root = quartic_root(p, q, r, ends[i], ends[i + 1]);
    if (inside) spans.add({enter + shift, root + shift, first_face_, first_face_});
    enter = root;
    inside = next_inside;
  }
  return spans;
}

Vec3 ReferenceSolid::normal(int face, const Vec3& x) const {
  switch (kind_) {
    case Kind::kPiece: {
      const ReferenceFace& f = faces_[static_cast<std::size_t>(face - first_face_)];
      return (f.linear + f.hessian * x).normalized();
    }
    case Kind::kTorus: {
      const Vec3 p = X_TW_ * x;
      const double scale = 1.0 - major_radius_ / std::hypot(p.x(), p.y());
      return X_TW_.rotation.transpose() * Vec3(scale * p.x(), scale * p.y(), p.z()).normalized();
    }
    case Kind::kCapsule: {
      const Vec3 p = X_TW_ * x;
      const double z = p.z() - std::clamp(p.z(), -major_radius_, major_radius_);
      return X_TW_.rotation.transpose() * Vec3(p.x(), p.y(), z).normalized();
    }
    default: {
      const bool second = face >= parts_[1].first_face_;
      const Vec3 n = parts_[second ? 1 : 0].normal(face, x);
      return second && kind_ == Kind::kDifference ? Vec3(-n) : n;
    }
  }
}

double ReferenceSolid::side(int face) const {
  if (kind_ == Kind::kUnion || kind_ == Kind::kIntersection || kind_ == Kind::kDifference) {
    return parts_[face >= parts_[1].first_face_ ? 1 : 0].side(face);
  }
  return inverted_ ? -1.0 : 1.0;
}

void ReferenceSolid::invert() {
  inverted_ = !inverted_;
  for (ReferenceSolid& part : parts_) part.invert();
}

std::vector<ReferenceTerm> ReferenceSolid::terms() const {
  if (kind_ != Kind::kUnion && kind_ != Kind::kIntersection && kind_ != Kind::kDifference) {
    return {{1.0, *this}};
  }
  const std::vector<ReferenceTerm> a = parts_[0].terms();
  std::vector<ReferenceTerm> b = parts_[1].terms(), all;
  if (kind_ == Kind::kDifference) {
    for (ReferenceTerm& term : b) term.solid.invert();
  }
  if (kind_ != Kind::kIntersection) all = a;
  if (kind_ == Kind::kUnion) all.insert(all.end(), b.begin(), b.end());
  const double sign = kind_ == Kind::kIntersection ? 1.0 : -1.0;
  for (const ReferenceTerm& x : a) {
    for (const ReferenceTerm& y : b) all.push_back({sign * x.sign * y.sign, x.solid & y.solid});
  }
  return all;
}

bool ReferenceSolid::has_torus() const {
  if (kind_ == Kind::kTorus) return true;
  return std::any_of(parts_.begin(), parts_.end(),
                     [](const ReferenceSolid& part) { return part.has_torus(); });
}

// The most violated of the convex functions that bound the solid, and its gradient.
void ReferenceSolid::cut_at(const Vec3& x, double& worst, Vec3& gradient) const {
  const auto take = [&](double value, const Vec3& slope) {
    const double distance = value / slope.norm();
    if (!(distance > worst)) return;
    worst = distance;
    gradient = slope.normalized();
  };
  if (kind_ == Kind::kCapsule) {
    const Vec3 p = X_TW_ * x;
    const Vec3 d(p.x(), p.y(), p.z() - std::clamp(p.z(), -major_radius_, major_radius_));
    if (d.norm() > 0.0) take(d.norm() - minor_radius_, X_TW_.rotation.transpose() * d.normalized());
    return;
  }
  for (const ReferenceSolid& part : parts_) part.cut_at(x, worst, gradient);
  for (const ReferenceFace& face : faces_) {
    const double value = 0.5 * x.dot(face.hessian * x) + face.linear.dot(x) + face.constant;
    const Vec3 slope = face.linear + face.hessian * x;
    const bool cone = face.nappe_constant != 0.0 || !face.nappe.isZero(0.0);
    if (!cone) {
      if (slope.norm() > 0.0) take(value, slope);
      continue;
    }
    const double radius = face.nappe.dot(x) + face.nappe_constant;
    const double across = std::sqrt(std::max(value + radius * radius, 0.0));
    if (across > 0.0) {
      take(across - radius, (0.5 * slope + radius * face.nappe) / across - face.nappe);
    } else if (radius < 0.0) {
      take(-radius, -face.nappe);
    }
  }
}

ReferenceSolid reference_solid(const Shape& shape) {
  return std::visit([](const auto& solid) { return solid_of(solid); }, shape);
}

}  // namespace volcontact::test
