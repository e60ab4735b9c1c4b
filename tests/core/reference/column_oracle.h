// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "volcontact/base/fields.h"
#include "volcontact/metrics/volume_metrics.h"
#include "volcontact/shape/box.h"
#include "volcontact/shape/half_space.h"
#include "volcontact/shape/polytope/convex_polytope.h"

namespace volcontact::test {

// An oracle that shares nothing with the clip engine: solids are lists of half-spaces, the overlap
// is integrated by nested Gauss quadrature over columns whose ends are exact. Between all places
// where edges of a solid end, or cross in the view along the columns, the integrands are
// polynomials of low degree, so that the quadrature is exact up to rounding.

struct Plane {
  Vec3 normal;
  double offset;
};
using Planes = std::vector<Plane>;

inline Planes planes_of(const HalfSpace&) { return {{Vec3::UnitZ(), 0.0}}; }
inline Planes planes_of(const Box& box) {
  Planes planes;
  for (int i = 0; i < 3; ++i) {
    planes.push_back({Vec3::Unit(i), box.half_sizes()[i]});
    planes.push_back({-Vec3::Unit(i), box.half_sizes()[i]});
  }
  return planes;
}
inline Planes planes_of(const ConvexPolytope& solid) {
  Planes planes;
  for (const auto& face : solid.faces()) planes.push_back({face.normal, face.offset});
  return planes;
}
inline Planes posed(const Planes& planes, const Pose& X) {
  Planes result;
  for (const Plane& p : planes) {
    const Vec3 normal = X.rotation * p.normal;
    result.push_back({normal, p.offset + normal.dot(X.translation)});
  }
  return result;
}

/// Interval of the line o + t d in the intersection of half-spaces.
inline RayInterval interval(const Planes& planes, const Vec3& o, const Vec3& d) {
  RayInterval span{-kInfinity, kInfinity};
  for (const Plane& p : planes) {
    const double speed = p.normal.dot(d), gap = p.offset - p.normal.dot(o);
    if (speed > 0.0) span.leave = std::min(span.leave, gap / speed);
    if (speed < 0.0) span.enter = std::max(span.enter, gap / speed);
    if (speed == 0.0 && gap < 0.0) return {};
  }
  return span;
}

/// Calls add(weight, x) at the nodes of a Gauss rule exact to degree 7 on every interval of
/// `breaks`.
template <typename Add>
void gauss(std::vector<double> breaks, Add&& add) {
  constexpr double kNodes[] = {0.3399810435848563, 0.8611363115940526};
  constexpr double kWeights[] = {0.6521451548625461, 0.3478548451374538};
  std::sort(breaks.begin(), breaks.end());
  for (std::size_t i = 1; i < breaks.size(); ++i) {
    const double middle = 0.5 * (breaks[i] + breaks[i - 1]);
    const double half = 0.5 * (breaks[i] - breaks[i - 1]);
    if (!(half > 0.0)) continue;
    for (int k = 0; k < 2; ++k) {
      for (double sign : {-1.0, 1.0}) add(half * kWeights[k], middle + sign * half * kNodes[k]);
    }
  }
}

struct Edge {
  Vec3 from, to;
};

/// Edges of the intersection of half-spaces, those of finite length.
inline std::vector<Edge> edges_of(const Planes& solid) {
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < solid.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3 &n_i = solid[i].normal, &n_j = solid[j].normal;
      const Vec3 along = n_i.cross(n_j);
      if (along.norm() < 1e-9) continue;
      const Mat3 rows = Mat3::with_rows(n_i, n_j, along);
      const Vec3 o = rows.inverse() * Vec3(solid[i].offset, solid[j].offset, 0.0);
      Planes others;
      for (std::size_t k = 0; k < solid.size(); ++k) {
        if (k != i && k != j) others.push_back(solid[k]);
      }
      const RayInterval span = interval(others, o, along);
      if (span.empty() || !std::isfinite(span.leave - span.enter)) continue;
      edges.push_back({o + span.enter * along, o + span.leave * along});
    }
  }
  return edges;
}

/// An edge seen along the columns.
struct Segment {
  double u_0, v_0, u_1, v_1;
  double at(double u) const { return v_0 + (u - u_0) / (u_1 - u_0) * (v_1 - v_0); }
};

/// Calls add(weight, p, span) at quadrature nodes over the shadow of A and B along the columns
/// p + t z of the frame `R`. Integrands may change where an edge of A, B or their overlap passes.
template <typename Add>
void over_shadow(const Planes& a, const Planes& b, const Planes& both, const Mat3& R, Add&& add) {
  std::vector<Segment> segments;
  for (const Planes* solid : {&a, &b, &both}) {
    for (const Edge& edge : edges_of(*solid)) {
      const Vec3 p = R.transpose() * edge.from, q = R.transpose() * edge.to;
      segments.push_back({p.x(), p.y(), q.x(), q.y()});
    }
  }
  std::vector<double> u_breaks, v_breaks;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment& s = segments[i];
    u_breaks.push_back(s.u_0);
    u_breaks.push_back(s.u_1);
    for (std::size_t j = 0; j < i; ++j) {
      const Segment& t = segments[j];
      const double su = s.u_1 - s.u_0, sv = s.v_1 - s.v_0, tu = t.u_1 - t.u_0, tv = t.v_1 - t.v_0;
      const double det = su * tv - sv * tu;
      if (std::abs(det) < 1e-14) continue;
      const double along = ((t.u_0 - s.u_0) * tv - (t.v_0 - s.v_0) * tu) / det;
      if (along > 0.0 && along < 1.0) u_breaks.push_back(s.u_0 + along * su);
    }
  }
  gauss(u_breaks, [&](double u_weight, double u) {
    v_breaks.clear();
    for (const Segment& s : segments) {
      if ((s.u_0 < u) != (s.u_1 < u)) v_breaks.push_back(s.at(u));
    }
    gauss(v_breaks, [&](double v_weight, double v) {
      const Vec3 p = R * Vec3(u, v, 0.0);
      const RayInterval span = interval(both, p, R.col(2));
      if (!span.empty()) add(u_weight * v_weight, p, span);
    });
  });
}

inline Planes joined(const Planes& a, const Planes& b) {
  Planes all = a;
  all.insert(all.end(), b.begin(), b.end());
  return all;
}

/// Area of the part of a face plane that lies in a solid, and the integral of x over it.
struct FaceArea {
  double area = 0.0;
  Vec3 first = Vec3::Zero();
};
inline FaceArea face_area(const Plane& face, const Planes& inside) {
  const Mat3 R = basis_with_z(face.normal);
  const Vec3 on_plane = face.offset * face.normal;
  std::vector<double> u_breaks;
  Planes lines;  // in the plane: x u + y v <= offset
  for (const Plane& p : inside) {
    const Vec3 n = R.transpose() * p.normal;
    lines.push_back({Vec3(n.x(), n.y(), 0.0), p.offset - p.normal.dot(on_plane)});
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3 &a = lines[i].normal, &b = lines[j].normal;
      const double det = a.x() * b.y() - a.y() * b.x();
      if (std::abs(det) < 1e-9) continue;
      u_breaks.push_back((lines[i].offset * b.y() - a.y() * lines[j].offset) / det);
    }
  }
  FaceArea sum;
  gauss(u_breaks, [&](double weight, double u) {
    const RayInterval span = interval(lines, Vec3(u, 0, 0), Vec3::UnitY());
    if (span.empty()) return;
    const double length = span.leave - span.enter, middle = 0.5 * (span.leave + span.enter);
    sum.area += weight * length;
    sum.first += weight * length * (on_plane + R * Vec3(u, middle, 0.0));
  });
  return sum;
}

/// Ends of all edges of the intersection of half-spaces.
inline std::vector<Vec3> corners_of(const Planes& solid) {
  std::vector<Vec3> corners;
  for (const Edge& edge : edges_of(solid)) corners.insert(corners.end(), {edge.from, edge.to});
  return corners;
}
inline Vec3 corner_of(const Planes& solid) {
  const std::vector<Vec3> corners = corners_of(solid);
  return corners.empty() ? Vec3(Vec3::Zero()) : corners[0];
}
inline double extent_along(const Planes& solid, const Vec3& n) {
  double low = kInfinity, high = -kInfinity;
  for (const Vec3& p : corners_of(solid)) {
    low = std::min(low, n.dot(p));
    high = std::max(high, n.dot(p));
  }
  return std::max(0.0, high - low);
}

/// Metrics of the overlap of A with B at X_AB, for solids with plane faces in general position.
template <typename A, typename B>
VolumeMetrics oracle(const A& a, const B& b, const Pose& X_AB) {
  const Planes planes_a = planes_of(a), planes_b = posed(planes_of(b), X_AB);
  const Planes both = joined(planes_a, planes_b);
  MomentSum sum;
  for (const Plane& face : planes_a) {
    Planes rest = both;
    std::erase_if(
        rest, [&](const Plane& p) { return p.normal == face.normal && p.offset == face.offset; });
    const FaceArea f = face_area(face, rest);
    sum.area += f.area;
    sum.area_vector += f.area * face.normal;
    sum.area_moment += f.first.cross(face.normal);
  }
  for (const Plane& face : planes_b) {
    Planes rest = both;
    std::erase_if(
        rest, [&](const Plane& p) { return p.normal == face.normal && p.offset == face.offset; });
    sum.counter_area += face_area(face, rest).area;
  }
  // Columns along the contact normal, from B to A.
  const double length = sum.area_vector.norm();
  const Vec3 n = length > 0.0 ? Vec3(-sum.area_vector / length) : Vec3::UnitZ();
  const Mat3 R = basis_with_z(n);
  const Vec3 origin = corner_of(both);  // near the overlap: sums from afar would lose digits
  double depth_moment = 0.0;
  const auto add_column = [&](double weight, const Vec3& p, const RayInterval& span) {
    const double l = span.leave - span.enter, middle = 0.5 * (span.leave + span.enter);
    const Vec3 x = p + middle * n - origin;
    sum.volume += weight * l;
    sum.first += weight * l * x;
    sum.second += weight * l * (outer(x, x) + l * l / 12.0 * outer(n, n));
    const double top_b = interval(planes_b, p, n).leave;
    const double bottom_a = interval(planes_a, p, n).enter;
    depth_moment += weight * l * ((top_b - bottom_a) - 0.5 * l);
  };
  over_shadow(planes_a, planes_b, both, R, add_column);
  VolumeMetrics m = sum.metrics();
  m.centroid += origin;
  m.depth_moment = depth_moment;
  m.depth = extent_along(both, n);
  return m;
}

}  // namespace volcontact::test
