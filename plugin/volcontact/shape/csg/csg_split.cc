// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/csg/csg_split.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace volcontact {
namespace {

constexpr double kThin = 1e-10;  // share of the size: thinner parts are left away

// The plane in the frame M of the body.
struct Plane {
  Vec3 normal;
  double offset;
};

double height(const SimpleShape& shape, const Vec3& e) {
  return std::visit([&e](const auto& solid) { return solid.support_height(e); }, shape);
}

void split_box(const Box& box, const Pose& X_SM, int axis, const Plane& plane, Split& result) {
  const double sign = plane.normal[axis] > 0.0 ? 1.0 : -1.0;
  const double at = sign * plane.offset, half = box.half_sizes()[axis];
  for (const double side : {-1.0, 1.0}) {
    const double middle = 0.5 * (at + side * half);
    Vec3 half_sizes = box.half_sizes();
    half_sizes[axis] = 0.5 * std::abs(side * half - at);
    Pose X_SP = X_SM;
    X_SP.translation = X_SM * (middle * Vec3::Unit(axis));
    (side * sign < 0.0 ? result.inside : result.outside) =
        PosedShape{Box({.half_sizes = half_sizes}), X_SP};
  }
}

ConvexPolytope as_polytope(const Box& box) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    corners.push_back(box.half_sizes().cwiseProduct(corner_signs(i)));
  }
  return ConvexPolytope(corners);
}

std::optional<PosedShape> cut_polytope(const ConvexPolytope& body, const Pose& X_SM,
                                       const Vec3& normal, double offset, double size) {
  CutPolytope part;
  part.start(body.graph());
  std::copy(body.graph().points.begin(), body.graph().points.end(), part.points().begin());
  part.cut([&](const Vec3& p) { return normal.dot(p) - offset; }, 0, 0.0);
  std::vector<Vec3> points;
  for (const Vec3& p : part.points()) {
    const bool known = std::any_of(points.begin(), points.end(), [&](const Vec3& q) {
      return (p - q).norm() <= kSameFace * size;
    });
    if (!known) points.push_back(p);
  }
  return PosedShape{ConvexPolytope(points), X_SM};
}

void split_polytope(const ConvexPolytope& body, const Pose& X_SM, const Plane& plane, double size,
                    Split& result) {
  try {
    result.inside = cut_polytope(body, X_SM, plane.normal, plane.offset, size);
    result.outside = cut_polytope(body, X_SM, -plane.normal, -plane.offset, size);
  } catch (const std::invalid_argument&) {  // too flat for a hull
    result.possible = false;
  }
}

// A cylinder or frustum across its axis: `make` takes the half length and the radii at the ends.
template <typename Make>
void split_across(double half, double bottom, double top, const Pose& X_SM, const Plane& plane,
                  Split& result, Make&& make) {
  const double sign = plane.normal.z() > 0.0 ? 1.0 : -1.0;
  const double at = sign * plane.offset;
  const double radius = bottom + (top - bottom) * 0.5 * (1.0 + at / half);
  for (const double side : {-1.0, 1.0}) {
    Pose X_SP = X_SM;
    X_SP.translation = X_SM * Vec3(0.0, 0.0, 0.5 * (at + side * half));
    const double new_half = 0.5 * std::abs(side * half - at);
    (side * sign < 0.0 ? result.inside : result.outside) =
        PosedShape{side < 0.0 ? make(new_half, bottom, radius) : make(new_half, radius, top), X_SP};
  }
}

// A round face about the z axis of its frame F, or about a centre.
struct RoundPlace {
  Vec3 center_S;
  Vec3 axis_S;
  bool about_axis;
  bool ball;
};

RoundPlace place_of(const MemberFace& face) {
  const Pose X_SF = face.X_FS.inverse();
  RoundPlace place{X_SF.translation, X_SF.rotation.col(2), true, false};
  if (face.kind == MemberFace::Kind::kCone) return place;
  const Mat3& h = face.quadric.hessian;
  place.ball = (h - h(0, 0) * Mat3::Identity()).norm() <= kSameFace * h.norm();
  place.about_axis = (h * place.axis_S).norm() <= kSameFace * h.norm();
  if (place.ball) place.center_S = -face.quadric.linear / h(0, 0);
  return place;
}

double radius_at(const MemberFace& face, const RoundPlace& place, double z_S) {
  if (face.kind == MemberFace::Kind::kCone) return face.radius + face.slope * z_S;
  // F = w (distance^2 - radius^2).
  const Vec3& p = place.center_S;
  return std::sqrt(std::max(
      0.0, -face.quadric(p) / (0.5 * face.quadric.hessian.trace() / (place.ball ? 3.0 : 2.0))));
}

}  // namespace

Split split(const PosedShape& body, const MemberFace& face, double size) {
  const Pose& X_SM = body.X_SM;
  Plane plane{X_SM.rotation.transpose() * face.quadric.linear, 0.0};
  plane.offset = -face.quadric.constant - face.quadric.linear.dot(X_SM.translation);
  Split result;
  if (height(body.shape, plane.normal) <= plane.offset + kThin * size) {
    result.inside = body;
    return result;
  }
  if (height(body.shape, -plane.normal) <= -plane.offset + kThin * size) {
    result.outside = body;
    return result;
  }
  const Vec3 sizes = plane.normal.cwiseAbs();
  const int axis = sizes.largest();
  const double along = sizes[axis];
  const bool straight = (sizes - along * Vec3::Unit(axis)).norm() <= kSameFace;
  if (const auto* box = std::get_if<Box>(&body.shape)) {
    if (straight) {
      split_box(*box, X_SM, static_cast<int>(axis), plane, result);
    } else {
      split_polytope(as_polytope(*box), X_SM, plane, size, result);
    }
  } else if (const auto* polytope = std::get_if<ConvexPolytope>(&body.shape)) {
    split_polytope(*polytope, X_SM, plane, size, result);
  } else if (const auto* tube = std::get_if<Cylinder>(&body.shape); tube && straight && axis == 2) {
    split_across(tube->half_length(), tube->radius(), tube->radius(), X_SM, plane, result,
                 [](double half, double radius, double) -> SimpleShape {
                   return Cylinder({.radius = radius, .half_length = half});
                 });
  } else if (const auto* cone = std::get_if<Frustum>(&body.shape); cone && straight && axis == 2) {
    split_across(
        cone->params().half_length, cone->params().bottom_radius, cone->params().top_radius, X_SM,
        plane, result, [](double half, double bottom, double top) -> SimpleShape {
          return Frustum({.bottom_radius = bottom, .top_radius = top, .half_length = half});
        });
  } else {
    result.possible = false;
  }
  return result;
}

bool holds_within(const MemberFace& inner, const MemberFace& outer, const PartHull& body,
                  double size) {
  const double slack = kSameFace * size;
  const RoundPlace in = place_of(inner), out = place_of(outer);
  const Vec3 apart = in.center_S - out.center_S;
  if (in.ball && out.ball) {
    return apart.norm() + radius_at(inner, in, 0.0) <= radius_at(outer, out, 0.0) + slack;
  }
  if (!out.about_axis || (out.ball && !in.ball)) return false;
  const double across = (apart - apart.dot(out.axis_S) * out.axis_S).norm();
  if (in.ball) {
    return outer.kind != MemberFace::Kind::kCone &&
           across + radius_at(inner, in, 0.0) <= radius_at(outer, out, 0.0) + slack;
  }
  if (!in.about_axis || in.axis_S.cross(out.axis_S).norm() > kSameFace || !body.bounded()) {
    return false;
  }
  // Both radii change linearly along the axis: compare where the body begins and ends.
  double low = kInfinity, high = -kInfinity;
  for (const Vec3& p : body.points()) {
    low = std::min(low, out.axis_S.dot(p));
    high = std::max(high, out.axis_S.dot(p));
  }
  for (const double s : {low, high}) {
    const double z_in = (s - out.axis_S.dot(in.center_S)) * in.axis_S.dot(out.axis_S);
    const double z_out = s - out.axis_S.dot(out.center_S);
    if (across + radius_at(inner, in, z_in) > radius_at(outer, out, z_out) + slack) return false;
  }
  return true;
}

}  // namespace volcontact
