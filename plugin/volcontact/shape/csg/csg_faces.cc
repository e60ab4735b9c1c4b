// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/csg/csg_faces.h"

#include <algorithm>
#include <cmath>

namespace volcontact {
namespace {

constexpr int kFrankWolfeSteps = 200;

// Unit normals whose tangent planes wrap a round shape closely, besides those of its box.
std::vector<Vec3> wrapping_normals(bool about_axis) {
  std::vector<Vec3> normals;
  if (about_axis) {
    for (int i = 0; i < 24; ++i) {
      const double angle = 2.0 * kPi * (i + 0.5) / 24.0;
      normals.emplace_back(std::cos(angle), std::sin(angle), 0.0);
    }
    return normals;
  }
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (std::abs(x) + std::abs(y) + std::abs(z) < 2) continue;
        normals.push_back(Vec3(x, y, z).normalized());
      }
    }
  }
  return normals;
}

MemberFace plane_face(const Quadric& face_M, const Pose& X_SM, const Pose& X_MS) {
  MemberFace face;
  const double length = face_M.linear.norm();
  const Vec3 normal = X_SM.rotation * (face_M.linear / length);
  const double offset = -face_M.constant / length + normal.dot(X_SM.translation);
  face.quadric = Quadric::plane(normal, offset);
  face.X_FS = X_MS;
  face.seam = face_M.seam;
  return face;
}

// Planes around sum_i w_i (x_i - c_i)^2 <= level, in the frame S.
std::vector<Quadric> planes_around(const Vec3& weights, const Vec3& center, double level,
                                   const Pose& X_SM) {
  std::vector<Quadric> planes;
  for (const Vec3& e : wrapping_normals(weights.z() == 0.0)) {
    double reach2 = 0.0;
    for (int i = 0; i < 3; ++i) reach2 += e[i] != 0.0 ? level * e[i] * e[i] / weights[i] : 0.0;
    const Vec3 normal = X_SM.rotation * e;
    planes.push_back(
        Quadric::plane(normal, e.dot(center) + std::sqrt(reach2) + normal.dot(X_SM.translation)));
  }
  return planes;
}

MemberFace round_face(const Quadric& face_M, const SimpleShape& shape, const Pose& X_SM,
                      const Pose& X_MS) {
  MemberFace face;
  face.quadric = transformed(face_M, X_MS);
  face.X_FS = X_MS;
  if (face_M.bend == Bend::kCone) {
    const Frustum::Params& p = std::get<Frustum>(shape).params();
    face.kind = MemberFace::Kind::kCone;
    face.radius = 0.5 * (p.bottom_radius + p.top_radius);
    face.slope = 0.5 * (p.top_radius - p.bottom_radius) / p.half_length;
    return face;
  }
  face.kind = MemberFace::Kind::kRound;
  const Vec3 weights = 0.5 * face_M.hessian.diagonal();
  Vec3 center = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    if (weights[i] > 0.0) center[i] = -0.5 * face_M.linear[i] / weights[i];
  }
  const double level = -face_M(center);
  face.steepness = 2.0 * std::sqrt(level * weights.maxCoeff());
  face.wrap = planes_around(weights, center, level, X_SM);
  return face;
}

}  // namespace

double MemberFace::value(const Vec3& x) const {
  if (kind != Kind::kCone) return quadric(x);
  const Vec3 p = X_FS * x;
  return std::hypot(p.x(), p.y()) - radius - slope * p.z();
}

Vec3 MemberFace::slope_at(const Vec3& x) const {
  if (kind != Kind::kCone) return quadric.linear + quadric.hessian * x;
  const Vec3 p = X_FS * x;
  const double across = std::hypot(p.x(), p.y());
  const Vec3 outward = across > 0.0 ? Vec3(p.x() / across, p.y() / across, 0.0) : Vec3::Zero();
  return X_FS.rotation.transpose() * (outward - slope * Vec3::UnitZ());
}

bool MemberFace::same_as(const MemberFace& other, double size) const {
  if ((kind == Kind::kPlane) != (other.kind == Kind::kPlane)) return false;
  if (kind == Kind::kPlane) {
    return (quadric.linear - other.quadric.linear).norm() <= kSameFace &&
           std::abs(quadric.constant - other.quadric.constant) <= kSameFace * size;
  }
  // Equal coefficients after scaling; the cone's sign of the slope is lost, which costs nothing.
  const double unit = quadric.hessian.norm(), other_unit = other.quadric.hessian.norm();
  const Mat3 h = quadric.hessian / unit - other.quadric.hessian / other_unit;
  const Vec3 g = quadric.linear / unit - other.quadric.linear / other_unit;
  const double k = quadric.constant / unit - other.quadric.constant / other_unit;
  return h.norm() <= kSameFace && g.norm() <= kSameFace * size &&
         std::abs(k) <= kSameFace * size * size;
}

std::vector<std::vector<MemberFace>> member_faces(const SimpleShape& shape, const Pose& X_SM) {
  const Pose X_MS = X_SM.inverse();
  PieceList list;
  std::visit(
      [&list](const auto& solid) {
        if constexpr (HasPieces<std::decay_t<decltype(solid)>>) {
          if (solid.own_metrics().volume > 0.0) add_pieces(solid, list);
        }
      },
      shape);
  std::vector<std::vector<MemberFace>> parts;
  for (int i = 0; i < list.size(); ++i) {
    std::vector<MemberFace> faces;
    for (const Quadric* face = list.begin(i); face != list.end(i); ++face) {
      if (face->bend == Bend::kFlat) faces.push_back(plane_face(*face, X_SM, X_MS));
    }
    for (const Quadric* face = list.begin(i); face != list.end(i); ++face) {
      if (face->bend != Bend::kFlat) faces.push_back(round_face(*face, shape, X_SM, X_MS));
    }
    parts.push_back(std::move(faces));
  }
  return parts;
}

PartHull::PartHull(const SimpleShape& shape, const Pose& X_SM) {
  std::visit(
      [&](const auto& solid) {
        const Aabb box = solid.bounds();
        bounded_ = box.bounded();
        if (!bounded_) return;
        polytope_.start(box_graph());
        const Vec3 half = box.half_sizes();
        for (int i = 0; i < 8; ++i) {
          polytope_.points()[i] = X_SM * (box.center() + half.cwiseProduct(corner_signs(i)));
        }
        using S = std::decay_t<decltype(solid)>;
        if constexpr (std::is_same_v<S, ConvexPolytope>) {
          for (const ConvexPolytope::Face& face : solid.faces()) {
            const Vec3 normal = X_SM.rotation * face.normal;
            cut(normal, face.offset + normal.dot(X_SM.translation));
          }
        } else if constexpr (!std::is_same_v<S, Box>) {
          const bool about_axis = std::is_same_v<S, Cylinder> || std::is_same_v<S, Frustum>;
          for (const Vec3& e : wrapping_normals(about_axis)) {
            const Vec3 normal = X_SM.rotation * e;
            cut(normal, solid.support_height(e) + normal.dot(X_SM.translation));
          }
        }
      },
      shape);
}

double PartHull::most(const MemberFace& face) const {
  if (!bounded_) return kInfinity;
  double most = -kInfinity;
  for (const Vec3& p : points()) most = std::max(most, face.value(p));
  return most;
}

// Frank-Wolfe with line search: the tangent plane at any point bounds a convex function from below.
bool PartHull::stays_above(const MemberFace& face, double level) const {
  if (!bounded_) return false;
  if (empty()) return true;
  if (face.kind == MemberFace::Kind::kPlane) {
    return std::all_of(points().begin(), points().end(),
                       [&](const Vec3& p) { return face.value(p) >= level; });
  }
  Vec3 x = Vec3::Zero();
  for (const Vec3& p : points()) x += p / polytope_.size();
  for (int step = 0; step < kFrankWolfeSteps; ++step) {
    const double value = face.value(x);
    if (value < level) return false;
    const Vec3 slope = face.slope_at(x);
    Vec3 best = points()[0];
    for (const Vec3& p : points()) {
      if (slope.dot(p) < slope.dot(best)) best = p;
    }
    if (value + std::min(0.0, slope.dot(best - x)) >= level) return true;
    // The convex function along the way, by golden section.
    const Vec3 way = best - x;
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 40; ++i) {
      const double a = low + 0.381966 * (high - low), b = high - 0.381966 * (high - low);
      if (face.value(x + a * way) < face.value(x + b * way)) {
        high = b;
      } else {
        low = a;
      }
    }
    x += 0.5 * (low + high) * way;
  }
  return false;
}

void PartHull::cut(const Vec3& normal, double offset) {
  if (!bounded_ || empty()) return;
  polytope_.cut([&](const Vec3& p) { return normal.dot(p) - offset; }, 0, 0.0);
}

void PartHull::cut(const MemberFace& plane, bool inside) {
  const double sign = inside ? 1.0 : -1.0;
  cut(sign * plane.quadric.linear, -sign * plane.quadric.constant);
}

void PartHull::cut_round(const MemberFace& face) {
  for (const Quadric& plane : face.wrap) cut(plane.linear, -plane.constant);
}

double size_of(const Csg& solid) {
  double size = 0.0;
  for (const Csg::Member& member : solid.members()) {
    size = std::max(size, member.X_SM.translation.norm());
    const Aabb box = std::visit([](const auto& shape) { return shape.bounds(); }, member.shape);
    if (box.bounded()) size = std::max(size, box.half_sizes().norm());
  }
  return size > 0.0 ? size : 1.0;
}

}  // namespace volcontact
