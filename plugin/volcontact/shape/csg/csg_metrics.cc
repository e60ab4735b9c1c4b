// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/csg/csg_metrics.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "volcontact/shape/csg/csg_carved.h"

namespace volcontact {
namespace {

// Moments about the origin of S.
MomentSum moments_of(const SimpleShape& shape, const Pose& X_SM, double sign) {
  const VolumeMetrics m =
      transformed(std::visit([](const auto& solid) { return solid.own_metrics(); }, shape), X_SM);
  MomentSum sum;
  sum.volume = sign * m.volume;
  sum.first = sign * m.volume * m.centroid;
  sum.second = sign * (m.second_moment() + outer(m.volume * m.centroid, m.centroid));
  return sum;
}

// Ends along the z axis of a round face's frame F of the planes of a body across that axis.
struct Ends {
  double low = -kInfinity, high = kInfinity;
};

Ends ends_across(const std::vector<MemberFace>& body, const Pose& X_SF) {
  Ends ends;
  const Vec3 axis = X_SF.rotation.col(2);
  for (const MemberFace& face : body) {
    if (face.kind != MemberFace::Kind::kPlane) continue;
    if (face.quadric.linear.cross(axis).norm() > kSameFace) continue;
    const double at = -face.quadric.constant - face.quadric.linear.dot(X_SF.translation);
    if (face.quadric.linear.dot(axis) > 0.0) {
      ends.high = std::min(ends.high, at);
    } else {
      ends.low = std::max(ends.low, -at);
    }
  }
  return ends;
}

bool is_ball(const MemberFace& face) {
  const Mat3& h = face.quadric.hessian;
  return face.kind == MemberFace::Kind::kRound &&
         (h - h(0, 0) * Mat3::Identity()).norm() <= kSameFace * h.norm();
}

bool is_about_axis(const MemberFace& face) {
  const Mat3& h = face.quadric.hessian;
  return face.kind == MemberFace::Kind::kCone ||
         (h * face.X_FS.rotation.row(2)).norm() <= kSameFace * h.norm();
}

// What a round face cuts out of a body, where that is a ball, cylinder or frustum that touches no
// other face of the body; else nothing.
std::optional<PosedShape> plug_of(const MemberFace& round, const Carving& piece, double size) {
  const auto parts = member_faces(piece.body.shape, piece.body.X_SM);
  if (parts.size() != 1) return std::nullopt;
  const Pose X_SF = round.X_FS.inverse();
  std::optional<PosedShape> plug;
  if (is_ball(round)) {
    const double scale = 0.5 * round.quadric.hessian(0, 0);
    const Vec3 center = -0.5 / scale * round.quadric.linear;
    const double radius = std::sqrt(-round.quadric(center) / scale);
    plug = PosedShape{Sphere({.radius = radius}), Pose{Mat3::Identity(), center}};
  } else if (is_about_axis(round)) {
    const Ends ends = ends_across(parts[0], X_SF);
    if (!std::isfinite(ends.high - ends.low) || !(ends.high > ends.low)) return std::nullopt;
    const auto radius = [&](double z) {
      if (round.kind == MemberFace::Kind::kCone) return round.radius + round.slope * z;
      return std::sqrt(-4.0 * round.quadric(X_SF.translation) / round.quadric.hessian.trace());
    };
    Pose X_SM = X_SF;
    X_SM.translation = X_SF * Vec3(0.0, 0.0, 0.5 * (ends.low + ends.high));
    plug = PosedShape{Frustum({.bottom_radius = std::max(0.0, radius(ends.low)),
                               .top_radius = std::max(0.0, radius(ends.high)),
                               .half_length = 0.5 * (ends.high - ends.low)}),
                      X_SM};
  }
  if (!plug) return std::nullopt;
  for (const MemberFace& face : parts[0]) {
    if (face.kind != MemberFace::Kind::kPlane) {
      if (!holds_within(round, face, PartHull(plug->shape, plug->X_SM), size)) return std::nullopt;
      continue;
    }
    const Vec3 normal_M = plug->X_SM.rotation.transpose() * face.quadric.linear;
    const double height =
        std::visit([&](const auto& s) { return s.support_height(normal_M); }, plug->shape);
    if (height + face.value(plug->X_SM.translation) > face.tolerance(size)) return std::nullopt;
  }
  return plug;
}

std::optional<MomentSum> closed_form(const Csg& solid) {
  const double size = size_of(solid);
  MomentSum sum;
  const auto pieces = csg_carvings(solid);
  if (pieces.empty()) return std::nullopt;
  for (const Carving& piece : pieces) {
    sum += moments_of(piece.body.shape, piece.body.X_SM, 1.0);
    for (std::size_t i = 0; i < piece.carved.size(); ++i) {
      const auto plug = plug_of(piece.carved[i], piece, size);
      if (!plug) return std::nullopt;
      const PartHull hull(plug->shape, plug->X_SM);
      for (std::size_t j = 0; j < i; ++j) {
        const MemberFace& other = piece.carved[j];
        if (!hull.stays_above(other, -other.tolerance(size))) return std::nullopt;
      }
      sum += moments_of(plug->shape, plug->X_SM, -1.0);
    }
  }
  return sum;
}

}  // namespace

VolumeMetrics csg_own_metrics(const Csg& solid) {
  if (!solid.bounds().bounded()) {
    VolumeMetrics m;
    m.volume = kInfinity;
    m.status = Status::kUnbounded;
    return m;
  }
  if (solid.members().size() == 1) {
    const Csg::Member& member = solid.members()[0];
    return transformed(
        std::visit([](const auto& shape) { return shape.own_metrics(); }, member.shape),
        member.X_SM);
  }
  if (const auto sum = closed_form(solid)) return sum->metrics();
  return csg_metrics_by_lines(solid, kMostLineWork);
}

}  // namespace volcontact
