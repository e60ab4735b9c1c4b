// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "volcontact/base/types.h"

namespace volcontact::test {

// Solids as implicit functions, for the judge of the random search. Nothing here comes from the
// shapes of the core: a member is a function that is negative inside, and what a line has in a
// solid is found from the roots of its polynomials and from the sign of that function between them.

/// Parts of a line inside a solid, in order along it.
struct LineParts {
  struct Part {
    double enter, leave;
  };
  static constexpr int kMost = 128;
  std::array<Part, kMost> part;
  int count = 0;

  /// One more behind the last; nothing where it has no length.
  void add(double enter, double leave) {
    if (enter < leave && count < kMost) part[static_cast<std::size_t>(count++)] = {enter, leave};
  }
  const Part* begin() const { return part.data(); }
  const Part* end() const { return part.data() + count; }
};

/// Length of what lies in both, parts of one line.
inline double common_length(const LineParts& one, const LineParts& other) {
  double length = 0.0;
  for (const LineParts::Part& a : one) {
    for (const LineParts::Part& b : other) {
      length += std::max(0.0, std::min(a.leave, b.leave) - std::max(a.enter, b.enter));
    }
  }
  return length;
}

/// One solid that is not made of others, posed in the frame of the whole.
class ImplicitMember {
 public:
  enum class Kind { kHalfSpace, kEllipsoid, kCapsule, kFrustum, kBox, kTorus, kPolytope };
  struct Plane {
    Vec3 normal;
    double offset;
  };

  Kind kind = Kind::kHalfSpace;
  Vec3 size = Vec3::Zero();  ///< semi-axes; radius and half length; radii at the bottom and top and
                             ///< half length; half sizes; major and minor radius
  std::vector<Plane> planes;  ///< of a polytope
  Pose X_SM, X_MS;

  /// Negative inside; changes by no more than the distance moved. Convex but for a torus.
  double value(const Vec3& p_S) const { return local_value(X_MS * p_S); }
  /// A subgradient of value(), of kinds that are convex.
  Vec3 slope(const Vec3& p_S) const { return X_SM.rotation * local_slope(X_MS * p_S); }
  bool is_convex() const { return kind != Kind::kTorus; }

 private:
  double local_value(const Vec3& p) const;
  Vec3 local_slope(const Vec3& p) const;
};

/// Union, intersection and difference of members. A ball around it is known.
class ImplicitSolid {
 public:
  static constexpr int kMostMembers = 64;

  static ImplicitSolid half_space();
  static ImplicitSolid ellipsoid(const Vec3& semi_axes);
  static ImplicitSolid capsule(double radius, double half_length);
  static ImplicitSolid frustum(double bottom_radius, double top_radius, double half_length);
  static ImplicitSolid box(const Vec3& half_sizes);
  static ImplicitSolid torus(double major_radius, double minor_radius);
  /// The hull of the points: planes through three of them with none beyond.
  static ImplicitSolid polytope(const std::vector<Vec3>& points);

  friend ImplicitSolid operator|(const ImplicitSolid& a, const ImplicitSolid& b);
  friend ImplicitSolid operator&(const ImplicitSolid& a, const ImplicitSolid& b);
  friend ImplicitSolid operator-(const ImplicitSolid& a, const ImplicitSolid& b);
  ImplicitSolid posed(const Pose& X_WS) const;

  /// Negative inside; changes by no more than the distance moved.
  double value(const Vec3& p) const;
  bool is_convex() const;
  const std::vector<ImplicitMember>& members() const { return members_; }
  /// Whether a place is inside, from the bits of the members that hold it.
  bool holds(std::uint64_t inside) const;
  /// The members after which an operation stands, in postfix order: -1 union, -2 intersection, -3
  /// difference, else the number of a member.
  const std::vector<int>& steps() const { return steps_; }

  Vec3 middle = Vec3::Zero();  ///< of a ball that holds the solid
  double radius = 0.0;         ///< infinite of a half-space
  double most_volume = 0.0;    ///< the volume of a single member, a bound of it else

 private:
  static ImplicitSolid single(ImplicitMember member, double radius, double volume);
  static ImplicitSolid joined(const ImplicitSolid& a, const ImplicitSolid& b, int operation);

  std::vector<ImplicitMember> members_;
  std::vector<int> steps_;
};

/// A member and lines of one direction: what these have in common is worked out once.
class MemberLines {
 public:
  /// `d_S` of unit length. The member must outlive this.
  MemberLines(const ImplicitMember& member, const Vec3& d_S);
  /// Adds what the line o + t d has inside for t from -reach to reach.
  void add_parts(const Vec3& o_S, double reach, LineParts& out) const;

 private:
  using Span = LineParts::Part;
  Span ellipsoid(const Vec3& n) const;
  Span capsule(const Vec3& n) const;
  Span frustum(const Vec3& n) const;
  Span slab(int axis, const Vec3& n, double half) const;
  Span tube(const Vec3& n, double radius) const;
  Span facets(const Vec3& n) const;
  void add_torus(const Vec3& n, double around, double reach, LineParts& out) const;

  const ImplicitMember& member_;
  Vec3 d_;                      // in the member's frame
  double ball_ = 0.0;           // radius of a ball about the member's origin that holds it, squared
  Vec3 scaled_ = Vec3::Zero();  // d in a frame in which an ellipsoid is a unit ball
  double across_ = 0.0;         // squared length of the part of d across the axis
  double rise_ = 0.0;           // of a frustum: radius by height
  std::vector<double> rates_;   // of the heights above the planes of a polytope
};

/// A solid and lines of one direction.
class SolidLines {
 public:
  SolidLines(const ImplicitSolid& solid, const Vec3& d);
  /// What the line o + t d has inside for t from -reach to reach.
  void parts(const Vec3& o, double reach, LineParts& out);

 private:
  struct End {
    double t;
    std::uint64_t member;  // its bit
  };
  const ImplicitSolid& solid_;
  std::vector<MemberLines> members_;
  LineParts of_member_;
  std::vector<End> ends_;
};

}  // namespace volcontact::test
