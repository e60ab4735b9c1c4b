// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/in_round/round_solid.h"

#include <algorithm>
#include <cmath>

namespace volcontact {
namespace {

constexpr double kRounding = 1e-14;  // of a sum, per summand
constexpr double kOnWall = 1e-9;     // of the solid's size

Vec3 mapped(const RoundSolid& s, const Vec3& x) {
  Vec3 y;
  for (int i = 0; i < 3; ++i) {
    y[i] = s.map[i][0] * x[0] + s.map[i][1] * x[1] + s.map[i][2] * x[2];
  }
  return y;
}
Vec3 mapped_back(const RoundSolid& s, const Vec3& y) {
  Vec3 x;
  for (int i = 0; i < 3; ++i) {
    x[i] = s.map[0][i] * y[0] + s.map[1][i] * y[1] + s.map[2][i] * y[2];
  }
  return x;
}

// Where |o + t e| < 1, from the nearest point on: no cancellation for far origins.
RayInterval in_unit_ball(const Vec3& o, const Vec3& e) {
  const double a = e.squaredNorm();
  if (!(a > 0.0)) {
    return o.squaredNorm() < 1.0 ? RayInterval{-kInfinity, kInfinity} : RayInterval{};
  }
  const double middle = -o.dot(e) / a;
  const double reach = 1.0 - (o + middle * e).squaredNorm();
  if (!(reach > 0.0)) return {};
  const double half = std::sqrt(reach / a);
  return {middle - half, middle + half};
}

// Where |(y_x, y_y)| < y_z on o + t e.
RayInterval in_cone(const Vec3& o, const Vec3& e) {
  const auto times = [](const Vec3& p, const Vec3& q) {
    return p.x() * q.x() + p.y() * q.y() - p.z() * q.z();
  };
  const double a = times(e, e), b = times(o, e), c = times(o, o);
  const double square = b * b - a * c;
  const auto opens = [&](double t) { return o.z() + t * e.z() > 0.0; };
  if (a > 0.0) {
    if (!(square > 0.0) || !opens(-b / a)) return {};
    const double half = std::sqrt(square) / a;
    return {-b / a - half, -b / a + half};
  }
  // Steeper than the wall: from one root on for ever. q / a and c / q are the roots.
  const double q = -(b + std::copysign(std::sqrt(std::max(0.0, square)), b));
  const double far = a < 0.0 ? q / a : (e.z() > 0.0 ? -kInfinity : kInfinity);
  const double near = q != 0.0 ? c / q : 0.0;
  return e.z() > 0.0 ? RayInterval{std::max(near, far), kInfinity}
                     : RayInterval{-kInfinity, std::min(near, far)};
}

}  // namespace

bool round_solid_of(const ConvexView& b, const Pose& X_QB, FaceSet& faces, RoundSolid& solid) {
  faces.clear();
  FaceWriter writer(faces, X_QB, Owner::kB);
  b.write_faces(writer);
  if (faces.rounds.empty() || faces.planes.size() > 2) return false;
  const bool capsule = faces.capsule[1].present;
  const RoundFace& face = capsule ? faces.rounds[1] : faces.rounds[0];
  solid = RoundSolid{};
  solid.cone = face.cone;
  for (const PlaneFace& plane : faces.planes) {
    const int k = solid.plane_count++;
    const Rim& rim = faces.rims[k];
    for (int i = 0; i < 3; ++i) {
      solid.normal[k][i] = plane.normal[i];
      solid.rim_center[k][i] = rim.center[i];
    }
    solid.rim_radius[k] = rim.radius_u.norm();
    solid.size = std::max(solid.size, solid.rim_radius[k]);
    solid.offset[k] = plane.offset;
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) solid.map[i][j] = face.map(i, j);
    solid.center[i] = capsule ? faces.capsule[1].center[i] : face.center[i];
    solid.axis[i] = capsule ? faces.capsule[1].axis[i] : 0.0;
  }
  if (capsule) solid.half_length = faces.capsule[1].half_length;
  if (solid.plane_count == 0) solid.size = 1.0 / face.map.cwiseAbs().maxCoeff();
  solid.wall_level = -kOnWall * solid.size * face.map.norm();
  solid.has_axis = capsule || solid.plane_count > 0;
  if (solid.has_axis) solid.axis_direction = X_QB.rotation.col(2);
  return true;
}

RayInterval round_interval(const RoundSolid& s, const Vec3& o, const Vec3& d) {
  const Vec3 from = o - Vec3::from(s.center);
  if (s.cone) return in_cone(mapped(s, from), mapped(s, d));
  if (s.half_length == 0.0) return in_unit_ball(mapped(s, from), mapped(s, d));
  // A capsule: the hull of its tube and its balls.
  const Vec3 axis = Vec3::from(s.axis);
  RayInterval hull;
  const auto join = [&hull](const RayInterval& part) {
    if (part.empty()) return;
    hull = hull.empty()
               ? part
               : RayInterval{std::min(hull.enter, part.enter), std::max(hull.leave, part.leave)};
  };
  const double along = axis.dot(from), slope = axis.dot(d);
  RayInterval tube = in_unit_ball(mapped(s, from - along * axis), mapped(s, d - slope * axis));
  if (!tube.empty() && slope != 0.0) {
    const double one = (-s.half_length - along) / slope, two = (s.half_length - along) / slope;
    tube = {std::max(tube.enter, std::min(one, two)), std::min(tube.leave, std::max(one, two))};
  } else if (std::abs(along) > s.half_length) {
    tube = {};
  }
  join(tube);
  join(in_unit_ball(mapped(s, from - s.half_length * axis), mapped(s, d)));
  join(in_unit_ball(mapped(s, from + s.half_length * axis), mapped(s, d)));
  return hull;
}

double round_level(const RoundSolid& s, const Vec3& x, Vec3& gradient) {
  Vec3 from = x - Vec3::from(s.center);
  if (s.half_length > 0.0) {
    const Vec3 axis = Vec3::from(s.axis);
    from -= std::clamp(axis.dot(from), -s.half_length, s.half_length) * axis;
  }
  Vec3 y = mapped(s, from);
  const double height = y.z();
  if (s.cone) y.z() = 0.0;
  const double length = y.norm();
  if (length > 0.0) y /= length;
  if (s.cone) y.z() = -1.0;
  gradient = mapped_back(s, y);
  return s.cone ? length - height : length - 1.0;
}

double least_round_level(const RoundSolid& s, const Vec3 (&corner)[3], const Vec3& normal) {
  const Vec3 center = Vec3::from(s.center);
  const double height = std::abs(normal.dot(corner[0] - center));
  const Mat3 map = Mat3::from_rows(s.map[0]);
  if (s.cone) {
    // At every height above the tip, how near the plane comes to the axis.
    const Vec3 n = map.transpose().inverse() * normal;
    const double offset = n.dot(map * (corner[0] - center)), across = n.head<2>().norm();
    double low = kInfinity, high = -kInfinity;
    for (const Vec3& p : corner) {
      const double z = map.row(2).dot(p - center);
      low = std::min(low, z);
      high = std::max(high, z);
    }
    if (!(across > 0.0)) return -high;
    // Of a plane across the axis `off` is a difference, and little more than its rounding.
    const auto least_at = [&](double z) {
      const double off = std::abs(offset - n.z() * z);
      const double rounding = kRounding * (std::abs(offset) + std::abs(n.z() * z));
      return std::max(0.0, off - rounding) / across - z;
    };
    double least = std::min(least_at(low), least_at(high));
    if (n.z() != 0.0) least = std::min(least, least_at(std::clamp(offset / n.z(), low, high)));
    return least;
  }
  if (!s.has_axis) return height / (map.transpose().inverse() * normal).norm() - 1.0;
  // Of a tube within the reach of the triangle, of a capsule between its ends.
  const double lean = normal.dot(s.axis_direction);
  double reach = s.half_length;
  if (reach == 0.0) {
    for (const Vec3& p : corner) {
      reach = std::max(reach, std::abs(s.axis_direction.dot(p - center)));
    }
  }
  const double radius = 1.0 / row_lengths(map).maxCoeff();
  const double across = s.half_length > 0.0 ? 1.0 : std::sqrt(std::max(0.0, 1.0 - lean * lean));
  const double nearest = std::max(0.0, height - std::abs(lean) * reach);
  return across > 0.0 ? nearest / (radius * across) - 1.0 : -1.0;
}

}  // namespace volcontact
