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

/// Writes the faces of one solid posed in A's frame. The one table of what the lines engine serves:
/// a shape is served when it stands here.
class FaceWriter {
 public:
  FaceWriter(FaceSet& faces, const Pose& X_AS, Owner owner)
      : faces_(faces), X_(X_AS), owner_(owner) {}

  void write(const HalfSpace&) { plane(Vec3::UnitZ(), 0.0); }
  void write(const Box& box) {
    for (int i = 0; i < 3; ++i) {
      plane(Vec3::Unit(i), box.half_sizes()[i]);
      plane(-Vec3::Unit(i), box.half_sizes()[i]);
    }
  }
  void write(const ConvexPolytope& polytope) {
    for (const ConvexPolytope::Face& face : polytope.faces()) plane(face.normal, face.offset);
  }
  void write(const Sphere& sphere) { round(Vec3::Constant(1.0 / sphere.radius()), Vec3::Zero()); }
  void write(const Ellipsoid& ellipsoid) {
    round(ellipsoid.semi_axes().cwiseInverse(), Vec3::Zero());
  }
  void write(const Cylinder& cylinder) {
    const double scale = 1.0 / cylinder.radius();
    round({scale, scale, 0.0}, Vec3::Zero());
    end(1.0, cylinder.radius(), cylinder.half_length());
    end(-1.0, cylinder.radius(), cylinder.half_length());
  }
  void write(const Capsule& capsule) {
    const double scale = 1.0 / capsule.radius(), h = capsule.half_length();
    round({scale, scale, 0.0}, Vec3::Zero()).part = CapsulePart::kTube;
    round(Vec3::Constant(scale), {0.0, 0.0, h}).part = CapsulePart::kTopBall;
    round(Vec3::Constant(scale), {0.0, 0.0, -h}).part = CapsulePart::kBottomBall;
    faces_.capsule[index(owner_)] = {true, X_.translation, X_.rotation.col(2), h};
    rim(h, capsule.radius());
    rim(-h, capsule.radius());
  }
  void write(const Frustum& frustum) {
    const auto& p = frustum.params();
    const double mean = 0.5 * (p.bottom_radius + p.top_radius);
    const double slope = (p.top_radius - p.bottom_radius) / (2.0 * p.half_length);
    if (std::abs(slope) * p.half_length < kStraight * mean) {
      round({1.0 / mean, 1.0 / mean, 0.0}, Vec3::Zero());
    } else {
      round({1.0, 1.0, slope}, {0.0, 0.0, -mean / slope}).cone = true;
    }
    end(1.0, p.top_radius, p.half_length);
    end(-1.0, p.bottom_radius, p.half_length);
  }

 private:
  // A cone whose radii differ less than this, relatively, is a tube.
  static constexpr double kStraight = 1e-12;

  void plane(const Vec3& normal_S, double offset) {
    const Vec3 normal = X_.rotation * normal_S;
    faces_.planes.push_back({normal, offset + normal.dot(X_.translation), owner_});
  }
  RoundFace& round(const Vec3& scales, const Vec3& center_S) {
    faces_.rounds.push_back({scales.asDiagonal() * X_.rotation.transpose(), X_ * center_S, owner_});
    return faces_.rounds.back();
  }
  void end(double side, double radius, double half_length) {
    plane(Vec3(0.0, 0.0, side), half_length);
    rim(side * half_length, radius);
  }
  void rim(double z, double radius) {
    faces_.rims.push_back(
        {X_ * Vec3(0.0, 0.0, z), radius * X_.rotation.col(0), radius * X_.rotation.col(1), owner_});
  }

  FaceSet& faces_;
  const Pose& X_;
  Owner owner_;
};

/// Whether the lines engine knows the faces of a shape.
template <typename S>
concept HasFaces = requires(FaceWriter writer, const S& solid) { writer.write(solid); };

/// Whether any of them is round.
template <typename S>
concept HasRoundFaces = HasFaces<S> && !std::same_as<S, HalfSpace> && !std::same_as<S, Box> &&
                        !std::same_as<S, ConvexPolytope>;

}  // namespace volcontact
