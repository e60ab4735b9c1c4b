// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/csg/csg_bores.h"

namespace volcontact {
namespace {

constexpr double kRoundTube = 1e-9;  // how far a tube may be from round
constexpr double kNearApex = 0.02;   // least height over the apex of a cone, per the largest one
constexpr double kSameSlope = 1e-9;

std::optional<Bore> as_tube(const Quadric& q) {
  const double h = 0.5 * q.hessian.trace();
  if (!(h > 0.0)) return std::nullopt;
  const Mat3 along = Mat3::Identity() - q.hessian / h;  // a a^T
  const Vec3 squares = along.diagonal();
  const int largest = squares.largest();
  if (!(squares[largest] > 0.3)) return std::nullopt;
  Bore bore;
  bore.axis = along.col(largest).normalized();
  if (!((along - outer(bore.axis, bore.axis)).norm() < kRoundTube)) return std::nullopt;
  bore.center = -(q.linear - bore.axis * bore.axis.dot(q.linear)) / h;
  const double square_radius = -2.0 * (q.constant + 0.5 * q.linear.dot(bore.center)) / h;
  if (!(square_radius > 0.0)) return std::nullopt;
  bore.radius = std::sqrt(square_radius);
  return bore;
}

std::optional<Bore> as_bore(const MemberFace& face) {
  if (face.kind == MemberFace::Kind::kRound) return as_tube(face.quadric);
  if (face.kind != MemberFace::Kind::kCone) return std::nullopt;
  const Pose X_SF = face.X_FS.inverse();
  Bore bore;
  bore.slope = std::abs(face.slope);
  bore.axis = X_SF.rotation.col(2) * (face.slope > 0.0 ? 1.0 : -1.0);
  bore.center = X_SF * Vec3(0.0, 0.0, -face.radius / face.slope);
  return bore;
}

// Whether a body keeps off the apex of a cone.
bool is_off_apex(const CarvedPiece& piece, const Bore& cone) {
  const auto height = [&](const Vec3& e) {
    const Vec3 e_B = piece.X_SB.rotation.transpose() * e;
    return e.dot(piece.X_SB.translation - cone.center) +
           std::visit([&](const auto& body) { return body.support_height(e_B); }, piece.body);
  };
  const double lowest = -height(-cone.axis), highest = height(cone.axis);
  return lowest > kNearApex * highest && highest < kInfinity;
}

}  // namespace

std::optional<MemberFace> csg_crossing(const MemberFace& one, const MemberFace& other,
                                       double size) {
  const std::optional<Bore> a = as_bore(one), b = as_bore(other);
  if (!a || !b || a->axis.cross(b->axis).norm() > kSameFace ||
      a->from_axis(b->center).norm() > kSameFace * size) {
    return std::nullopt;
  }
  const double slope = a->axis.dot(b->axis) > 0.0 ? b->slope : -b->slope;
  if (!(std::abs(a->slope - slope) > kSameSlope)) return std::nullopt;
  const double height = (b->radius - slope * a->height(b->center) - a->radius) / (a->slope - slope);
  MemberFace plane;
  plane.quadric = Quadric::plane(a->axis, a->axis.dot(a->center) + height);
  return plane;
}

std::vector<Bore> csg_bores(const Carving& carving, const CarvedPiece& piece) {
  std::vector<Bore> bores;
  for (const MemberFace& face : carving.carved) {
    const std::optional<Bore> bore = as_bore(face);
    if (!bore || (bore->is_cone() && !is_off_apex(piece, *bore))) return {};
    bores.push_back(*bore);
  }
  return bores;
}

}  // namespace volcontact
