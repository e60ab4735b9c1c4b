// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/shape/csg/bore.h"
#include "volcontact/shape/simple_shapes.h"

namespace volcontact {

/// Whose face it is.
enum class Owner : int { kA = 0, kB = 1 };
constexpr int index(Owner owner) { return static_cast<int>(owner); }
constexpr Owner other(Owner owner) { return owner == Owner::kA ? Owner::kB : Owner::kA; }

/// normal . x <= offset; the normal has unit length.
struct PlaneFace {
  Vec3 normal;
  double offset;
  Owner owner;
};

/// The part of a capsule's surface a round face stands for.
enum class CapsulePart : int { kNone = 0, kTube, kTopBall, kBottomBall };

/// y^T J y <= level with y = map (x - center) and J = diag(1, 1, 1) and level 1: a ball, an
/// ellipsoid, or a tube when the last row of `map` is zero. For a cone J = diag(1, 1, -1) and
/// level 0, and y_z >= 0.
struct RoundFace {
  Mat3 map;
  Vec3 center;
  Owner owner;
  bool cone = false;
  CapsulePart part = CapsulePart::kNone;
  double off = 0.0;  ///< at most, from the face of the solid that it stands for [m]

  double level() const { return cone ? 0.0 : 1.0; }
  Vec3 weighted(const Vec3& y) const { return {y.x(), y.y(), cone ? -y.z() : y.z()}; }
  /// Negative inside, zero on the face.
  double operator()(const Vec3& x) const {
    const Vec3 y = map * (x - center);
    return y.dot(weighted(y)) - level();
  }
  /// Half the gradient of the above.
  Vec3 half_gradient(const Vec3& x) const { return map.transpose() * weighted(map * (x - center)); }
};

/// The wall of a bore as if it were a face of a solid inside of it.
inline RoundFace face_of(const Bore& bore, Owner owner) {
  const Mat3 basis = basis_with_z(bore.axis);
  const double scale = bore.is_cone() ? 1.0 : 1.0 / bore.radius;
  RoundFace face{Vec3(scale, scale, bore.slope).asDiagonal() * basis.transpose(), bore.center,
                 owner};
  face.cone = bore.is_cone();
  return face;
}

/// Where the tube of a capsule ends and its balls begin, and the rim circles of tubes and cones: a
/// disc normal to `axis` (unit length).
struct Segment {
  bool present = false;
  Vec3 center;
  Vec3 axis;
  double half_length = 0.0;

  double along(const Vec3& x) const { return axis.dot(x - center); }
};

/// Edge between a round face and a plane face of the same solid.
struct Rim {
  Vec3 center;
  Vec3 radius_u, radius_v;  ///< x = center + radius_u cos + radius_v sin
  Owner owner;
};

/// All faces of two solids in A's frame. A solid is the intersection of the insides of its faces;
/// of a capsule's three round faces each counts on its own part.
struct FaceSet {
  std::vector<PlaneFace> planes;
  std::vector<RoundFace> rounds;
  std::vector<Rim> rims;
  Segment capsule[2];  ///< by owner
  bool has_bore = false;
  Bore bore;       ///< cut out of the owner of its wall
  RoundFace wall;  ///< face_of() it

  void clear() {
    planes.clear();
    rounds.clear();
    rims.clear();
    capsule[0].present = capsule[1].present = has_bore = false;
  }
  bool has_rounds(Owner owner) const {
    for (const RoundFace& round : rounds) {
      if (round.owner == owner) return true;
    }
    return false;
  }
};

/// Takes the faces of one solid posed in A's frame, which the solid writes by itself: solid.h,
/// "write_faces". What it says is in the frame S of the solid.
class FaceWriter {
 public:
  FaceWriter(FaceSet& faces, const Pose& X_AS, Owner owner)
      : faces_(faces), X_(X_AS), owner_(owner) {}

  template <typename S>
  void write(const S& solid) {
    solid.write_faces(*this);
  }

  /// normal . x <= offset, the normal of unit length.
  void plane(const Vec3& normal_S, double offset) {
    const Vec3 normal = X_.rotation * normal_S;
    faces_.planes.push_back({normal, offset + normal.dot(X_.translation), owner_});
  }
  /// |diag(scales) (x - center)| <= 1: a ball, an ellipsoid, or a tube about z where that scale is
  /// 0. The face may be `off` by so much.
  void round(const Vec3& scales, const Vec3& center_S, double off = 0.0) {
    add_round(scales, center_S).off = off;
  }
  /// sqrt(x^2 + y^2) <= slope (z - apex).
  void cone(double slope, double apex) {
    add_round({1.0, 1.0, slope}, {0.0, 0.0, apex}).cone = true;
  }
  /// A tube about z, closed by balls of its radius about (0, 0, +-half_length).
  void rounded_tube(double radius, double half_length) {
    const double scale = 1.0 / radius;
    add_round({scale, scale, 0.0}, Vec3::Zero()).part = CapsulePart::kTube;
    add_round(Vec3::Constant(scale), {0.0, 0.0, half_length}).part = CapsulePart::kTopBall;
    add_round(Vec3::Constant(scale), {0.0, 0.0, -half_length}).part = CapsulePart::kBottomBall;
    faces_.capsule[index(owner_)] = {true, X_.translation, X_.rotation.col(2), half_length};
    rim(half_length, radius);
    rim(-half_length, radius);
  }
  /// The plane side z <= half_length, whose edge has this radius.
  void end(double side, double radius, double half_length) {
    plane(Vec3(0.0, 0.0, side), half_length);
    rim(side * half_length, radius);
  }

 private:
  RoundFace& add_round(const Vec3& scales, const Vec3& center_S) {
    faces_.rounds.push_back({scales.asDiagonal() * X_.rotation.transpose(), X_ * center_S, owner_});
    return faces_.rounds.back();
  }
  void rim(double z, double radius) {
    faces_.rims.push_back(
        {X_ * Vec3(0.0, 0.0, z), radius * X_.rotation.col(0), radius * X_.rotation.col(1), owner_});
  }

  FaceSet& faces_;
  const Pose& X_;
  Owner owner_;
};

}  // namespace volcontact
