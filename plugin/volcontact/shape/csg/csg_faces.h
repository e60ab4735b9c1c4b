// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "volcontact/shape/csg/csg.h"
#include "volcontact/shape/polytope/cut_polytope.h"

namespace volcontact {

/// Share of the size of a solid below which two faces are one.
inline constexpr double kSameFace = 1e-11;

/// A face of a simple shape, in the frame S of the solid: a plane, or a round face about an axis or
/// a centre, which is convex.
struct MemberFace {
  enum class Kind { kPlane, kRound, kCone };
  Kind kind = Kind::kPlane;
  Quadric quadric;
  bool seam = false;  ///< between two convex parts of the shape
  Pose X_FS;          ///< of the shape's frame F, whose z axis is that of a tube or cone
  double radius = 0.0, slope = 0.0;  ///< a cone is within radius + slope z of it
  double steepness = 1.0;            ///< of value() near the surface
  std::vector<Quadric> wrap;  ///< planes around a round face that is not open in all directions

  /// Convex function that is negative inside: the distance from a plane, else in any unit.
  double value(const Vec3& x) const;
  Vec3 slope_at(const Vec3& x) const;
  /// Rounding of value().
  double tolerance(double size) const { return kSameFace * size * steepness; }
  /// The half-space that the plane bounds, or the one on its other side.
  Quadric oriented(bool inside) const { return inside ? quadric : quadric.reversed(); }
  /// The same plane, sphere, tube or cone, to rounding; `size` [m] is that of the solid.
  bool same_as(const MemberFace& other, double size) const;
};

/// The convex parts of a simple shape as lists of faces, planes first, with at most one round face
/// each. None for a torus.
std::vector<std::vector<MemberFace>> member_faces(const SimpleShape& shape, const Pose& X_SM);

/// A convex polytope that holds a part of a solid, for proofs that a face does not reach the part.
/// Unbounded parts have none, and nothing is proven of them.
class PartHull {
 public:
  PartHull() = default;
  /// Around a shape, tight to 2 % where it is round.
  PartHull(const SimpleShape& shape, const Pose& X_SM);

  bool bounded() const { return bounded_; }
  bool empty() const { return bounded_ && polytope_.size() == 0; }
  std::span<const Vec3> points() const { return polytope_.points(); }
  /// Largest value of the face's function over the hull; +infinity when not bounded.
  double most(const MemberFace& face) const;
  /// Whether it is proven that the face's function is nowhere in the hull below this level; never
  /// when not bounded.
  bool stays_above(const MemberFace& face, double level) const;
  /// Keeps one side of a plane: inside, or outside of it.
  void cut(const MemberFace& plane, bool inside);
  void cut(const Vec3& normal, double offset);
  /// Keeps what is inside of a round face, roughly.
  void cut_round(const MemberFace& face);

 private:
  bool bounded_ = false;
  CutPolytope polytope_;
};

/// Size of a solid, for tolerances: the largest coordinate of its bounded members [m].
double size_of(const Csg& solid);

}  // namespace volcontact
