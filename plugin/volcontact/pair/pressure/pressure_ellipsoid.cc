// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/pressure/pressure_ellipsoid.h"

#include <algorithm>
#include <cmath>

#include "volcontact/pair/pressure/triangles_near.h"
#include "volcontact/pair/quadrature/outer_rule.h"
#include "volcontact/pair/quadrature/triangle_rule.h"

namespace volcontact {
namespace {

constexpr double kSmall = 0.1;        // sides of a triangle for a rule of degree 5, in unit balls
constexpr double kPieceOfEdge = 1.5;  // as log of the distance from the disc's middle
constexpr double kPieceOfArc = 1.0;   // [rad]
constexpr double kNoArea = 1e-13;     // of a fan, in unit balls

/// What presses on one triangle.
struct Pressed {
  double force = 0.0;          ///< int d dA
  Vec3 moment = Vec3::Zero();  ///< int x d dA
  double flux = 0.0;           ///< of the field whose divergence is d
};

class EllipsoidField {
 public:
  EllipsoidField(const Ellipsoid& solid, const Vec3& source)
      : a_(solid.semi_axes()),
        per_a_(a_.cwiseInverse()),
        per_square_(1.0 / (a_.minCoeff() * a_.minCoeff())),
        source_(source.cwiseProduct(per_a_)) {}

  /// Of the part of the triangle that is in the solid, in the solid's frame.
  Pressed on(const Vec3& p, const Vec3& q, const Vec3& r) {
    sum_ = {};
    const Vec3 twice = (q - p).cross(r - p);
    const Vec3 y[3] = {p.cwiseProduct(per_a_), q.cwiseProduct(per_a_), r.cwiseProduct(per_a_)};
    const Vec3 twice_unit = (y[1] - y[0]).cross(y[2] - y[0]);
    const double length = twice_unit.norm();
    if (!(length > 0.0) || !(twice.norm() > 0.0)) return {};
    n_ = twice.normalized();
    stretch_ = twice.norm() / length;  // of areas
    const Vec3 up = twice_unit / length;
    const double height = up.dot(y[0]);
    if (std::abs(height) >= 1.0) return {};
    middle_ = height * up;
    rho_ = std::sqrt((1.0 - height) * (1.0 + height));
    if (is_small_inside(y)) {
      add_small(y, 0.5 * length);
    } else {
      const Mat3 basis = basis_with_z(up);
      u_ = basis.col(0), v_ = basis.col(1);
      Vec2 corner[3];
      for (int i = 0; i < 3; ++i) {
        const Vec3 offset = y[i] - middle_;
        corner[i] = {u_.dot(offset), v_.dot(offset)};
      }
      if (misses_disc(corner)) return {};
      for (int i = 0; i < 3; ++i) add_sections(corner[i], corner[(i + 1) % 3]);
    }
    return sum_;
  }

  /// int d dV over the whole solid.
  double whole() const {
    using Rule = GaussRule<8>;
    double sum = 0.0;
    for (int i = 0; i < 512; ++i) {
      const double r = Rule::kNodes[i & 7], z = Rule::kNodes[(i >> 3) & 7];
      const double angle = 0.5 * kPi * Rule::kNodes[i >> 6], s = std::sqrt(1.0 - z * z);
      const Vec3 y = r * Vec3(s * std::cos(angle), s * std::sin(angle), z);
      sum += Rule::kWeights[i & 7] * Rule::kWeights[(i >> 3) & 7] * Rule::kWeights[i >> 6] * r * r *
             depth(y);
    }
    return 4.0 * kPi * a_.prod() * sum;
  }

 private:
  // As depth_in(), at a place y of the unit ball.
  double depth(const Vec3& y) const {
    const double deficit = std::max(0.0, 1.0 - y.squaredNorm());
    const double m2 = y.cwiseProduct(per_a_).squaredNorm();
    const double root = std::sqrt(m2 + deficit * per_square_);
    return root > 0.0 ? deficit / (std::sqrt(m2) + root) : 0.0;
  }

  // With the weight of the area in the unit ball.
  void add_point(const Vec3& y, double weight) {
    const Vec3 x = y.cwiseProduct(a_);
    const double area = weight * stretch_, pressure = area * depth(y);
    sum_.force += pressure;
    sum_.moment += pressure * x;
    // The field points to the source: -e / rho^2 int_rho^R d r^2 dr, in lengths of the unit ball.
    const Vec3 ray = y - source_;
    const double rho2 = ray.squaredNorm(), b = ray.dot(y), c = 1.0 - y.squaredNorm();
    if (!(rho2 > 0.0) || !(c > 0.0)) return;
    const double beyond = c / (b + std::sqrt(b * b + rho2 * c));  // of the ray's length
    using Rule = GaussRule<5>;
    double inner = 0.0;
    for (int i = 0; i < 5; ++i) {
      const double t = 1.0 + Rule::kNodes[i] * beyond;
      inner += Rule::kWeights[i] * beyond * t * t * depth(source_ + t * ray);
    }
    sum_.flux -= area * n_.dot(ray.cwiseProduct(a_)) * inner;
  }

  bool is_small_inside(const Vec3 (&y)[3]) const {
    for (int i = 0; i < 3; ++i) {
      if (y[i].squaredNorm() > 1.0) return false;
      if ((y[(i + 1) % 3] - y[i]).squaredNorm() > kSmall * kSmall) return false;
    }
    return true;
  }

  void add_small(const Vec3 (&y)[3], double area) {
    using namespace triangle_rule;
    add_point((y[0] + y[1] + y[2]) / 3.0, area * kMiddleWeight);
    const Vec3 all = y[0] + y[1] + y[2];
    for (const Vec3& corner : y) {
      add_point(kOuter * all + (kOuterCorner - kOuter) * corner, area * kOuterWeight);
      add_point(kInner * all + (kInnerCorner - kInner) * corner, area * kInnerWeight);
    }
  }

  // Counterclockwise corners, about the middle of the disc.
  bool misses_disc(const Vec2 (&corner)[3]) const {
    bool beyond = false;
    double nearest = kInfinity;
    for (int i = 0; i < 3; ++i) {
      const Vec2 p = corner[i], along = corner[(i + 1) % 3] - p;
      const double cross = p.x() * along.y() - p.y() * along.x();
      beyond |= cross < 0.0;
      const double t = std::clamp(-p.dot(along) / along.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (p + t * along).norm());
    }
    return beyond && nearest >= rho_;
  }

  // The part of the disc between its middle and an edge, with the sign of its turn.
  void add_sections(const Vec2& p, const Vec2& q) {
    const double cross = p.x() * q.y() - p.y() * q.x(), length = (q - p).norm();
    if (std::abs(cross) < kNoArea) return;
    sign_ = cross > 0.0 ? 1.0 : -1.0;
    const Vec2 along = (q - p) / length;
    const double from = p.dot(along), to = q.dot(along);
    const Vec2 foot = p - from * along;
    away_ = foot.norm();
    along_ = along.x() * u_ + along.y() * v_;
    foot_ = (foot.x() * u_ + foot.y() * v_) / away_;
    const double half = away_ < rho_ ? std::sqrt((rho_ - away_) * (rho_ + away_)) : 0.0;
    const double low = std::clamp(from, -half, half), high = std::clamp(to, -half, half);
    add_arc(std::atan2(from, away_), std::atan2(std::min(to, std::max(from, low)), away_));
    if (half > 0.0 && high > low) add_chord(std::asinh(low / away_), std::asinh(high / away_));
    add_arc(std::atan2(std::max(from, std::min(to, high)), away_), std::atan2(to, away_));
  }

  template <typename Add>
  static void in_pieces(double from, double to, double piece, Add&& add) {
    using Rule = GaussRule<8>;
    const int count = static_cast<int>(std::ceil((to - from) / piece));
    for (int k = 0; k < count; ++k) {
      const double width = (to - from) / count, start = from + k * width;
      for (int i = 0; i < 8; ++i) add(start + Rule::kNodes[i] * width, Rule::kWeights[i] * width);
    }
  }

  void add_arc(double from, double to) {
    in_pieces(from, to, kPieceOfArc, [&](double angle, double weight) {
      add_radius(std::cos(angle) * foot_ + std::sin(angle) * along_, rho_, weight);
    });
  }

  // At w the edge is cosh w times as far from the middle as at its foot.
  void add_chord(double from, double to) {
    in_pieces(from, to, kPieceOfEdge, [&](double w, double weight) {
      const double cosh = std::cosh(w);
      add_radius((foot_ + std::sinh(w) * along_) / cosh, away_ * cosh, weight / cosh);
    });
  }

  void add_radius(const Vec3& direction, double length, double weight) {
    using Rule = GaussRule<8>;
    for (int i = 0; i < 8; ++i) {
      const double r = Rule::kNodes[i] * length;
      add_point(middle_ + r * direction, sign_ * weight * Rule::kWeights[i] * length * r);
    }
  }

  Vec3 a_, per_a_;
  double per_square_;
  Vec3 source_;
  // Of the triangle at hand, and of its edge.
  Vec3 n_, middle_, u_, v_, foot_, along_;
  double stretch_ = 0.0, rho_ = 0.0, away_ = 0.0, sign_ = 0.0;
  Pressed sum_;
};

// Where the field comes from: a point of the ellipsoid far from the surface of the mesh.
struct Source {
  Vec3 point;
  bool in_mesh;
};

Source choose_source(const Ellipsoid& solid, const Mesh& mesh, const Pose& X_ME, const Vec3& out) {
  constexpr double kShares[] = {0.0, 0.3, -0.3, 0.6, -0.6, 0.9};  // of the way to the surface
  const double reach = out.isZero(0.0) ? 0.0 : 1.0 / out.cwiseQuotient(solid.semi_axes()).norm();
  Source best{Vec3::Zero(), true};
  double farthest = -1.0;
  for (const double share : kShares) {
    const Vec3 point = share * reach * out;
    const double outside = mesh.signed_distance(X_ME * point);
    if (std::abs(outside) > farthest) farthest = std::abs(outside), best = {point, outside < 0.0};
  }
  return best;
}

}  // namespace

PressureField pressure_ellipsoid(const Shape& a, const Shape& b, const Pose& X_AB,
                                 const PressureSite& site, PressureScratch& scratch) {
  const bool a_carries = std::holds_alternative<Ellipsoid>(a);
  const Ellipsoid& solid = std::get<Ellipsoid>(a_carries ? a : b);
  const Mesh& mesh = std::get<Mesh>(a_carries ? b : a);
  const Pose X_EM = a_carries ? X_AB : X_AB.inverse();
  const Pose X_AE = a_carries ? Pose{} : X_AB;
  const Vec3 normal = (a_carries ? 1.0 : -1.0) * site.metrics().normal();  // on the ellipsoid
  const Source source =
      choose_source(solid, mesh, X_EM.inverse(), X_AE.rotation.transpose() * normal);
  EllipsoidField of_solid(solid, source.point);

  PressureField field;  // on the ellipsoid, in its frame; the couple about its origin
  visit_triangles_near(
      mesh, X_EM, scratch.stack, [&](const Vec3& x) { return solid.signed_distance(x); },
      [&](const Vec3& p, const Vec3& q, const Vec3& r) {
        const Pressed pressed = of_solid.on(p, q, r);
        if (!(pressed.force > 0.0)) return;
        const Vec3 place = X_AE * (pressed.moment / pressed.force);
        if (site.sites.size() > 1 && site.nearest(place) != site.index) return;
        const Vec3 n = (q - p).cross(r - p).normalized();
        field.energy += pressed.flux;
        field.force += pressed.force * n;
        field.couple += pressed.moment.cross(n);
      });
  if (source.in_mesh && site.nearest(X_AE * source.point) == site.index) {
    field.energy += of_solid.whole();
  }
  return field_on_a(field, X_AE, a_carries, site.metrics().centroid);
}

}  // namespace volcontact
